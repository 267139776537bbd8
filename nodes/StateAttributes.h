// Normals, colours and texture coordinates of the traversal state, by sample.
#ifndef SOTERRAIN_STATEATTRIBUTES_H
#define SOTERRAIN_STATEATTRIBUTES_H

#include <string>
#include <vector>

#include <Inventor/SbVec2f.h>
#include <Inventor/SbVec3f.h>
#include <Inventor/SbVec4f.h>

#include "gl/TerrainRenderer.h"
#include "height/SampleGrid.h"

class SoAction;
class SoLazyElement;
class SoNormalElement;
class SoState;
class SoMultiTextureCoordinateElement;

/// What SoQuadMesh would take from the state for each of its vertices. As there, normals, materials and texture coordinates are
/// counted from 0 whatever startIndex is. With bindings per face or per row, which a mesh with level of detail can't show exactly, a
/// vertex has the value of the face or row that begins at it. Valid during the traversal.
class StateAttributes : public terrain::VertexSource {
public:
    /// `forGL`: leave out what lighting and textures do not need.
    StateAttributes(SoAction * action, const terrain::SampleGrid & grid, bool forGL);

    const terrain::VertexFormat & format() const override { return format_; }
    std::uint64_t version() const override { return version_; }
    void write(std::uint32_t sample, std::uint8_t * out) const override;
    /// What the samples' triangle shows there: normals and texture coordinates in between, the colour of the nearest sample.
    void writeAt(glm::vec2 place, std::uint32_t nearest, std::uint8_t * out) const override;
    void prefetch(std::uint32_t sample) const override;

    /// What the state has too few of, and what is done about it.
    const std::vector<std::string> & problems() const { return problems_; }

    /// Lighting is on and all vertices have the one normal().
    bool hasOverallNormal() const { return needsNormals_ && !format_.normals; }
    bool hasExplicitNormals() const { return normalBinding_ != GENERATED; }
    SbVec3f normal(int column, int row) const;
    /// Whether explicit normals, if there are any and lighting is on, are those of the surface to within some ten degrees.
    bool hasNormalsOfSurface() const;
    /// (s, t, r, q): explicit, from a function of point and normal, or such that the texture spans the terrain.
    SbVec4f wideTextureCoordinate(int unit, int column, int row) const;
    /// (s, t) of it, divided by q.
    SbVec2f textureCoordinate(int unit, int column, int row) const;
    /// Whether coordinates of the unit come from a function, GL's own or Coin's.
    bool hasTextureFunction(int unit) const;
    /// Whether texture coordinates are a linear function of columns and rows, to within a thousandth of the texture.
    bool hasAffineTextureCoordinates(int unit) const;
    /// Index into the state's materials.
    int materialIndex(int column, int row) const;

    /// A corner of a triangle of one cell, which at full detail has the cell's own value where that is bound per face or row.
    struct Corner {
        int cellColumn, cellRow;
        int column, row;
    };
    int materialIndex(const Corner & corner) const;
    /// Index into the state's normals; of generated ones, the sample's.
    int normalIndex(const Corner & corner) const;
    SbVec3f normal(const Corner & corner) const;
    /// All four coordinates of the first unit, as the state has them or as its texture coordinate function makes them of a vertex.
    SbVec4f textureCoordinates(const Corner & corner) const;

private:
    enum Binding { OVERALL, PER_ROW, PER_FACE, PER_VERTEX, GENERATED };

    void readNormals(SoState * state);
    void readMaterials(SoState * state);
    void readTextures(SoState * state, bool forGL);
    long countFor(Binding binding) const;
    bool isEnough(const char * what, Binding binding, long found, const char * remedy);
    int boundIndex(Binding binding, int column, int row, int count) const;
    SbVec3f generatedNormal(int column, int row) const;
    SbVec3f regularNormal(int column, int row) const;
    void writeCoordinate(int unit, const SbVec4f & coordinate, std::uint8_t *& out) const;
    void writeColour(int column, int row, std::uint8_t * out) const;
    void mix(std::uint64_t value) { version_ = (version_ ^ value) * 0x100000001b3ull; }

    const terrain::SampleGrid & grid_;
    terrain::VertexFormat format_;
    std::uint64_t version_ = 0xcbf29ce484222325ull;
    std::vector<std::string> problems_;
    bool needsNormals_ = true;
    Binding normalBinding_ = GENERATED;
    Binding materialBinding_ = OVERALL;
    const SbVec3f * normals_ = nullptr;
    int normalCount_ = 0;
    const SoLazyElement * lazy_ = nullptr;
    int materialCount_ = 0;
    const SoMultiTextureCoordinateElement * textureCoordinates_ = nullptr;
};

#endif
