// What the tests of the nodes share: a context to draw in, pictures and their comparison, and Coin's messages.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/nodes/SoNode.h>

#include "gl/HeadlessContext.h"

namespace test {

/// Counts one reference of a node.
template <class T>
class Ref {
public:
    Ref() = default;
    Ref(T* node) : node_(node) {
        if (node_) node_->ref();
    }
    Ref(const Ref& other) : Ref(other.node_) {}
    Ref(Ref&& other) noexcept : node_(other.node_) { other.node_ = nullptr; }
    Ref& operator=(Ref other) noexcept {
        std::swap(node_, other.node_);
        return *this;
    }
    ~Ref() {
        if (node_) node_->unref();
    }
    T* get() const { return node_; }
    T* operator->() const { return node_; }
    T& operator*() const { return *node_; }

private:
    T* node_ = nullptr;
};

/// What nothing in a test scene is coloured.
constexpr std::uint8_t kBackground[3] = {255, 0, 255};

/// A GL context of its own with a frame buffer and a Coin render action. Every picture drawn is a check that GL has no error to report.
class Stage {
public:
    explicit Stage(int width = 320, int height = 240);
    /// Tells Coin that the context goes, then lets it go.
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    /// Clears to the background and draws.
    terrain::Image render(SoNode* root);
    /// Only draws, into `region` when it is given.
    void draw(SoNode* root, const SbViewportRegion* region = nullptr);
    void clear();
    terrain::Image picture() const { return context_->readColor(); }
    std::vector<float> depth() const { return context_->readDepth(); }
    void makeCurrent();
    std::uint32_t cacheContext() const { return cacheContext_; }
    SoGLRenderAction& action() { return *action_; }
    SbViewportRegion region() const { return SbViewportRegion(short(context_->width()), short(context_->height())); }

private:
    std::unique_ptr<terrain::HeadlessContext> context_;
    std::unique_ptr<SoGLRenderAction> action_;
    std::uint32_t cacheContext_ = 0;
};

/// What two pictures differ in.
struct Difference {
    double mean = 0.0;   ///< absolute difference of a channel, over the pixels that both cover, 0 to 255
    int largest = 0;
    int onlyFirst = 0;   ///< pixels that only the first covers, though it covers all within the rim around them
    int onlySecond = 0;
    int covered = 0;     ///< pixels that both cover
};
Difference compare(const terrain::Image& first, const terrain::Image& second, int rim = 2);

/// Checks that the pictures cover the same pixels but for a rim, that there are enough of them, and that they differ by at most `mean`.
void expectAlike(const terrain::Image& first, const terrain::Image& second, double mean, const std::string& what = {}, int rim = 2);

int coveredPixels(const terrain::Image& image);
/// Average colour of the covered pixels.
std::vector<double> meanColor(const terrain::Image& image);

/// Writes pictures side by side to tests/pictures/NAME.png in the build folder.
void savePicture(const std::string& name, const std::vector<terrain::Image>& images);

/// Folder for a test's files, made anew, removed at the end.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    std::string file(const std::string& name) const { return path_ + '/' + name; }
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// Collects Coin's messages while it lives. Otherwise any message fails the test.
class Messages {
public:
    Messages();
    ~Messages();
    const std::vector<std::string>& all() const { return all_; }
    std::string text() const;
    void clear() { all_.clear(); }

private:
    friend struct MessageHandler;
    std::vector<std::string> all_;
    Messages* outer_;
};

}  // namespace test
