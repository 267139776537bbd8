// Materials and their bindings, lights and normals of the matrix.
#include "Matrix.h"

#include <cmath>

namespace test::matrix {

namespace {

std::string number(double value) {
    return std::to_string(value) + ' ';
}

/// `count` values, each by the function of (column, row) of a grid so wide.
template <class Value>
std::string listed(int columns, int rows, const Value& value) {
    std::string text = "[ ";
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            text += value(column / double(std::max(columns - 1, 1)), row / double(std::max(rows - 1, 1))) + ", ";
    return text + "] ";
}

/// Colours that are soft over a grid, so that a mesh with other diagonals shows nearly the same.
std::string soft(double x, double y) {
    return number(x) + number(0.5 + 0.4 * std::sin(15.0 * y)) + number(0.2 + 0.5 * (1.0 - x));
}

std::string diffuse(int columns, int rows) {
    return "diffuseColor " + listed(columns, rows, soft);
}
std::string binding(const char* value) {
    return std::string("MaterialBinding { value ") + value + " }\n";
}
std::string material(const std::string& fields) {
    return "Material { " + fields + "}\n";
}

std::string packed(int columns, int rows, bool transparent) {
    return "PackedColor { orderedRGBA " +
           listed(columns, rows,
                  [&](double x, double y) {
                      char text[16];
                      const unsigned int red = unsigned(255.0 * x), green = unsigned(127.0 + 100.0 * std::sin(15.0 * y));
                      std::snprintf(text, sizeof text, "0x%02x%02x30%02x", red, green,
                                    transparent ? unsigned(100.0 + 155.0 * y) : 255u);
                      return std::string(text);
                  }) +
           "}\n";
}

constexpr int kSide = 65;

}  // namespace

Group materials() {
    const std::string green = "diffuseColor 0.2 0.8 0.3 ";
    const Tolerance flat{6.0, 6.0, 6.0}, quads{0.5, 1.0, 1.0};
    const std::string colours = "there is a material for each vertex, face or row";
    std::vector<Property> rows;
    rows.push_back({.name = "Material: diffuseColor", .iv = material(green), .tolerance = {0.2, 3.0, 3.0}});
    rows.push_back({.name = "Material: ambientColor",
                    .iv = material("ambientColor 0.9 0.2 0.2 "),
                    .base = "Environment { ambientIntensity 1 }"});
    rows.push_back({.name = "Material: emissiveColor", .iv = material("emissiveColor 0.4 0.1 0 ")});
    rows.push_back({.name = "Material: specularColor, shininess", .iv = material("specularColor 1 1 1 shininess 0.2 ")});
    rows.push_back({.name = "Material: several emissiveColor, specularColor, shininess",
                    .iv = material("emissiveColor [ 0.4 0.1 0, 0 0 1 ] specularColor [ 1 1 1, 0 1 0 ] shininess [ 0.2, 0.9 ] "),
                    .note = "Coin takes the first of each for all of a shape"});
    rows.push_back({.name = "Material: transparency", .iv = material("transparency 0.5 ")});
    rows.push_back({.name = "BaseColor", .iv = "BaseColor { rgb 0.9 0.5 0.1 }"});
    rows.push_back(
        {.name = "MaterialBinding OVERALL", .iv = material("diffuseColor [ 0.9 0.6 0.1, 0 0 1, 0 1 0 ]") + binding("OVERALL")});
    for (const char* value : {"PER_VERTEX", "PER_VERTEX_INDEXED"})
        rows.push_back({.name = std::string("MaterialBinding ") + value,
                        .iv = material(diffuse(kSide, kSide)) + binding(value),
                        .tolerance = quads,
                        .reference = value == std::string("PER_VERTEX") ? Reference::QuadMesh : Reference::FaceSet,
                        .arrays = colours});
    for (const char* value : {"PER_FACE", "PER_FACE_INDEXED"})
        rows.push_back({.name = std::string("MaterialBinding ") + value,
                        .iv = material(diffuse(kSide - 1, kSide - 1)) + binding(value),
                        .tolerance = flat,
                        .reference = Reference::QuadMesh,
                        .arrays = colours});
    for (const char* value : {"PER_PART", "PER_PART_INDEXED"})
        rows.push_back({.name = std::string("MaterialBinding ") + value,
                        .iv = material(diffuse(1, kSide - 1)) + binding(value),
                        .tolerance = flat,
                        .reference = Reference::QuadMesh,
                        .arrays = colours});
    rows.push_back({.name = "Material: diffuseColor and transparency per vertex",
                    .iv = material(diffuse(kSide, kSide) + "transparency " +
                                   listed(kSide, kSide, [](double, double y) { return number(0.8 * y); })) +
                          binding("PER_VERTEX_INDEXED"),
                    .arrays = colours});
    rows.push_back(
        {.name = "PackedColor per vertex", .iv = packed(kSide, kSide, false) + binding("PER_VERTEX_INDEXED"), .arrays = colours});
    rows.push_back({.name = "PackedColor per vertex, transparent",
                    .iv = packed(kSide, kSide, true) + binding("PER_VERTEX_INDEXED"),
                    .arrays = colours});
    rows.push_back({.name = "PackedColor OVERALL", .iv = "PackedColor { orderedRGBA 0x40c060ff }"});
    rows.push_back({.name = "Materials per vertex, LightModel BASE_COLOR",
                    .iv = material(diffuse(kSide, kSide)) + binding("PER_VERTEX_INDEXED") + "LightModel { model BASE_COLOR }",
                    .tolerance = quads,
                    .arrays = colours});
    return {"Materials",
            "materials",
            rows,
            {{"Fewer materials than a binding asks for",
              "Coin's own shapes read past the end of the array; terrain nodes take the last material for the rest, and say so"},
             {"SoVertexProperty", "a field of Coin's vertex shapes; terrain nodes take nodes before them"},
             {"SoColorIndex", "colour index mode, which no OpenGL since 3.0 has"}}};
}

}  // namespace test::matrix
