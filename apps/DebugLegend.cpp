#include <algorithm>
#include <cstdio>

#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDepthBuffer.h>
#include <Inventor/nodes/SoFaceSet.h>
#include <Inventor/nodes/SoFont.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoOrthographicCamera.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoText2.h>
#include <Inventor/nodes/SoTranslation.h>
#include <SoTerrain/SoTerrainShape.h>

#include "DebugViews.h"
#include "Scene.h"
#include "lod/DebugColours.h"

namespace app {

namespace {

// In pixels.
constexpr float rowHeight = 17.0f, swatchWidth = 26.0f, gap = 8.0f, letterWidth = 7.4f;
constexpr float dark[3] = {0.12f, 0.12f, 0.14f};

std::string pixels(double amount) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g px", amount);
    return text;
}

}  // namespace

DebugLegend::DebugLegend() : root_(new SoSeparator) {}

std::vector<DebugLegend::Row> DebugLegend::rowsFor(int picture, float pixelError) {
    std::vector<Row> rows;
    const auto add = [&rows](const terrain::Colour& colour, const std::string& text, bool blends = false) {
        rows.push_back({{colour.r, colour.g, colour.b}, text, blends});
    };
    switch (picture) {
    case SoTerrainShape::LEVELS:
        for (int level = 0; level <= terrain::kCoarsestLevel; ++level) {
            const std::string size = std::to_string(1 << level);
            add(terrain::levelColour(level), std::to_string(level) + (level == 0 ? ": every sample" : ": cells of " + size));
        }
        rows.back().text += " or more";
        break;
    case SoTerrainShape::ERRORS: {
        const double allowed = pixelError > 0.0f ? double(pixelError) : 1.0;
        add(terrain::kBrokenColour, "more than " + pixels(allowed));
        const int steps = int(terrain::errorRamp().size()) - 1;
        for (int i = steps; i >= 0; --i)
            add(terrain::errorColour(float(i) / float(steps)), pixels(allowed * double(i) / double(steps)), i > 0);
        break;
    }
    case SoTerrainShape::LOADING:
        add(terrain::kSettledColour, "as wanted");
        add(terrain::kStandInColour, "finer ones are on their way");
        add(terrain::kNewColour, "new in this frame");
        add(terrain::kNewStandInColour, "new, and finer to come");
            add(terrain::kTextureToComeColour, "texture is on its way");
        break;
    default:
        break;
    }
    return rows;
}

void DebugLegend::addPanel(float x, float y, float width, float height, const float low[3], const float high[3]) {
    auto* corners = new SoCoordinate3;
    const float points[4][3] = {{x, y, 0.0f}, {x + width, y, 0.0f}, {x + width, y + height, 0.0f}, {x, y + height, 0.0f}};
    corners->point.setValues(0, 4, points);
    auto* colours = new SoBaseColor;
    const float corner[4][3] = {
        {low[0], low[1], low[2]}, {low[0], low[1], low[2]}, {high[0], high[1], high[2]}, {high[0], high[1], high[2]}};
    colours->rgb.setValues(0, 4, corner);
    auto* faces = new SoFaceSet;
    faces->numVertices = 4;
    root_->addChild(corners);
    root_->addChild(colours);
    root_->addChild(faces);
}

void DebugLegend::addText(float x, float y, const std::string& text) {
    auto* group = new SoSeparator;
    auto* place = new SoTranslation;
    place->translation.setValue(x, y, 0.0f);
    auto* colour = new SoBaseColor;
    colour->rgb.setValue(1.0f, 1.0f, 1.0f);
    auto* binding = new SoMaterialBinding;
    auto* node = new SoText2;
    node->string = text.c_str();
    group->addChild(place);
    group->addChild(colour);
    group->addChild(binding);
    group->addChild(node);
    root_->addChild(group);
}

void DebugLegend::build(const std::vector<Row>& rows, const SbVec2s& size) {
    root_->removeAllChildren();
    if (rows.empty()) return;
    const float width = size[0], height = size[1];
    auto* camera = new SoOrthographicCamera;
    camera->viewportMapping = SoCamera::LEAVE_ALONE;
    camera->aspectRatio = width / height;
    camera->height = height;
    camera->position.setValue(0.5f * width, 0.5f * height, 1.0f);
    camera->nearDistance = 0.5f;
    camera->farDistance = 1.5f;
    auto* depth = new SoDepthBuffer;
    depth->test = FALSE;
    depth->write = FALSE;
    auto* light = new SoLightModel;
    light->model = SoLightModel::BASE_COLOR;
    auto* binding = new SoMaterialBinding;
    binding->value = SoMaterialBinding::PER_VERTEX;
    auto* font = new SoFont;
    font->size = 12.0f;
    for (SoNode* node : {static_cast<SoNode*>(camera), static_cast<SoNode*>(depth), static_cast<SoNode*>(light),
                         static_cast<SoNode*>(binding), static_cast<SoNode*>(font)})
        root_->addChild(node);
    std::size_t letters = 0;
    for (const Row& row : rows) letters = std::max(letters, row.text.size());
    const float panelWidth = swatchWidth + float(letters) * letterWidth + 3.0f * gap;
    const float panelHeight = float(rows.size()) * rowHeight + 2.0f * gap;
    const float left = width - panelWidth - gap, top = height - gap;
    addPanel(left, top - panelHeight, panelWidth, panelHeight, dark, dark);
    float y = top - gap;
    for (std::size_t i = 0; i < rows.size(); ++i, y -= rowHeight) {
        const float* below = rows[i].blends ? rows[i + 1].colour : rows[i].colour;
        // A blend has a row's own colour beside its text.
        const float middle = y - 0.5f * rowHeight;
        if (rows[i].blends) {
            addPanel(left + gap, middle - rowHeight, swatchWidth, rowHeight, below, rows[i].colour);
            if (i == 0 || !rows[i - 1].blends)
                addPanel(left + gap, middle, swatchWidth, 0.5f * rowHeight - 1.0f, rows[i].colour, rows[i].colour);
        } else {
            const bool endsBlend = i > 0 && rows[i - 1].blends;
            addPanel(left + gap, y - rowHeight + 1.0f, swatchWidth, endsBlend ? 0.5f * rowHeight : rowHeight - 2.0f, rows[i].colour,
                     rows[i].colour);
        }
        addText(left + swatchWidth + 2.0f * gap, middle - 4.0f, rows[i].text);
    }
}

void DebugLegend::update(const Scene& scene, const SbVec2s& size) {
    const int picture = debugPicture(scene);
    const float allowed = canDebug(scene) ? static_cast<SoTerrainShape*>(scene.terrain())->pixelError.getValue() : 0.0f;
    const std::string wanted =
        std::to_string(picture) + ' ' + std::to_string(allowed) + ' ' + std::to_string(size[0]) + ' ' + std::to_string(size[1]);
    if (wanted == shown_) return;
    shown_ = wanted;
    build(rowsFor(picture, allowed), size);
}

}  // namespace app
