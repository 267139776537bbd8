// Lights, light models, fog and normals of the matrix.
#include "Matrix.h"

#include <cmath>

namespace test::matrix {

namespace {

/// Normals that turn softly over a grid.
std::string slopes(int columns, int rows) {
    std::string text = "Normal { vector [ ";
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            SbVec3f normal(std::sin(0.2f * float(column)), 0.6f * std::sin(0.25f * float(row)), 1.0f);
            normal.normalize();
            for (int i = 0; i < 3; ++i) text += std::to_string(normal[i]) + ' ';
            text += ", ";
        }
    return text + "] }\n";
}

}  // namespace

Group lights() {
    const std::string spot =
        "SpotLight { location 30 30 45 direction 0.1 0.1 -1 color 1 0.9 0.5 cutOffAngle 0.6 dropOffRate 0.3 }\n";
    const std::string point = "PointLight { location 25 20 25 color 1 0.3 0.2 }\n";
    const std::string shine = "Material { specularColor 0.8 0.8 0.8 shininess 0.3 }";
    std::vector<Property> rows;
    rows.push_back(
        {.name = "DirectionalLight", .lights = "DirectionalLight { direction -0.7 0.3 -0.5 color 0.3 0.9 1 intensity 0.8 }"});
    rows.push_back({.name = "PointLight", .lights = point});
    rows.push_back({.name = "PointLight on shiny ground", .base = shine, .lights = point});
    rows.push_back({.name = "SpotLight", .lights = spot});
    rows.push_back({.name = "Several lights",
                    .base = shine,
                    .lights = "DirectionalLight { direction 1 0 -0.3 color 0.2 0.2 0.6 }\n" + point + spot});
    rows.push_back({.name = "Eight lights",
                    .lights = "DirectionalLight { direction 1 0 -0.3 color 0.2 0.2 0.6 }\n" + point + spot + spot + point +
                              "DirectionalLight { direction 0 1 -0.3 color 0.2 0 0 }\nDirectionalLight { direction 0 -1 -0.3 color "
                              "0 0.2 0 }\nDirectionalLight { direction 0 0 -1 intensity 0.2 }\n"});
    rows.push_back({.name = "No light", .lights = "Info { }"});
    rows.push_back(
        {.name = "Lights switched off",
         .lights = "DirectionalLight { on FALSE }\nPointLight { on FALSE }\nDirectionalLight { direction 0 1 -1 color 1 1 0 }"});
    rows.push_back({.name = "Light under a transform",
                    .lights = "TransformSeparator { Rotation { rotation 1 0 0 0.8 } Translation { translation 0 0 5 } "
                              "DirectionalLight { color 1 0.5 0.2 } }\nTransform { translation 20 20 20 }\nPointLight { color 0.2 "
                              "0.2 1 }\nTransform { translation -20 -20 -20 }"});
    rows.push_back({.name = "LightModel BASE_COLOR", .iv = "LightModel { model BASE_COLOR }"});
    rows.push_back({.name = "LightModel PHONG", .iv = "LightModel { model PHONG }", .base = "LightModel { model BASE_COLOR }"});
    rows.push_back(
        {.name = "Environment: ambientColor, ambientIntensity",
         .lights = "Environment { ambientColor 0.4 0.6 1 ambientIntensity 1 }\nDirectionalLight { direction 0.5 0.5 -1 }"});
    rows.push_back({.name = "Environment: attenuation", .lights = "Environment { attenuation 0.003 0.01 0.2 }\n" + point + spot});
    for (const char* fog : {"HAZE", "FOG", "SMOKE"}) {
        const std::string node = std::string("Environment { fogType ") + fog + " fogColor 0.8 0.9 1 fogVisibility 110 }\n";
        rows.push_back({.name = std::string("Environment: fogType ") + fog, .iv = node});
        rows.push_back({.name = std::string("Environment: fogType ") + fog + " over a texture without light",
                        .iv = node,
                        .base = "LightModel { model BASE_COLOR }\nTexture2 { " + imageText(3) + " }"});
    }
    rows.push_back({.name = "NormalBinding OVERALL",
                    .iv = "NormalBinding { value OVERALL }\nNormal { vector 0.3 0.2 0.93 }",
                    .arrays = "there is one normal for all"});
    for (const std::string binding :
         {"PER_VERTEX", "PER_VERTEX_INDEXED", "PER_FACE", "PER_FACE_INDEXED", "PER_PART", "PER_PART_INDEXED"}) {
        const bool isRow = binding.find("PART") != std::string::npos, isFace = binding.find("FACE") != std::string::npos;
        rows.push_back({.name = "NormalBinding " + binding,
                        .iv = "NormalBinding { value " + binding + " }\n" +
                              slopes(isRow    ? 1
                                     : isFace ? 64
                                              : 65,
                                     isRow || isFace ? 64 : 65),
                        .tolerance = isRow || isFace ? Tolerance{6.0, 6.0, 6.0} : Tolerance{0.5, 1.0, 3.0},
                        .reference = Reference::QuadMesh,
                        .arrays = "normals are not those of the ground"});
    }
    rows.push_back({.name = "Normals of the node itself", .iv = "Material { diffuseColor 0.2 0.8 0.3 }", .normals = false});
    return {"Lights, fog and normals", "lights", rows};
}

}  // namespace test::matrix
