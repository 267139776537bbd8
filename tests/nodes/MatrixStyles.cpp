// Draw styles, shape hints, complexity, clipping and overrides of the matrix.
#include "Matrix.h"

#include <Inventor/nodes/SoComplexity.h>
#include <Inventor/nodes/SoDrawStyle.h>
#include <Inventor/nodes/SoLightModel.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoShapeHints.h>
#include <Inventor/nodes/SoTexture2.h>

namespace test::matrix {

namespace {

Property drawStyle(const std::string& name, const std::string& fields, double tolerance) {
    return {.name = "DrawStyle: " + name,
            .iv = "DrawStyle { " + fields + " }",
            .tolerance = {0.5, tolerance, tolerance},
            .measure = Measure::Areas};
}

const std::string kFromBelow = cameraText(SbVec3f(20.0f, -20.0f, -50.0f), SbVec3f(32.0f, 32.0f, 8.0f));
const char* const kLightBelow = "DirectionalLight { direction 0.3 0.2 1 }";

std::string hints(const std::string& fields) {
    return "ShapeHints { " + fields + " }\n";
}

/// A sheet that the ground rises through.
const char* const kSheet = "Separator { Material { diffuseColor 0.9 0.3 0.1 } Translation { translation 32 32 9 } Cube { width 60 "
                           "height 60 depth 0.1 } }\n";

}  // namespace

Group styles() {
    std::vector<Property> rows;
    rows.push_back({.name = "DrawStyle: FILLED", .iv = "DrawStyle { style FILLED }", .effect = Effect::None});
    rows.push_back(drawStyle("LINES", "style LINES", 3.0));
    rows.push_back(drawStyle("LINES, lineWidth", "style LINES lineWidth 3", 3.0));
    rows.push_back(drawStyle("LINES, linePattern", "style LINES linePattern 0x1111", 10.0));
    rows.push_back(drawStyle("POINTS", "style POINTS", 3.0));
    rows.push_back(drawStyle("POINTS, pointSize", "style POINTS pointSize 4", 3.0));
    rows.push_back(drawStyle("INVISIBLE", "style INVISIBLE", 0.0));
    for (const std::string type : {"SOLID", "UNKNOWN_SHAPE_TYPE"})
        for (const std::string order : {"COUNTERCLOCKWISE", "CLOCKWISE", "UNKNOWN_ORDERING"})
            for (const bool below : {false, true}) {
                const Reference reference = order == "CLOCKWISE" ? Reference::ClockwiseFaceSet : Reference::FaceSet;
                const bool culled = below && type == "SOLID" && order != "UNKNOWN_ORDERING";
                rows.push_back(
                    {.name = "ShapeHints: " + order + ", " + type + (below ? ", from below" : ", from above"),
                     .iv = hints("vertexOrdering " + order + " shapeType " + type) + "Material { diffuseColor 0.5 0.8 0.3 }",
                     .base = below ? kLightBelow : "",
                     .camera = below ? kFromBelow : "",
                     .reference = reference,
                     .measure = culled ? Measure::Areas : Measure::Pixels});
            }
    rows.push_back({.name = "ShapeHints: creaseAngle", .iv = hints("creaseAngle 0.1"), .effect = Effect::None});
    rows.push_back({.name = "ShapeHints: faceType", .iv = hints("faceType UNKNOWN_FACE_TYPE"), .effect = Effect::None});
    rows.push_back({.name = "PolygonOffset", .iv = "PolygonOffset { factor -20 units -100 }", .base = kSheet});
    rows.push_back({.name = "PolygonOffset of lines",
                    .iv = "DrawStyle { style LINES }\nPolygonOffset { factor -20 units -100 styles LINES }",
                    .tolerance = {0.5, 3.0, 3.0},
                    .base = kSheet,
                    .measure = Measure::Areas});
    rows.push_back(
        {.name = "Complexity: type OBJECT_SPACE", .iv = "Complexity { type OBJECT_SPACE value 0.1 }", .effect = Effect::None});
    rows.push_back(
        {.name = "Complexity: type SCREEN_SPACE", .iv = "Complexity { type SCREEN_SPACE value 0.1 }", .effect = Effect::None});
    rows.push_back({.name = "Complexity: type BOUNDING_BOX", .iv = "Complexity { type BOUNDING_BOX }"});
    rows.push_back({.name = "ClipPlane", .iv = "ClipPlane { plane 0.6 0.8 0 40 }"});
    rows.push_back({.name = "ClipPlane: several",
                    .iv = "ClipPlane { plane 1 0 0 15 }\nClipPlane { plane 0 1 0 10 }\nClipPlane { plane -0.7 0 0.7 -30 }"});
    rows.push_back({.name = "ClipPlane under a transform",
                    .iv = "TransformSeparator { Rotation { rotation 0 0 1 0.5 } ClipPlane { plane 1 0 0 30 } }\nRotation { "
                          "rotation 0 0 1 0.5 }\nClipPlane { plane 1 0 0 30 }\nRotation { rotation 0 0 1 -0.5 }"});
    rows.push_back({.name = "ClipPlane: on FALSE", .iv = "ClipPlane { plane 0.6 0.8 0 40 on FALSE }", .effect = Effect::None});
    rows.push_back({.name = "DepthBuffer: test FALSE", .iv = "DepthBuffer { test FALSE }", .base = kSheet});
    rows.push_back({.name = "DepthBuffer: write FALSE",
                    .iv = std::string("Separator { DepthBuffer { write FALSE }\nUSE GROUND }\n") + kSheet});
    rows.push_back({.name = "DepthBuffer: function GREATER", .iv = "DepthBuffer { function GREATER }", .base = kSheet});
    rows.push_back({.name = "DepthBuffer: range", .iv = "DepthBuffer { range 0 0.1 }", .base = kSheet});
    return {"Styles, hints and clipping", "styles", rows};
}

namespace {

/// The node and, after it, nodes that it overrides.
template <class Node>
Property overriding(const std::string& name, const std::function<void(Node*)>& set, const std::string& after) {
    Property property{.name = name + ", override", .iv = after};
    property.dress = [set](SoGroup* group) {
        auto* node = new Node;
        set(node);
        node->setOverride(TRUE);
        group->addChild(node);
    };
    return property;
}

}  // namespace

Group overrides() {
    std::vector<Property> rows;
    const std::string green = "Material { diffuseColor 0 1 0 transparency 0.5 }";
    rows.push_back(overriding<SoMaterial>(
        "Material", [](SoMaterial* node) { node->diffuseColor = SbColor(0.9f, 0.3f, 0.1f); }, green));
    rows.push_back(overriding<SoMaterial>(
        "Material: emissiveColor alone",
        [](SoMaterial* node) {
            for (SoField* field : {static_cast<SoField*>(&node->diffuseColor), static_cast<SoField*>(&node->ambientColor),
                                   static_cast<SoField*>(&node->specularColor), static_cast<SoField*>(&node->shininess),
                                   static_cast<SoField*>(&node->transparency)})
                field->setIgnored(TRUE);
            node->emissiveColor = SbColor(0.3f, 0.0f, 0.3f);
        },
        "Material { diffuseColor 0 1 0 emissiveColor 0 0 1 }"));
    rows.push_back(overriding<SoLightModel>(
        "LightModel", [](SoLightModel* node) { node->model = SoLightModel::BASE_COLOR; }, "LightModel { model PHONG }"));
    rows.push_back(overriding<SoDrawStyle>(
        "DrawStyle", [](SoDrawStyle* node) { node->style = SoDrawStyle::LINES; }, "DrawStyle { style FILLED }"));
    rows.back().measure = Measure::Areas;
    rows.back().tolerance = {0.5, 3.0, 3.0};
    rows.push_back(overriding<SoComplexity>(
        "Complexity", [](SoComplexity* node) { node->type = SoComplexity::BOUNDING_BOX; }, "Complexity { type OBJECT_SPACE }"));
    rows.push_back(overriding<SoTexture2>(
        "Texture2",
        [](SoTexture2* node) {
            const std::uint8_t texels[] = {255, 80, 80, 80, 255, 80, 80, 80, 255, 255, 255, 80};
            node->image.setValue(SbVec2s(2, 2), 3, texels);
        },
        "Texture2 { " + imageText(3) + " }"));
    rows.push_back(overriding<SoShapeHints>(
        "ShapeHints",
        [](SoShapeHints* node) {
            node->vertexOrdering = SoShapeHints::COUNTERCLOCKWISE;
            node->shapeType = SoShapeHints::SOLID;
        },
        hints("vertexOrdering COUNTERCLOCKWISE shapeType UNKNOWN_SHAPE_TYPE")));
    rows.back().camera = kFromBelow;
    rows.back().measure = Measure::Areas;
    return {"Nodes with setOverride(TRUE)", "overrides", rows};
}

}  // namespace test::matrix
