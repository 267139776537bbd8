// The matrix of node and property: every rendering property of Coin acts on every terrain node as on Coin's own shapes, within a
// stated difference. The table of properties is the source of docs/compatibility.md as well.
#pragma once

#include "Scenes.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace test::matrix {

/// The columns: each terrain node, geometry clipmaps as they choose for themselves (AUTO) and from vertex arrays.
enum class Column { BruteForce, Roam, GeoMipmap, ChunkedLod, Clipmap, ClipmapArrays };
inline constexpr Column kColumns[] = {Column::BruteForce, Column::Roam,    Column::GeoMipmap,
                                      Column::ChunkedLod, Column::Clipmap, Column::ClipmapArrays};
/// As the docs call it, and for names of tests.
std::string nameOf(Column column);
std::string identifierOf(Column column);

/// How far a picture may be from the reference: mean absolute difference of a channel over covered pixels, of 255.
struct Tolerance {
    double bruteForce = 0.2;
    double lod = 1.0;      ///< nodes with level of detail from vertex arrays: their triangles have other diagonals
    double clipmap = 3.0;  ///< geometry clipmaps, which are lit per pixel on the GPU
};

/// What the picture of our node is compared with.
enum class Reference {
    FaceSet,           ///< SoIndexedFaceSet, two counter-clockwise triangles a cell
    ClockwiseFaceSet,  ///< the same the other way round
    QuadMesh,          ///< where bindings per face and row mean the cells and rows of a grid
};

/// What a property does to the reference's picture, which is checked too: a property that does not show has not been tested.
enum class Effect { Shows, None };

/// How pictures are compared.
enum class Measure {
    Pixels,  ///< the same pixels are covered but for a rim of two, and colours differ by the tolerance on average
    Areas,   ///< lines and points: averages of blocks of 8 x 8 pixels, over all of the picture
};

/// A row. Texts are nodes as in an .iv file; SHAPE and GROUND in them stand by USE for the shape alone and for it with its data.
struct Property {
    std::string name;     ///< as the docs call it
    std::string iv = {};  ///< the property: before the shape; or around it, if it uses SHAPE or GROUND
    Tolerance tolerance = {};
    std::string base = {};    ///< before the shape, also in the picture without the property
    std::string lights = {};  ///< part of the property: takes the place of the light
    std::string view = {};    ///< part of the property: takes the place of the camera
    std::string camera = {};  ///< takes the place of the camera in both pictures
    Reference reference = Reference::FaceSet;
    Effect effect = Effect::Shows;
    Measure measure = Measure::Pixels;
    std::string arrays = {};         ///< why geometry clipmaps draw vertex arrays here; empty where the GPU draws
    std::string note = {};           ///< for the docs
    bool normals = true;             ///< explicit ones for the node; the reference always has them
    bool textureCoordinates = true;  ///< explicit ones for the node, a quarter turn off; else it spans the terrain
    /// Draws, where one pass of the render action is not all.
    std::function<terrain::Image(Stage&, SoSeparator*)> draw = {};
    /// What nodes of a file can't say, on the group of coordinates, properties and shape, with the shape still to come.
    std::function<void(SoGroup*)> dress = {};

    double toleranceOf(Column column) const;
    /// For names of tests: letters and digits of the name.
    std::string identifier() const;
};

/// Rows that belong together.
struct Group {
    std::string name;
    std::string identifier;
    std::vector<Property> properties;
    /// Properties that are no row, each with its reason.
    std::vector<std::pair<std::string, std::string>> leftOut = {};
};
const std::vector<Group>& groups();

Group materials();
Group textures();
Group textureCoordinates();
Group transparency();
Group lights();
Group styles();
Group overrides();
Group shaders();
Group scenes();
Group cameras();

/// What is drawn: 65 x 65 samples of fractal hills.
const Surface& ground();
/// A perspective camera as text.
std::string cameraText(const SbVec3f& eye, const SbVec3f& target);
/// An image field as text: soft coloured waves. Of two and four components the last one is alpha.
std::string imageText(int components, int waves = 6);
/// Nodes of a text under a group. `shape` and `groundNode` are what SHAPE and GROUND stand for.
Ref<SoGroup> nodesOf(const std::string& text, SoNode* shape = nullptr, SoNode* groundNode = nullptr);

/// Pictures of a row with Coin's shape, and ours in every column.
class Row {
public:
    explicit Row(const Property& property);
    const terrain::Image& without() const { return without_; }
    const terrain::Image& reference() const { return reference_; }
    terrain::Image picture(Column column);
    /// What a geometry clipmap says when it is asked for the GPU.
    std::string messageForGpu();

private:
    Ref<SoSeparator> scene(const std::function<SoNode*()>& shape, bool isOurs, bool withProperty) const;
    terrain::Image drawn(SoSeparator* root, bool withProperty);

    const Property& property_;
    Stage stage_;
    terrain::Image without_, reference_;
};

/// Differences as Property::measure has them.
double differenceOf(const Property& property, const terrain::Image& reference, const terrain::Image& picture);
/// Mean absolute difference over all pixels.
double meanOverAll(const terrain::Image& first, const terrain::Image& second);

/// docs/compatibility.md.
std::string documentText();

}  // namespace test::matrix
