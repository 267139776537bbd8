// What a soak does: scenes, windows and random deeds on them.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoTerrainShape.h>

#include "../gl/GlLedger.h"
#include "NodePtr.h"
#include "gl/HeadlessContext.h"

namespace soak {

/// Some windows on one terrain scene. Everything that happens follows from the seed.
class World {
public:
    /// `folder` has the files that makeFiles() writes. `shares`: some windows share their GL objects.
    World(std::uint32_t seed, const std::string& folder, test::GlLedger& ledger, bool shares);
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    static bool makeFiles(const std::string& folder);

    /// One random deed or none, then every window is drawn. Returns milliseconds.
    double frame();
    /// Deletes scene and windows and begins anew, so that what is left is the same each time.
    void end();
    std::size_t glBytes() const;
    /// How many contexts there were so far, those that share counted as one.
    std::size_t contexts() const { return contexts_; }
    /// How often each deed was done, and what went wrong, one a line.
    std::string report() const;
    int problems() const { return problems_; }

private:
    struct Window;

    int random(int below) { return int(random_() % std::uint32_t(below)); }
    float random(float low, float high) { return low + (high - low) * float(random_()) / 4294967296.0f; }
    template <class T, std::size_t n>
    const T& oneOf(const T (&all)[n]) {
        return all[random(int(n))];
    }
    void complain(const std::string& what);

    void makeScene();
    SoNode* newData();
    SoNode* newTexture();
    SoTerrainShape* newTerrain();
    SoTerrainShape* terrain() const;
    void setField();
    void edit();
    void pick();
    void writeAndRead();
    void openWindow();
    void closeWindow();
    void resize();
    void look(Window& window);

    std::mt19937 random_;
    std::string folder_;
    test::GlLedger& ledger_;
    bool shares_;
    int side_ = 0;
    app::NodePtr<SoSeparator> scene_;  ///< data, texture, terrain
    std::vector<std::unique_ptr<Window>> windows_;
    std::vector<std::uint32_t> freeIds_;  ///< of contexts that went, for others
    std::size_t contexts_ = 0;
    std::vector<std::size_t> deeds_;
    std::size_t frames_ = 0;
    int problems_ = 0;
    std::string lastProblem_;
};

}  // namespace soak
