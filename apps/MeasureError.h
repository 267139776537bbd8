// Screen error of a drawn terrain against the full-resolution data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Inventor/SbDPMatrix.h>
#include <Inventor/SbVec2s.h>

#include "NodePtr.h"
#include "TerrainGrid.h"
#include "base/Result.h"

class SoAction;
class SoCallback;
class SoGroup;
class SoNode;

namespace app {

/// Distribution of errors in pixels over samples, at a resolution of 1/1000 pixel; the maximum is exact.
class ErrorSample {
public:
    void add(double errorPixels);
    void merge(const ErrorSample& other);
    double rms() const;
    /// Error that this part of the samples does not exceed.
    double quantile(double part) const;
    double maximum() const { return maximum_; }
    std::uint64_t samples() const { return count_; }

    std::uint64_t missing = 0;   ///< samples in view that nothing was drawn at
    std::vector<double> frames;  ///< maximum of each measured frame

private:
    std::vector<std::uint64_t> bins_;
    std::uint64_t count_ = 0;
    double sumOfSquares_ = 0.0;
    double maximum_ = 0.0;
};

/// Draws what the node has chosen for the camera once more, from straight above, one pixel a sample, into a depth buffer, and
/// compares the heights found there with the data. Both are taken to the screen of the real camera; the distance there is the
/// error. Samples on the border of the map are left out, because the rasteriser owes no pixel there.
///
/// Only GL's matrices and viewport are replaced, behind Coin's back, so the node chooses for the real camera. Shapes whose shaders
/// get their matrices from elsewhere can't be measured so. While a meter is in a scene, Coin keeps no render caches there.
class ErrorMeter {
public:
    /// Puts its hook into the group just before the terrain, which draws the grid in its own coordinates.
    ErrorMeter(TerrainGrid grid, SoGroup* parent, SoNode* terrain);
    ~ErrorMeter();
    ErrorMeter(const ErrorMeter&) = delete;
    ErrorMeter& operator=(const ErrorMeter&) = delete;

    /// `draw` clears colour and depth and applies a GL render action to the scene; the GL context is current. The node's mesh stays
    /// as it is (field `freeze`) and the frame buffer binding is restored.
    terrain::Result<ErrorSample> measure(const std::function<void()>& draw);

private:
    struct Window;
    static void replaceMatrices(void* meter, SoAction* action);
    terrain::Result<bool> compare(const Window& window, const std::vector<float>& depth, ErrorSample& sample) const;

    TerrainGrid grid_;
    NodePtr<SoGroup> parent_;
    NodePtr<SoNode> terrain_;
    NodePtr<SoCallback> hook_;
    const Window* window_ = nullptr;  ///< set while measuring
    SbDPMatrix localToClip_;
    SbVec2s viewport_;
};

}  // namespace app
