// Pictures of a terrain's mesh for people who look at the algorithm.
#ifndef SOTERRAIN_MESHPICTURE_H
#define SOTERRAIN_MESHPICTURE_H

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <SoTerrain/SoTerrainShape.h>

#include "base/View.h"
#include "gl/DebugShader.h"
#include "lod/DrawnPatch.h"
#include "lod/BoxPyramid.h"
#include "lod/LodAlgorithm.h"

struct TerrainFrame;

/// One view's. Triangles are given vertices of their own and sent from memory in each frame, piece by piece: nothing has to be kept up to
/// date with the mesh, and nothing but heights stays in GL.
class MeshPicture {
public:
    struct Wanted {
        int picture = SoTerrainShape::NONE;
        bool edges = false;
        bool isSelection = true;  ///< what is drawn was selected in this frame
        bool hasDetail = false;   ///< the node makes detail up between samples
        bool isShaded = true;
    };

    /// Draws the mesh of the latest selection. Of `wanted`, without a picture only the edges, over what the node has drawn. GL's state is what it
    /// was. Returns what can't be shown as it should be, and what is shown instead; or an empty string.
    std::string draw(const TerrainFrame & frame, const terrain::LodAlgorithm & mesh, const Wanted & wanted);

    bool isThere() const { return heights.isThere(); }
    std::vector<terrain::GlName> release();
    std::size_t bufferBytes() const { return heights.bytes(); }

private:
    class Batch;
    struct Programs {
        terrain::GlProgram * errors = nullptr;
        terrain::GlProgram * edges = nullptr;
    };
    Programs findPrograms(const TerrainFrame & frame, const Wanted & wanted, std::string & problem) const;

    terrain::HeightTexture heights;
    std::shared_ptr<const terrain::BoxPyramid> heightsOf;  ///< names the data
};

/// Draws the edges of a view volume, given as the view it belongs to, in the local coordinates that are current.
void drawViewVolume(const terrain::View & view);

#endif
