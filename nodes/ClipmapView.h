// One view of a geometry clipmap that is drawn by vertex textures.
#ifndef SOTERRAIN_CLIPMAPVIEW_H
#define SOTERRAIN_CLIPMAPVIEW_H

#include <memory>
#include <optional>
#include <string>

#include <SoTerrain/SoTerrainStatistics.h>

#include "TerrainFrame.h"
#include "gl/ClipmapRenderer.h"
#include "lod/Clipmap.h"

/// How the fields of an SoGeometryClipmapTerrain ask for a view to be drawn.
struct ClipmapOptions {
    terrain::ClipmapShape shape;
    terrain::ClipmapSettings settings;
    bool memoryFree = false;
    bool blendNormals = true;
    bool showLevels = false;
    bool freeze = false;
};

class ClipmapView : public ViewDrawing {
public:
    ClipmapView(const TerrainFrame & frame, const terrain::ClipmapShape & shape, bool memoryFree,
                std::shared_ptr<const terrain::SynthesisedDetail> detail);

    const terrain::ClipmapShape & shape() const { return shape_; }
    bool isFor(const terrain::ClipmapShape & shape, bool memoryFree, const std::shared_ptr<const terrain::SynthesisedDetail> & detail) const
    {
        return shape == shape_ && memoryFree == memoryFree_ && detail == detail_;
    }
    /// Draws, and fills in the statistics and the view's report. Returns what is wrong with GL, or nothing. Where something is, the view has no
    /// GL objects and does not try again as long as the same is asked of GL.
    std::optional<terrain::Error> render(const TerrainFrame & frame, const ClipmapOptions & options, const terrain::ClipmapErrors * errors,
                                         SoTerrainStatistics & statistics);

    bool isThere() const override { return renderer_.isThere(); }
    void update(const terrain::SampleGrid &, const terrain::GridEdits & edits) override { clipmap_.update(edits); }
    std::vector<terrain::GlName> release() override;
    std::size_t memoryBytes() const override { return clipmap_.bytes(); }
    std::size_t bufferBytes() const override { return renderer_.bufferBytes(); }

private:
    static terrain::ClipmapDrawing drawingOf(const TerrainFrame & frame, const ClipmapOptions & options);

    terrain::ClipmapShape shape_;
    bool memoryFree_;
    std::shared_ptr<const terrain::SynthesisedDetail> detail_;
    terrain::Clipmap clipmap_;
    terrain::ClipmapRenderer renderer_;
    bool hasFrame_ = false;
    std::optional<terrain::Error> problem_;   ///< why it can't be drawn
    terrain::ClipmapShading problemShading_;  ///< with this
};

/// Why the state can't be drawn by vertex textures; empty where it can. `isAffine`: StateAttributes::hasAffineTextureCoordinates().
std::string whyNotOnGpu(const TerrainFrame & frame, const terrain::ClipmapLayout & layout, bool isAffine);

#endif
