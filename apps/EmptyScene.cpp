// What is shown before there is a terrain.
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoFont.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoText2.h>

#include "Scene.h"

namespace app {

namespace {

SoSeparator* makeInvitation() {
    auto* all = new SoSeparator;
    auto* camera = new SoOrthographicCamera;
    camera->position.setValue(0.0f, 0.0f, 1.0f);
    auto* light = new SoLightModel;
    light->model = SoLightModel::BASE_COLOR;
    auto* color = new SoBaseColor;
    color->rgb.setValue(1.0f, 1.0f, 1.0f);
    auto* font = new SoFont;
    font->size = 20.0f;
    auto* text = new SoText2;
    const char* lines[] = {"Drop a height map or a scene here,", "or press Ctrl+O to open one."};
    text->string.setValues(0, 2, lines);
    text->justification = SoText2::CENTER;
    text->spacing = 1.5f;
    for (SoNode* node : {static_cast<SoNode*>(camera), static_cast<SoNode*>(light), static_cast<SoNode*>(color),
                         static_cast<SoNode*>(font), static_cast<SoNode*>(text)})
        all->addChild(node);
    return all;
}

}  // namespace

Scene Scene::empty() {
    Scene scene;
    scene.root_ = NodePtr(new SoSeparator);
    scene.drawStyle_ = new SoDrawStyle;
    scene.camera_ = new SoPerspectiveCamera;
    scene.root_->addChild(scene.drawStyle_);
    scene.root_->addChild(scene.camera_);
    scene.root_->addChild(makeInvitation());
    scene.home_ = lookAlong(SbVec3f(0.0f, 0.0f, 0.0f), SbVec3f(0.0f, 1.0f, 0.0f));
    scene.setPose(scene.home_);
    return scene;
}

}  // namespace app
