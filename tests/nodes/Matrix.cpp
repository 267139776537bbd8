#include "Matrix.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include <Inventor/SbMatrix.h>
#include <Inventor/SbRotation.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>
#include <Inventor/nodes/SoTextureUnit.h>

#include <SoTerrain/SoGeometryClipmapTerrain.h>

using terrain::Image;

namespace test::matrix {

namespace {

constexpr int kWidth = 160, kHeight = 120;

Kind kindOf(Column column) {
    switch (column) {
    case Column::BruteForce:
        return Kind::BruteForce;
    case Column::Roam:
        return Kind::Roam;
    case Column::GeoMipmap:
        return Kind::GeoMipmap;
    case Column::ChunkedLod:
        return Kind::ChunkedLod;
    default:
        return Kind::Clipmap;
    }
}

SoTerrainShape* shapeFor(Column column) {
    SoTerrainShape* shape = test::nodeOf(kindOf(column), ground().columns, ground().rows, 0.0f);
    if (column == Column::ClipmapArrays)
        static_cast<SoGeometryClipmapTerrain*>(shape)->implementation = SoGeometryClipmapTerrain::CPU;
    return shape;
}

SoNode* faceSet(bool clockwise) {
    auto* shape = new SoIndexedFaceSet;
    std::vector<std::int32_t> indices;
    for (int row = 0; row < ground().rows - 1; ++row)
        for (int column = 0; column < ground().columns - 1; ++column) {
            const auto corner = [&](int dc, int dr) { return std::int32_t(ground().index(column + dc, row + dr)); };
            std::int32_t faces[2][3] = {{corner(0, 0), corner(1, 0), corner(0, 1)}, {corner(1, 0), corner(1, 1), corner(0, 1)}};
            for (auto& face : faces) {
                if (clockwise) std::swap(face[0], face[1]);
                indices.insert(indices.end(), face, face + 3);
                indices.push_back(-1);
            }
        }
    shape->coordIndex.setValues(0, int(indices.size()), indices.data());
    return shape;
}

SoNode* referenceShape(Reference reference) {
    if (reference != Reference::QuadMesh) return faceSet(reference == Reference::ClockwiseFaceSet);
    auto* mesh = new SoQuadMesh;
    mesh->verticesPerRow = ground().columns;
    mesh->verticesPerColumn = ground().rows;
    return mesh;
}

void addTextureCoordinates(SoGroup* group, bool turned) {
    std::vector<SbVec2f> st;
    for (int row = 0; row < ground().rows; ++row)
        for (int column = 0; column < ground().columns; ++column) {
            const float s = float(column) / float(ground().columns - 1), t = float(row) / float(ground().rows - 1);
            st.push_back(turned ? SbVec2f(1.0f - t, s) : SbVec2f(s, t));
        }
    for (const int unit : {1, 0}) {
        auto* where = new SoTextureUnit;
        where->unit = unit;
        group->addChild(where);
        auto* coordinates = new SoTextureCoordinate2;
        coordinates->point.setValues(0, int(st.size()), st.data());
        group->addChild(coordinates);
    }
}

void addData(SoGroup* group, const Property& property, bool isOurs) {
    auto* coordinates = new SoCoordinate3;
    coordinates->point.setValues(0, int(ground().points.size()), ground().points.data());
    group->addChild(coordinates);
    if (property.normals || !isOurs) {
        auto* normals = new SoNormal;
        normals->vector.setValues(0, int(ground().normals.size()), ground().normals.data());
        group->addChild(normals);
    }
    if (property.textureCoordinates || !isOurs) addTextureCoordinates(group, property.textureCoordinates);
}

void addAll(SoGroup* to, const std::string& text, SoNode* shape = nullptr, SoNode* groundNode = nullptr) {
    const Ref<SoGroup> nodes = nodesOf(text, shape, groundNode);
    for (int i = 0; i < nodes->getNumChildren(); ++i) to->addChild(nodes->getChild(i));
}

bool uses(const std::string& text, const char* name) {
    return text.find(std::string("USE ") + name) != std::string::npos;
}

/// Averages of blocks.
std::vector<double> areasOf(const Image& image) {
    constexpr int kSide = 8;
    const int across = image.width / kSide, down = image.height / kSide;
    std::vector<double> sums(std::size_t(across * down * 3));
    for (int y = 0; y < down * kSide; ++y)
        for (int x = 0; x < across * kSide; ++x)
            for (int c = 0; c < 3; ++c)
                sums[std::size_t(((y / kSide) * across + x / kSide) * 3 + c)] +=
                    image.pixels[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3 + std::size_t(c)] /
                    double(kSide * kSide);
    return sums;
}

}  // namespace

std::string nameOf(Column column) {
    switch (column) {
    case Column::BruteForce:
        return "SoBruteForceTerrain";
    case Column::Roam:
        return "SoROAMTerrain";
    case Column::GeoMipmap:
        return "SoGeoMipmapTerrain";
    case Column::ChunkedLod:
        return "SoChunkedLoDTerrain";
    case Column::Clipmap:
        return "SoGeometryClipmapTerrain";
    default:
        return "SoGeometryClipmapTerrain, implementation CPU";
    }
}

std::string identifierOf(Column column) {
    return column == Column::ClipmapArrays ? "SoGeometryClipmapTerrainCPU" : nameOf(column);
}

double Property::toleranceOf(Column column) const {
    if (column == Column::BruteForce) return tolerance.bruteForce;
    return column == Column::Clipmap && arrays.empty() ? tolerance.clipmap : tolerance.lod;
}

std::string Property::identifier() const {
    std::string result;
    bool starts = true;
    for (const char c : name) {
        if (std::isalnum(static_cast<unsigned char>(c))) result += starts ? char(std::toupper(static_cast<unsigned char>(c))) : c;
        starts = !std::isalnum(static_cast<unsigned char>(c));
    }
    return result;
}

const std::vector<Group>& groups() {
    static const std::vector<Group> all{materials(), textures(), textureCoordinates(), transparency(),
                                        lights(),    styles(),   overrides(),          shaders(),
                                        scenes(),    cameras()};
    return all;
}

const Surface& ground() {
    static const Surface surface = surfaceOf(fractalMap(65, 65, 20.0));
    return surface;
}

std::string cameraText(const SbVec3f& eye, const SbVec3f& target) {
    // The table is made before Coin is there, so without a camera node.
    SbVec3f back = eye - target;
    back.normalize();
    SbVec3f right = SbVec3f(0.0f, 0.0f, 1.0f).cross(back);
    right.normalize();
    const SbVec3f up = back.cross(right);
    const SbMatrix axes(right[0], right[1], right[2], 0.0f, up[0], up[1], up[2], 0.0f, back[0], back[1], back[2], 0.0f, 0.0f, 0.0f,
                        0.0f, 1.0f);
    SbVec3f axis;
    float angle = 0.0f;
    SbRotation(axes).getValue(axis, angle);
    std::string text = "PerspectiveCamera { nearDistance 1 farDistance 400 position";
    for (int i = 0; i < 3; ++i) text += ' ' + std::to_string(eye[i]);
    text += " orientation";
    for (int i = 0; i < 3; ++i) text += ' ' + std::to_string(axis[i]);
    return text + ' ' + std::to_string(angle) + " }\n";
}

std::string imageText(int components, int waves) {
    constexpr int kSide = 32;
    std::string text = "image " + std::to_string(kSide) + ' ' + std::to_string(kSide) + ' ' + std::to_string(components);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double wave = std::sin(waves * M_PI * (x + 0.5) / kSide) * std::sin(waves * M_PI * (y + 0.5) / kSide);
            const unsigned int red = unsigned(255.0 * x / kSide), green = unsigned(128.0 + 120.0 * wave),
                               blue = unsigned(255.0 * (kSide - 1 - y) / kSide);
            const unsigned int alpha = unsigned(128.0 + 127.0 * std::sin(M_PI * (x + 2 * y) / kSide));
            unsigned int texel = green;
            if (components == 2) texel = green << 8 | alpha;
            if (components >= 3) texel = red << 16 | green << 8 | blue;
            if (components == 4) texel = texel << 8 | alpha;
            text += ' ' + std::to_string(texel);
        }
    return text + ' ';
}

Ref<SoGroup> nodesOf(const std::string& text, SoNode* shape, SoNode* groundNode) {
    const std::string file = "#Inventor V2.1 ascii\nGroup {\n" + text + "\n}\n";
    SoInput in;
    in.setBuffer(file.data(), file.size());
    if (shape) in.addReference("SHAPE", shape, FALSE);
    if (groundNode) in.addReference("GROUND", groundNode, FALSE);
    SoNode* node = nullptr;
    if (!SoDB::read(&in, node) || !node || !node->isOfType(SoGroup::getClassTypeId())) {
        ADD_FAILURE() << "can't be read: " << text;
        return Ref<SoGroup>(new SoGroup);
    }
    return Ref<SoGroup>(static_cast<SoGroup*>(node));
}

Row::Row(const Property& property) : property_(property), stage_(kWidth, kHeight) {
    const auto shape = [&] { return referenceShape(property.reference); };
    without_ = drawn(scene(shape, false, false).get(), false);
    reference_ = drawn(scene(shape, false, true).get(), true);
}

Ref<SoSeparator> Row::scene(const std::function<SoNode*()>& makeShape, bool isOurs, bool withProperty) const {
    Ref<SoSeparator> root(new SoSeparator);
    const std::string camera = withProperty && !property_.view.empty() ? property_.view : property_.camera;
    if (camera.empty())
        root->addChild(cameraFor(ground().box()));
    else
        addAll(root.get(), camera);
    const bool replaced = withProperty && !property_.lights.empty();
    addAll(root.get(), replaced ? property_.lights : "DirectionalLight { direction 0.5 0.5 -1 }");
    const Ref<SoNode> shape(makeShape());
    const Ref<SoSeparator> around(new SoSeparator);
    addData(around.get(), property_, isOurs);
    addAll(around.get(), property_.base);
    if (withProperty && property_.dress) property_.dress(around.get());
    if (withProperty && uses(property_.iv, "SHAPE")) {
        addAll(around.get(), property_.iv, shape.get());
        root->addChild(around.get());
    } else if (withProperty && uses(property_.iv, "GROUND")) {
        around->addChild(shape.get());
        addAll(root.get(), property_.iv, nullptr, around.get());
    } else {
        if (withProperty) addAll(around.get(), property_.iv);
        around->addChild(shape.get());
        root->addChild(around.get());
    }
    return root;
}

Image Row::drawn(SoSeparator* root, bool withProperty) {
    return withProperty && property_.draw ? property_.draw(stage_, root) : stage_.render(root);
}

Image Row::picture(Column column) {
    return drawn(scene([&] { return shapeFor(column); }, true, true).get(), true);
}

std::string Row::messageForGpu() {
    const Messages messages;
    const auto shape = [] {
        SoTerrainShape* made = shapeFor(Column::Clipmap);
        static_cast<SoGeometryClipmapTerrain*>(made)->implementation = SoGeometryClipmapTerrain::GPU;
        return made;
    };
    drawn(scene(shape, true, true).get(), true);
    return messages.text();
}

double meanOverAll(const Image& first, const Image& second) {
    double sum = 0.0;
    for (std::size_t i = 0; i < first.pixels.size(); ++i) sum += std::abs(int(first.pixels[i]) - int(second.pixels[i]));
    return sum / double(std::max<std::size_t>(first.pixels.size(), 1));
}

double differenceOf(const Property& property, const Image& reference, const Image& picture) {
    if (property.measure == Measure::Pixels) return compare(reference, picture).mean;
    const std::vector<double> first = areasOf(reference), second = areasOf(picture);
    double sum = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i) sum += std::fabs(first[i] - second[i]);
    return sum / double(std::max<std::size_t>(first.size(), 1));
}

}  // namespace test::matrix
