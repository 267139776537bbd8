// Textures of the matrix: models, wrap, units, transforms, coordinates.
#include "Matrix.h"

namespace test::matrix {

namespace {

std::string texture(int components, const std::string& fields = {}, int waves = 6) {
    return "Texture2 { " + imageText(components, waves) + fields + " }\n";
}

const char* const kGreen = "Material { diffuseColor 0.3 0.9 0.4 }";

std::string onSecondUnit(const std::string& nodes) {
    return "TextureUnit { unit 1 }\n" + nodes + "TextureUnit { unit 0 }\n";
}

/// A texture of 8 x 8 x 8 texels.
std::string volumeText() {
    std::string text = "images 8 8 8 3";
    for (int z = 0; z < 8; ++z)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) text += ' ' + std::to_string((x * 36) << 16 | (z * 36) << 8 | (255 - y * 36));
    return "Texture3 { " + text + " }\n";
}

std::string cubeText() {
    std::string text = "TextureCubeMap { ";
    const unsigned int colours[] = {0xff4020, 0x20ff40, 0x2040ff, 0xffff20, 0x20ffff, 0xff80ff};
    const char* const sides[] = {"imagePosX", "imageNegX", "imagePosY", "imageNegY", "imagePosZ", "imageNegZ"};
    for (int side = 0; side < 6; ++side) {
        text += std::string(sides[side]) + " 4 4 3";
        for (int i = 0; i < 16; ++i) text += ' ' + std::to_string(colours[side] - (i % 4) * 0x080808);
        text += ' ';
    }
    return text + "}\n";
}

/// (s, t, r) of each sample.
std::string spaceCoordinates() {
    std::string text = "TextureCoordinate3 { point [ ";
    for (int row = 0; row < ground().rows; ++row)
        for (int column = 0; column < ground().columns; ++column) {
            const SbVec3f& p = ground().at(column, row);
            text += std::to_string(p[0] / 64.0f) + ' ' + std::to_string(p[1] / 64.0f) + ' ' + std::to_string(p[2] / 20.0f) + ", ";
        }
    return text + "] }\n";
}

}  // namespace

Group textures() {
    std::vector<Property> rows;
    rows.push_back({.name = "Texture2", .iv = texture(3), .textureCoordinates = false});
    rows.push_back({.name = "Texture2, TextureCoordinate2", .iv = texture(3)});
    for (const char* model : {"MODULATE", "DECAL", "BLEND", "REPLACE"})
        for (const int components : {1, 2, 3, 4}) {
            const bool isUndefined = model == std::string("DECAL") && components < 3;
            rows.push_back({.name = std::string("Texture2: ") + model + ", " + std::to_string(components) +
                                    (components == 1 ? " component" : " components"),
                            .iv = texture(components, std::string("model ") + model + " blendColor 0.9 0.1 0.5"),
                            .base = kGreen,
                            .effect = isUndefined ? Effect::None : Effect::Shows,
                            .arrays = isUndefined ? "GL does not define DECAL" : "",
                            .note = isUndefined ? "up to the driver: GL does not define it" : ""});
        }
    for (const char* wrap : {"REPEAT", "CLAMP"})
        rows.push_back({.name = std::string("Texture2: wrapS, wrapT ") + wrap,
                        .iv = texture(3, std::string("wrapS ") + wrap + " wrapT " + wrap) +
                              "Texture2Transform { scaleFactor 2.5 2.5 translation -0.5 -0.5 }"});
    for (const char* quality : {"0", "0.1", "1"})
        rows.push_back({.name = std::string("Complexity: textureQuality ") + quality,
                        .iv = std::string("Complexity { textureQuality ") + quality + " }\n" + texture(3),
                        .effect = quality == std::string("0") ? Effect::None : Effect::Shows});
    rows.push_back(
        {.name = "Two texture units", .iv = texture(3) + onSecondUnit(texture(3, {}, 2)), .arrays = "texture unit 1 is in use"});
    rows.push_back(
        {.name = "Two texture units, the second alone", .iv = onSecondUnit(texture(3)), .arrays = "texture unit 1 is in use"});
    rows.push_back({.name = "Three texture units",
                    .iv = texture(3) + onSecondUnit(texture(3, {}, 2)) +
                          "TextureUnit { unit 2 }\nTextureCoordinatePlane { directionS 0.05 0 0 directionT 0 0.02 0.05 }\n" +
                          texture(1) + "TextureUnit { }",
                    .arrays = "texture unit 1 is in use"});
    rows.push_back({.name = "TextureCombine",
                    .iv = texture(3) + onSecondUnit("TextureCombine { rgbOperation ADD_SIGNED rgbSource [ TEXTURE, PREVIOUS ] }\n" +
                                                    texture(3, {}, 2)),
                    .arrays = "texture unit 1 is in use"});
    rows.push_back({.name = "TextureCombine of the first unit",
                    .iv = "TextureCombine { rgbOperation INTERPOLATE rgbSource [ TEXTURE, PRIMARY_COLOR, CONSTANT ] rgbOperand [ "
                          "SRC_COLOR, SRC_COLOR, SRC_COLOR ] constantColor 0.7 0.2 0.5 1 }\n" +
                          texture(3),
                    .base = kGreen,
                    .arrays = "an SoTextureCombine is active"});
    rows.push_back({.name = "AlphaTest", .iv = "AlphaTest { function GREATER value 0.5 }\n" + texture(4)});
    rows.push_back({.name = "Texture3, TextureCoordinate3",
                    .iv = spaceCoordinates() + volumeText(),
                    .arrays = "the texture is not two-dimensional"});
    rows.push_back({.name = "Texture3Transform",
                    .iv = spaceCoordinates() + "Texture3Transform { scaleFactor 2 1 3 }\n" + volumeText(),
                    .arrays = "the texture is not two-dimensional"});
    rows.push_back({.name = "TextureCubeMap, TextureCoordinateNormalMap",
                    .iv = "TextureCoordinateNormalMap { }\n" + cubeText(),
                    .arrays = "texture coordinates come from a function"});
    rows.push_back({.name = "TextureCubeMap, TextureCoordinateReflectionMap",
                    .iv = "TextureCoordinateReflectionMap { }\n" + cubeText(),
                    .arrays = "texture coordinates come from a function"});
    rows.push_back({.name = "TextureCubeMap, TextureCoordinate3",
                    .iv = spaceCoordinates() + cubeText(),
                    .arrays = "the texture is not two-dimensional"});
    rows.push_back({.name = "BumpMap", .iv = "BumpMap { " + imageText(1) + " }\n", .base = texture(3)});
    return {"Textures", "textures", rows};
}

Group textureCoordinates() {
    const std::string base = texture(3);
    const std::string function = "texture coordinates come from a function";
    std::vector<Property> rows;
    rows.push_back({.name = "Texture2Transform",
                    .iv = "Texture2Transform { translation 0.3 0.1 rotation 0.7 scaleFactor 2 1.5 center 0.5 0.5 }",
                    .base = base});
    rows.push_back({.name = "Texture2Transform twice",
                    .iv = "Texture2Transform { rotation 0.7 }\nTexture2Transform { scaleFactor 2 1.5 }",
                    .base = base});
    rows.push_back({.name = "TextureMatrixTransform",
                    .iv = "TextureMatrixTransform { matrix 1 0.5 0 0  -0.5 2 0 0  0 0 1 0  0.2 0.1 0 1 }",
                    .base = base});
    rows.push_back({.name = "TextureMatrixTransform with perspective",
                    .iv = "TextureMatrixTransform { matrix 1 0 0 0.8  0 1 0 0.4  0 0 1 0  0 0 0 1 }",
                    .base = base,
                    .arrays = "the texture matrix is a perspective one"});
    rows.push_back({.name = "TextureCoordinate3", .iv = spaceCoordinates(), .base = base});
    rows.push_back({.name = "TextureCoordinatePlane",
                    .iv = "TextureCoordinatePlane { directionS 0.02 0 0 directionT 0 0.02 0.03 }",
                    .base = base,
                    .arrays = function});
    rows.push_back(
        {.name = "TextureCoordinateEnvironment", .iv = "TextureCoordinateEnvironment { }", .base = base, .arrays = function});
    rows.push_back({.name = "TextureCoordinateObject",
                    .iv = "TextureCoordinateObject { factorS 0.02 0 0 0 factorT 0 0.03 0.02 0 }",
                    .base = base,
                    .arrays = function});
    for (const char* shape : {"Sphere", "Cylinder", "Cube"})
        rows.push_back({.name = std::string("TextureCoordinate") + shape,
                        .iv = std::string("TextureCoordinate") + shape + " { }",
                        .base = base,
                        .arrays = function});
    return {"Texture coordinates",
            "coordinates",
            rows,
            {{"SoTextureCoordinateDefault", "the texture spans the terrain, as without coordinates (first row of textures); on "
                                            "Coin's shapes it spans their bounding box"}}};
}

}  // namespace test::matrix
