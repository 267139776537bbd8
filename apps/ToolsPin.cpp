#include "ToolsPin.h"

#include <fstream>
#include <numbers>
#include <sstream>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoOutput.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/nodes/SoBaseColor.h>
#include <Inventor/nodes/SoCone.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoSphere.h>
#include <Inventor/nodes/SoText2.h>
#include <Inventor/nodes/SoTransform.h>
#include <Inventor/nodes/SoTranslation.h>
#include <SoTerrain/SoTerrainPlacement.h>
#include <SoTerrain/SoTerrainShape.h>

#include "SceneGround.h"
#include "ToolsDrawing.h"

namespace app {

using terrain::Error;
using terrain::Result;

namespace {

// Of the ground's longer side.
constexpr float pinHeight = 0.02f;

void addText(SoSeparator& group, const std::string& text, const SbVec3f& place, float gray) {
    auto* part = new SoSeparator;
    auto* translation = new SoTranslation;
    translation->translation = place;
    auto* color = new SoBaseColor;
    color->rgb.setValue(gray, gray, gray);
    auto* label = new SoText2;
    label->string = text.c_str();
    label->justification = SoText2::CENTER;
    for (SoNode* node : std::initializer_list<SoNode*>{translation, color, label}) part->addChild(node);
    group.addChild(part);
}

std::string wholeFile(const std::string& path, bool& found) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    found = bool(file);
    return text.str();
}

Marker markerAt(const SoPath& found) {
    const auto& path = static_cast<const SoFullPath&>(found);
    const auto* placement = static_cast<const SoTerrainPlacement*>(path.getTail());
    Marker marker{{placement->point.getValue()[0], placement->point.getValue()[1]}, ""};
    if (path.getLength() < 2) return marker;
    SoSearchAction search;
    search.setType(SoText2::getClassTypeId());
    search.setInterest(SoSearchAction::FIRST);
    search.apply(path.getNodeFromTail(1));
    if (search.getPath()) {
        const auto* text = static_cast<const SoText2*>(static_cast<SoFullPath*>(search.getPath())->getTail());
        if (text->string.getNum() > 0) marker.name = text->string[0].getString();
    }
    return marker;
}

Result<std::vector<Marker>> readMarkersScene(const std::string& path) {
    SoInput input;
    if (!input.openFile(path.c_str(), TRUE)) return Error{path, "a readable scene file", "no such file, or no permission"};
    const NodePtr<SoSeparator> scene(SoDB::readAll(&input));
    if (!scene) return Error{path, "an Inventor scene", "a file that Coin can't read"};
    SoSearchAction search;
    search.setType(SoTerrainPlacement::getClassTypeId());
    search.setInterest(SoSearchAction::ALL);
    search.apply(scene.get());
    std::vector<Marker> markers;
    for (int i = 0; i < search.getPaths().getLength(); ++i) markers.push_back(markerAt(*search.getPaths()[i]));
    return markers;
}

}  // namespace

void takeGrid(const Scene& scene, SoNode& node) {
    const auto set = [&node](const char* name, int value) {
        if (auto* field = dynamic_cast<SoSFInt32*>(node.getField(name))) field->setValue(value);
    };
    SoNode* terrain = scene.terrain();
    for (const char* name : {"verticesPerRow", "verticesPerColumn", "startIndex"}) {
        const auto* field = terrain ? dynamic_cast<SoSFInt32*>(terrain->getField(name)) : nullptr;
        if (field) set(name, field->getValue());
    }
    const bool isOurs = terrain && terrain->isOfType(SoTerrainShape::getClassTypeId());
    if (isOurs || !scene.grid()) return;
    set("verticesPerRow", scene.grid()->columns);
    set("verticesPerColumn", scene.grid()->rows);
}

void addLabel(SoSeparator& group, const std::string& text, float height) {
    // A pixel or two, from anywhere: the edge lies a little nearer to the ground.
    addText(group, text, SbVec3f(0.0f, 0.0f, height * 0.985f), 0.0f);
    addText(group, text, SbVec3f(0.0f, 0.0f, height), 1.0f);
}

void addPin(SoSeparator& group, const SbColor& color, float size, const std::string& name) {
    const float height = pinHeight * size;
    auto* pin = new SoSeparator;
    auto* light = new SoLightModel;
    light->model = SoLightModel::BASE_COLOR;
    auto* paint = new SoBaseColor;
    paint->rgb = color;
    // A cone's tip is up at +y; a pin's is on the ground.
    auto* turn = new SoTransform;
    turn->rotation.setValue(SbVec3f(1.0f, 0.0f, 0.0f), -std::numbers::pi_v<float> / 2.0f);
    turn->translation.setValue(0.0f, 0.0f, 0.5f * height);
    auto* needle = new SoCone;
    needle->bottomRadius = 0.14f * height;
    needle->height = height;
    auto* up = new SoTranslation;
    up->translation.setValue(0.0f, -0.5f * height, 0.0f);
    auto* head = new SoSphere;
    head->radius = 0.24f * height;
    for (SoNode* node : std::initializer_list<SoNode*>{light, paint, turn, needle, up, head}) pin->addChild(node);
    group.addChild(pin);
    if (!name.empty()) addLabel(group, name, 1.5f * height);
}

std::optional<Error> writeMarkersScene(const std::string& path, const std::vector<Marker>& markers, float size) {
    const NodePtr<SoSeparator> all(new SoSeparator);
    for (const Marker& marker : markers) {
        auto* object = new SoSeparator;
        auto* placement = new SoTerrainPlacement;
        placement->point.setValue(float(marker.at.x), float(marker.at.y));
        object->addChild(placement);
        addPin(*object, SbColor(0.9f, 0.15f, 0.1f), size, marker.name);
        all->addChild(object);
    }
    SoOutput output;
    if (!output.openFile(path.c_str())) return Error{path, "a file that can be written", "no permission, or no such folder"};
    SoWriteAction write(&output);
    write.apply(all.get());
    output.closeFile();
    return std::nullopt;
}

Result<std::vector<Marker>> readMarkers(const std::string& path) {
    if (path.ends_with(".iv")) return readMarkersScene(path);
    bool found = false;
    const std::string text = wholeFile(path, found);
    if (!found) return Error{path, "markers as CSV or .iv", "no such file, or no permission"};
    return readMarkersCsv(text, path);
}

std::optional<Error> writeMarkers(const std::string& path, const std::vector<Marker>& markers, float size) {
    if (path.ends_with(".iv")) return writeMarkersScene(path, markers, size);
    std::ofstream file(path, std::ios::trunc);
    file << markersCsv(markers);
    file.close();
    return file ? std::nullopt : std::optional(Error{path, "a file that can be written", "no permission, or no such folder"});
}

}  // namespace app
