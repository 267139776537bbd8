#include "MeasureError.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoCacheElement.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoModelMatrixElement.h>
#include <Inventor/elements/SoProjectionMatrixElement.h>
#include <Inventor/elements/SoGLViewingMatrixElement.h>
#include <Inventor/elements/SoViewportRegionElement.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/nodes/SoCallback.h>
#include <Inventor/nodes/SoGroup.h>

namespace app {

using terrain::Error;
using terrain::HeightTile;
using terrain::Result;

namespace {

constexpr double binsPerPixel = 1000.0;
constexpr std::size_t binLimit = 1000000;

SbDPMatrix toDouble(const SbMatrix& m) {
    SbDPMatrix d;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) d[row][column] = m[row][column];
    }
    return d;
}

// Homogeneous clip coordinates of a point.
std::array<double, 4> project(const SbDPMatrix& m, double x, double y, double z) {
    std::array<double, 4> clip;
    for (int i = 0; i < 4; ++i) clip[std::size_t(i)] = x * m[0][i] + y * m[1][i] + z * m[2][i] + m[3][i];
    return clip;
}

// A depth and colour buffer of its own; the former binding comes back at the end.
class DepthTarget {
public:
    explicit DepthTarget(int side) : side_(side) {
        glGetIntegerv(GL_FRAMEBUFFER_BINDING, &former_);
        glGenFramebuffers(1, &framebuffer_);
        glGenRenderbuffers(2, buffers_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        attach(0, GL_RGBA8, GL_COLOR_ATTACHMENT0);
        attach(1, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
        glBindRenderbuffer(GL_RENDERBUFFER, 0);
    }
    ~DepthTarget() {
        glBindFramebuffer(GL_FRAMEBUFFER, GLuint(former_));
        glDeleteRenderbuffers(2, buffers_);
        glDeleteFramebuffers(1, &framebuffer_);
    }
    DepthTarget(const DepthTarget&) = delete;
    DepthTarget& operator=(const DepthTarget&) = delete;

    bool isComplete() const { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }
    std::vector<float> read() const {
        std::vector<float> depth(std::size_t(side_) * std::size_t(side_));
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glReadPixels(0, 0, side_, side_, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
        return depth;
    }

private:
    void attach(int buffer, GLenum format, GLenum point) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffers_[buffer]);
        glRenderbufferStorage(GL_RENDERBUFFER, format, side_, side_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, point, GL_RENDERBUFFER, buffers_[buffer]);
    }

    int side_;
    GLint former_ = 0;
    GLuint framebuffer_ = 0;
    GLuint buffers_[2] = {0, 0};
};

// Keeps the mesh of a terrain node as it is, without telling anybody that a field changed.
class FreezeScope {
public:
    explicit FreezeScope(SoNode* node) : node_(node), field_(dynamic_cast<SoSFBool*>(node->getField("freeze"))) {
        if (field_) former_ = field_->getValue();
        set(TRUE);
    }
    ~FreezeScope() { set(former_); }
    FreezeScope(const FreezeScope&) = delete;
    FreezeScope& operator=(const FreezeScope&) = delete;

private:
    void set(SbBool value) {
        if (!field_) return;
        const SbBool notify = node_->enableNotify(FALSE);
        field_->setValue(value);
        node_->enableNotify(notify);
    }

    SoNode* node_;
    SoSFBool* field_;
    SbBool former_ = FALSE;
};

// A valid sample with a hole beside it may belong to no triangle.
bool bordersHole(const HeightTile& tile, int column, int row) {
    for (int r = std::max(0, row - 1); r <= std::min(tile.rows - 1, row + 1); ++r) {
        for (int c = std::max(0, column - 1); c <= std::min(tile.columns - 1, column + 1); ++c) {
            if (std::isnan(tile.heights[std::size_t(r) * std::size_t(tile.columns) + std::size_t(c)])) return true;
        }
    }
    return false;
}

}  // namespace

/// The square of samples that one drawing covers.
struct ErrorMeter::Window {
    terrain::TileKey key;
    double lowest, highest;  ///< heights at depth 1 and 0
    int firstColumn() const { return key.column * key.cells; }
    int firstRow() const { return key.row * key.cells; }
};

void ErrorSample::add(double errorPixels) {
    const std::size_t bin = std::min(binLimit, std::size_t(std::max(0.0, errorPixels) * binsPerPixel));
    if (bin >= bins_.size()) bins_.resize(bin + 1, 0);
    ++bins_[bin];
    ++count_;
    sumOfSquares_ += errorPixels * errorPixels;
    maximum_ = std::max(maximum_, errorPixels);
}

void ErrorSample::merge(const ErrorSample& other) {
    bins_.resize(std::max(bins_.size(), other.bins_.size()), 0);
    for (std::size_t i = 0; i < other.bins_.size(); ++i) bins_[i] += other.bins_[i];
    count_ += other.count_;
    sumOfSquares_ += other.sumOfSquares_;
    maximum_ = std::max(maximum_, other.maximum_);
    missing += other.missing;
    frames.insert(frames.end(), other.frames.begin(), other.frames.end());
}

double ErrorSample::rms() const {
    return count_ ? std::sqrt(sumOfSquares_ / double(count_)) : 0.0;
}

double ErrorSample::quantile(double part) const {
    const double target = part * double(count_);
    double passed = 0.0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        passed += double(bins_[i]);
        if (passed > target) return i == binLimit ? maximum_ : std::min(maximum_, double(i + 1) / binsPerPixel);
    }
    return maximum_;
}

ErrorMeter::ErrorMeter(TerrainGrid grid, SoGroup* parent, SoNode* terrain)
    : grid_(std::move(grid)), parent_(parent), terrain_(terrain), hook_(new SoCallback) {
    hook_->setCallback(replaceMatrices, this);
    parent->insertChild(hook_.get(), parent->findChild(terrain));
}

ErrorMeter::~ErrorMeter() {
    hook_->setCallback(nullptr);
    const int index = parent_->findChild(hook_.get());
    if (index >= 0) parent_->removeChild(index);
}

void ErrorMeter::replaceMatrices(void* self, SoAction* action) {
    auto& meter = *static_cast<ErrorMeter*>(self);
    if (!action->isOfType(SoGLRenderAction::getClassTypeId())) return;
    SoState* state = action->getState();
    // From a render cache the terrain would be drawn without coming here first.
    SoGLCacheContextElement::shouldAutoCache(state, SoGLCacheContextElement::DONT_AUTO_CACHE);
    SoCacheElement::invalidate(state);
    if (!meter.window_) return;
    SbDPMatrix m = toDouble(SoModelMatrixElement::get(state));
    m.multRight(toDouble(SoGLViewingMatrixElement::getResetMatrix(state)));
    meter.localToClip_ = m.multRight(toDouble(SoProjectionMatrixElement::get(state)));
    meter.viewport_ = SoViewportRegionElement::get(state).getViewportSizePixels();

    const Window& window = *meter.window_;
    const int side = window.key.cells;
    const auto& [dx, dy] = std::array{meter.grid_.spacing.x, meter.grid_.spacing.y};
    const double left = (window.firstColumn() - 0.5) * dx, bottom = (window.firstRow() - 0.5) * dy;
    glViewport(0, 0, side, side);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glOrtho(left, left + side * dx, bottom, bottom + side * dy, -window.highest, -window.lowest);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
}

Result<bool> ErrorMeter::compare(const Window& window, const std::vector<float>& depth, ErrorSample& sample) const {
    const auto loaded = grid_.source->load(window.key);
    if (!loaded) return loaded.error();
    const HeightTile& tile = loaded.value();
    const int side = window.key.cells;
    for (int row = 0; row < std::min(side, tile.rows); ++row) {
        for (int column = 0; column < std::min(side, tile.columns); ++column) {
            const int c = window.firstColumn() + column, r = window.firstRow() + row;
            if (c < 1 || r < 1 || c >= grid_.columns - 1 || r >= grid_.rows - 1) continue;
            const float height = tile.heights[std::size_t(row) * std::size_t(tile.columns) + std::size_t(column)];
            if (std::isnan(height)) continue;
            const SbVec3f p = grid_.point(c, r, height);
            const auto [ax, ay, az, aw] = project(localToClip_, p[0], p[1], p[2]);
            if (aw <= 0.0 || std::abs(ax) > aw || std::abs(ay) > aw || std::abs(az) > aw) continue;
            const double d = depth[std::size_t(row) * std::size_t(side) + std::size_t(column)];
            if (d >= 1.0) {
                sample.missing += bordersHole(tile, column, row) ? 0 : 1;
                continue;
            }
            const double drawn = window.highest - d * (window.highest - window.lowest);
            const auto [bx, by, bz, bw] = project(localToClip_, p[0], p[1], drawn);
            if (bw <= 0.0) continue;
            sample.add(std::hypot((ax / aw - bx / bw) * 0.5 * viewport_[0], (ay / aw - by / bw) * 0.5 * viewport_[1]));
        }
    }
    return true;
}

Result<ErrorSample> ErrorMeter::measure(const std::function<void()>& draw) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    const int side = std::min({std::max(grid_.columns, grid_.rows), int(largest), 2048});
    const double margin = 0.01 * std::max(grid_.maximum - grid_.minimum, 1e-3 * grid_.spacing.x);
    const DepthTarget target(side);
    if (!target.isComplete()) return Error{"--measure-error", "a frame buffer of " + std::to_string(side) + " squared", "none"};
    const FreezeScope frozen(terrain_.get());
    ErrorSample sample;
    for (int row = 0; row * side < grid_.rows - 1; ++row) {
        for (int column = 0; column * side < grid_.columns - 1; ++column) {
            const Window window{{0, column, row, side}, grid_.minimum - margin, grid_.maximum + margin};
            window_ = &window;
            draw();
            window_ = nullptr;
            const auto compared = compare(window, target.read(), sample);
            if (!compared) return compared.error();
        }
    }
    sample.frames.push_back(sample.maximum());
    return sample;
}

}  // namespace app
