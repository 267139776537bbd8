#include "SceneGrammar.h"

#include <algorithm>
#include <sstream>

#include <Inventor/SbName.h>
#include <Inventor/fields/SoMField.h>
#include <Inventor/fields/SoSFEnum.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/fields/SoSFString.h>
#include <Inventor/lists/SoFieldList.h>
#include <Inventor/nodes/SoNode.h>

#include <SoTerrain/SoTerrainShape.h>

#include "Input.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace fuzz {

namespace {

using Random = std::mt19937;

int below(Random& random, std::size_t count) {
    return int(random() % count);
}
bool oneIn(Random& random, int count) {
    return below(random, std::size_t(count)) == 0;
}

template <class Choices>
const auto& oneOf(Random& random, const Choices& choices) {
    return choices[random() % std::size(choices)];
}

constexpr long kIntegers[] = {
    0,         1,  -1,  2,   3,   4,   5,   7,   8,    9,    15,   16,    17,      25, 31, 33,         63,
    64,        81, 127, 128, 255, 256, 289, 511, 1023, 1024, 4096, 65536, 1000000, -2, -7, 2147483647, -2147483647 - 1,
    4294967295};
/// As Coin reads them: what is too large becomes infinite.
constexpr const char* kReals[] = {"0",     "1",   "-1",   "0.5",  "2",    "3",     "10",     "40",   "1e-6", "1e-38",
                                  "1e-45", "1e6", "-1e6", "1e18", "1e38", "-1e38", "3.4e38", "1e39", "-1e39"};

std::string real(Random& random) {
    if (oneIn(random, 3)) return oneOf(random, kReals);
    return std::to_string(double(below(random, 4000)) / 100.0 - 10.0);
}

std::string integer(Random& random) {
    return std::to_string(oneIn(random, 4) ? long(below(random, 40)) : oneOf(random, kIntegers));
}

/// What a value of a type is made of, by the name of the type without SoSF.
std::string components(const std::string& type, Random& random) {
    if (type == "Bool") return oneIn(random, 20) ? "2" : oneIn(random, 2) ? "TRUE" : "FALSE";
    if (type == "Int32" || type == "UInt32" || type == "Short" || type == "UShort" || type == "BitMask") return integer(random);
    if (type == "Float" || type == "Double" || type == "Time") return real(random);
    int count = type == "Rotation" || type == "Plane" || type == "ColorRGBA" ? 4 : type == "Color" ? 3 : 0;
    if (type.starts_with("Vec")) count = type[3] - '0';
    const bool isWhole = type.starts_with("Vec") && type.back() != 'f' && type.back() != 'd';
    std::string text;
    for (int i = 0; i < count; ++i) text += (i ? " " : "") + (isWhole ? integer(random) : real(random));
    return text;
}

/// Coin's own nodes, with values that Coin itself is up to.
constexpr const char* kStates[] = {
    "Normal { vector [ 0 0 1, 0 1 0, 1 0 0, 0 0 0 ] }",
    "Normal { vector [ ] }",
    "NormalBinding { value PER_VERTEX }",
    "NormalBinding { value PER_FACE }",
    "NormalBinding { value PER_PART }",
    "NormalBinding { value OVERALL }",
    "Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] transparency [ 0, 0.5, 1 ] }",
    "Material { diffuseColor [ ] shininess 1 }",
    "MaterialBinding { value PER_VERTEX }",
    "MaterialBinding { value PER_FACE }",
    "MaterialBinding { value PER_PART_INDEXED }",
    "PackedColor { orderedRGBA [ 0xff0000ff, 0x00ff0080 ] }",
    "TextureCoordinate2 { point [ 0 0, 1 0, 0 1, 1 1, 0.5 0.5 ] }",
    "TextureCoordinate2 { point [ ] }",
    "TextureCoordinateBinding { value PER_VERTEX_INDEXED }",
    "TextureCoordinatePlane { }",
    "TextureCoordinateEnvironment { }",
    "Texture2 { image 2 2 3 0xff0000 0x00ff00 0x0000ff 0xffffff }",
    "Texture2 { image 2 2 4 0xff000080 0x00ff0080 0x0000ff80 0xffffff00 model DECAL }",
    "TextureUnit { unit 1 }",
    "Texture2Transform { scaleFactor 3 0 rotation 1 }",
    "ShapeHints { vertexOrdering CLOCKWISE shapeType SOLID }",
    "ShapeHints { vertexOrdering COUNTERCLOCKWISE }",
    "Complexity { value 0 }",
    "Complexity { value 1 type BOUNDING_BOX }",
    "Complexity { value 0.3 type SCREEN_SPACE }",
    "DrawStyle { style LINES lineWidth 3 }",
    "DrawStyle { style POINTS pointSize 2 }",
    "DrawStyle { style INVISIBLE }",
    "LightModel { model BASE_COLOR }",
    "LightModel { model PHONG }",
    "PointLight { location 3 3 3 }",
    "SpotLight { location 4 4 9 }",
    "DirectionalLight { direction 1 1 -1 }",
    "ClipPlane { plane 1 0 0 2 }",
    "ClipPlane { plane 0 0 1 1e30 }",
    "Environment { fogType FOG fogVisibility 20 }",
    "Environment { fogType SMOKE fogVisibility 0 }",
    "Scale { scaleFactor 1 1 0.01 }",
    "Scale { scaleFactor -1 2 1 }",
    "Scale { scaleFactor 0 0 0 }",
    "Scale { scaleFactor 1e18 1e18 1e18 }",
    "Translation { translation 1e6 -1e6 3 }",
    "Rotation { rotation 1 0 0 1.57 }",
    "MatrixTransform { matrix 1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1 }",
    "MatrixTransform { matrix 1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1 }",
    "PickStyle { style UNPICKABLE }",
    "PickStyle { style BOUNDING_BOX }",
    "Coordinate4 { point [ 0 0 0 1, 1 0 0 1, 0 1 0 1, 1 1 1 0 ] }",
    "DepthBuffer { test FALSE }",
    "PolygonOffset { factor 2 }",
    "ResetTransform { }",
    "FrustumCamera { left -1 right 1 top 1 bottom -1 }",
    "ShaderProgram { shaderObject [ VertexShader { sourceType GLSL_PROGRAM sourceProgram \"void main() { gl_Position = "
    "ftransform(); }\" } ] }",
};

SoNode* prototypeOf(const std::string& name) {
    const SoType type = SoType::fromName(SbName(name.c_str()));
    if (type.isBad() || !type.canCreateInstance() || !type.isDerivedFrom(SoNode::getClassTypeId())) return nullptr;
    auto* node = static_cast<SoNode*>(type.createInstance());
    node->ref();
    return node;
}

std::string namePart(const std::string& line) {
    return line.substr(0, line.find(' '));
}

}  // namespace

SceneGrammar::SceneGrammar(std::vector<std::string> files) : files_(std::move(files)) {
    std::istringstream words(SOTERRAIN_NODE_CLASSES);
    for (std::string word; words >> word;) {
        SoNode* node = prototypeOf(word);
        if (!node) continue;
        classes_.push_back(word);
        if (node->isOfType(SoTerrainShape::getClassTypeId())) shapes_.push_back(word);
        node->unref();
    }
    check(!shapes_.empty(), "no terrain nodes");
}

std::string SceneGrammar::value(SoField* field, Random& random, int depth) const {
    std::string type = field->getTypeId().getName().getString();
    if (field->isOfType(SoMField::getClassTypeId())) {
        const std::string single = "SoSF" + type.substr(4);
        const SoType singleType = SoType::fromName(SbName(single.c_str()));
        if (singleType.isBad() || !singleType.canCreateInstance()) return "[ ]";
        auto* one = static_cast<SoField*>(singleType.createInstance());
        std::string text = "[ ";
        for (int count = below(random, oneIn(random, 5) ? 100 : 6); count > 0; --count)
            text += value(one, random, depth) + (count > 1 ? ", " : " ");
        delete one;
        return text + "]";
    }
    if (field->isOfType(SoSFString::getClassTypeId())) {
        if (oneIn(random, 8)) return '"' + std::string(std::size_t(1) << below(random, 14), 'x') + '"';
        return '"' + oneOf(random, files_) + '"';
    }
    if (field->isOfType(SoSFEnum::getClassTypeId())) {
        auto* choice = static_cast<SoSFEnum*>(field);
        SbName name("NONE");
        if (choice->getNumEnums() > 0) choice->getEnum(below(random, std::size_t(choice->getNumEnums())), name);
        return oneIn(random, 12) ? integer(random) : name.getString();
    }
    if (field->isOfType(SoSFNode::getClassTypeId())) {
        if (depth > 1 || oneIn(random, 3)) return "NULL";
        return oneIn(random, 3) ? stateNode(random) : node(oneOf(random, classes_), random, depth + 1);
    }
    const std::string text = components(type.substr(4), random);
    if (!text.empty()) return text;
    SbString unknown;
    field->get(unknown);
    return unknown.getString();
}

std::string SceneGrammar::value(const std::string& className, const std::string& fieldName, Random& random) const {
    SoNode* node = prototypeOf(className);
    if (!node) return {};
    SoField* field = node->getField(SbName(fieldName.c_str()));
    std::string text = field ? value(field, random, 0) : std::string();
    node->unref();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

std::string SceneGrammar::node(const std::string& name, Random& random, int depth) const {
    SoNode* node = prototypeOf(name);
    SoFieldList fields;
    node->getFields(fields);
    std::string text = name + " {\n";
    for (int i = 0; i < fields.getLength(); ++i) {
        if (random() % 2) continue;
        SbName fieldName;
        node->getFieldName(fields[i], fieldName);
        std::string chosen = value(fields[i], random, depth);
        std::replace(chosen.begin(), chosen.end(), '\n', ' ');
        if (!chosen.empty()) text += std::string(" ") + fieldName.getString() + ' ' + chosen + '\n';
    }
    node->unref();
    return text + '}';
}

std::string SceneGrammar::stateNode(Random& random) const {
    return oneOf(random, kStates);
}

std::string SceneGrammar::coordinates(Random& random) const {
    constexpr int kSides[] = {0, 1, 2, 3, 5, 9, 9, 17};
    const int columns = oneOf(random, kSides), rows = oneIn(random, 3) ? oneOf(random, kSides) : columns, kind = below(random, 5);
    std::ostringstream text;
    text << "Coordinate3 { point [ ";
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double bend = kind == 1 ? 0.3 * ((row * 7 + column * 5) % 3) : 0.0;
            text << column + bend << ' ' << (kind == 2 ? 0.0 : row - bend) << ' ';
            if (kind < 3)
                text << (row * column) % 4;
            else if (kind == 3)
                text << (oneIn(random, 5) ? "1e39" : "1");
            else
                text << real(random);
            text << ", ";
        }
    text << "] }";
    return text.str();
}

std::string SceneGrammar::fieldName(Random& random) const {
    const std::string& name = oneOf(random, classes_);
    SoNode* node = prototypeOf(name);
    SoFieldList fields;
    node->getFields(fields);
    SbName field("none");
    if (fields.getLength() > 0) node->getFieldName(fields[below(random, std::size_t(fields.getLength()))], field);
    node->unref();
    return name + '.' + field.getString();
}

std::string SceneGrammar::note(Random& random) const {
    switch (below(random, 8)) {
    case 0:
        return "#view " + std::to_string(random());
    case 3:
    case 4: {
        std::string text = "#heights";
        for (int i = 0; i < 4; ++i) text += ' ' + (oneIn(random, 8) ? integer(random) : std::to_string(below(random, 18)));
        return text + ' ' + std::to_string(random());
    }
    case 1:
        return "#again";
    case 2:
        return "#connect " + fieldName(random) + ' ' + fieldName(random);
    default:
        break;
    }
    const std::string name = fieldName(random);
    const std::size_t dot = name.find('.');
    return "#set " + name + ' ' + (oneIn(random, 4) ? "NaN" : value(name.substr(0, dot), name.substr(dot + 1), random));
}

std::string SceneGrammar::block(Random& random) const {
    switch (below(random, 8)) {
    case 0:
        return coordinates(random);
    case 1:
    case 2:
        return stateNode(random);
    case 3:
    case 4:
        return node(oneOf(random, classes_), random, 0);
    case 5:
        return "SoHeightMap {\n filename \"" + oneOf(random, files_) + "\"\n}";
    default:
        return node(oneOf(random, shapes_), random, 0);
    }
}

std::string SceneGrammar::scene(Random& random) const {
    Parts parts;
    parts.notes.push_back("#view " + std::to_string(random()));
    while (oneIn(random, 2)) parts.notes.push_back(note(random));
    while (oneIn(random, 2)) parts.blocks.push_back(stateNode(random));
    // Most scenes are to be drawn, so most of them hold what can be.
    if (oneIn(random, 3))
        parts.blocks.push_back(coordinates(random));
    else
        parts.blocks.push_back("SoHeightMap {\n filename \"" + files_.front() + "\"\n heightScale 0.05\n}");
    for (int count = 1 + below(random, 3); count > 0; --count) parts.blocks.push_back(block(random));
    parts.blocks.push_back(node(oneOf(random, shapes_), random, 0));
    return joined(parts);
}

SceneGrammar::Parts SceneGrammar::parse(const std::string& text) {
    Parts parts;
    std::istringstream lines(text);
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (inside && !parts.blocks.empty()) {
            parts.blocks.back() += '\n' + line;
            inside = line != "}";
        } else if (line.starts_with("#")) {
            if (!line.starts_with("#Inventor")) parts.notes.push_back(line);
        } else if (!line.empty() && line != "Separator {" && line != "}") {
            parts.blocks.push_back(line);
            inside = line.ends_with(" {");
        }
    }
    if (inside) parts.blocks.clear();
    return parts;
}

std::string SceneGrammar::joined(const Parts& parts) {
    std::string text = "#Inventor V2.1 ascii\n";
    for (const std::string& note : parts.notes) text += note + '\n';
    text += "Separator {\n";
    for (const std::string& block : parts.blocks) text += block + '\n';
    return text + "}\n";
}

void SceneGrammar::changeValue(std::string& block, Random& random) const {
    std::vector<std::string> lines;
    std::istringstream stream(block);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    if (lines.size() < 3) return;
    std::string& line = lines[1 + random() % (lines.size() - 2)];
    const std::string name = namePart(line.substr(line.find_first_not_of(' ')));
    const std::size_t begin = 2 + name.size();
    if (oneIn(random, 8) && line.size() > begin) {
        // Bytes at random, but none that end a value, a node or a line: what the parser makes of those is Coin's own affair.
        std::string bytes = line.substr(begin) + std::string(8, '\0');
        bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size() - 8, bytes.size()));
        for (char& c : bytes)
            if (c < ' ' || c > '~' || std::string_view("{}[]\"#&@\\~|").find(c) != std::string_view::npos) c = '0';
        if (line.find('"') == std::string::npos) line = line.substr(0, begin) + bytes;
    } else {
        line = " " + name + ' ' + value(namePart(lines[0]), name, random);
    }
    block.clear();
    for (const std::string& each : lines) block += (block.empty() ? "" : "\n") + each;
}

void SceneGrammar::changeOnce(Parts& parts, Random& random) const {
    const std::size_t at = random() % parts.blocks.size();
    const auto place = parts.blocks.begin() + std::ptrdiff_t(at);
    switch (below(random, 10)) {
    case 0:
        parts.blocks.insert(place, block(random));
        break;
    case 1:
        if (parts.blocks.size() > 1) parts.blocks.erase(place);
        break;
    case 2:
        *place = block(random);
        break;
    case 3:
        std::swap(*place, parts.blocks[random() % parts.blocks.size()]);
        break;
    case 4:
        parts.notes.push_back(note(random));
        break;
    case 5:
        if (!parts.notes.empty()) parts.notes.erase(parts.notes.begin() + below(random, parts.notes.size()));
        break;
    case 6:
        if (const std::string name = namePart(*place); std::find(shapes_.begin(), shapes_.end(), name) != shapes_.end())
            *place = oneOf(random, shapes_) + place->substr(name.size());
        break;
    default:
        changeValue(*place, random);
    }
}

std::string SceneGrammar::changed(const std::string& text, Random& random) const {
    Parts parts = parse(text);
    if (parts.blocks.empty() || oneIn(random, 20)) return scene(random);
    for (int changes = 1 + below(random, 3); changes > 0; --changes) changeOnce(parts, random);
    return joined(parts);
}

}  // namespace fuzz
