#include "StatusLine.h"

#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoDepthBuffer.h>
#include <Inventor/nodes/SoFont.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoText2.h>
#include <Inventor/nodes/SoTranslation.h>

namespace app {

StatusLine::StatusLine() : root_(new SoSeparator), font_(new SoFont) {
    // A unit square over the whole picture, whatever its shape.
    auto* camera = new SoOrthographicCamera;
    camera->viewportMapping = SoCamera::LEAVE_ALONE;
    camera->aspectRatio = 1.0f;
    camera->height = 1.0f;
    camera->position.setValue(0.5f, 0.5f, 1.0f);
    camera->nearDistance = 0.5f;
    camera->farDistance = 1.5f;
    auto* depth = new SoDepthBuffer;
    depth->test = FALSE;
    depth->write = FALSE;
    auto* light = new SoLightModel;
    light->model = SoLightModel::BASE_COLOR;
    root_->addChild(camera);
    root_->addChild(depth);
    root_->addChild(light);
    addText(0.0015f, 0.0f);
    addText(0.0f, 1.0f);
}

void StatusLine::addText(float shift, float gray) {
    auto* group = new SoSeparator;
    auto* place = new SoTranslation;
    place->translation.setValue(0.012f + shift, 0.018f - shift, 0.0f);
    auto* color = new SoBaseColor;
    color->rgb.setValue(gray, gray, gray);
    text_[count_] = new SoText2;
    group->addChild(place);
    group->addChild(color);
    group->addChild(text_[count_]);
    root_->addChild(group);
    ++count_;
}

void StatusLine::setScale(float scale) {
    font_->size = 10.0f * scale;
    const int there = root_->findChild(font_.get());
    if (scale != 1.0f && there < 0) root_->insertChild(font_.get(), 0);
    if (scale == 1.0f && there >= 0) root_->removeChild(there);
}

void StatusLine::setText(const std::string& text) {
    for (SoText2* node : text_) {
        if (!(node->string[0] == text.c_str())) node->string = text.c_str();
    }
}

}  // namespace app
