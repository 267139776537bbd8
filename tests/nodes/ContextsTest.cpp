// Terrain nodes in several GL contexts that come and go, shared and not, before and after the nodes. GL's own calls are counted.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <epoxy/gl.h>

#include <epoxy/egl.h>

#include "Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/misc/SoContextHandler.h>

#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoTerrainTexture.h>

#include "../gl/GlLedger.h"
#ifdef HAVE_OPENIMAGEIO
#include "../height/TiledFiles.h"
#endif

using namespace test;
using terrain::Image;

namespace {

const void* currentContext() { return eglGetCurrentContext(); }

/// A node, and for clipmaps which of its two implementations.
struct Subject {
    Kind kind;
    bool onCpu = false;
};

std::string identifierOf(const Subject& subject) { return identifierOf(subject.kind) + (subject.onCpu ? "OnTheCpu" : ""); }
void PrintTo(const Subject& subject, std::ostream* stream) { *stream << identifierOf(subject); }

/// Where programs draw: a GL context with a cache context id, which Coin need not be told of when it goes.
class Canvas {
public:
    explicit Canvas(GlLedger& ledger, std::uint32_t id = SoGLCacheContextElement::getUniqueCacheContext(), const Canvas* sharedWith = nullptr,
                    int width = 160, int height = 120)
        : ledger_(ledger), id_(id), action_(SbViewportRegion(short(width), short(height))) {
        auto made = terrain::HeadlessContext::create(width, height, sharedWith ? sharedWith->context_.get() : nullptr);
        EXPECT_TRUE(made);
        if (!made) return;
        context_ = std::move(made).value();
        handle_ = currentContext();
        ledger_.disregard(handle_);
        if (sharedWith) ledger_.share(handle_, sharedWith->handle_);
        action_.setCacheContext(id);
    }
    ~Canvas() {
        context_.reset();
        ledger_.forget(handle_);
    }
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    void makeCurrent() {
        context_->makeCurrent();
        context_->bindFramebuffer();
    }
    void tell() {
        makeCurrent();
        SoContextHandler::destructingContext(id_);
    }
    Image render(SoNode* root) {
        const Ref<SoNode> kept(root);
        makeCurrent();
        glClearColor(kBackground[0] / 255.0f, kBackground[1] / 255.0f, kBackground[2] / 255.0f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glEnable(GL_DEPTH_TEST);
        action_.apply(root);
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
        return context_->readColor();
    }
    /// Has Coin delete here what was to be deleted here, and says what is left of terrains.
    std::string left() { return GlLedger::text(counts()); }
    /// The same, but for programs, which stay until the context goes.
    std::string leftButPrograms() {
        auto left = counts();
        left[GlLedger::Program] = 0;
        return GlLedger::text(left);
    }
    GlLedger::Counts counts() {
        render(new SoSeparator);
        return ledger_.in(handle_);
    }
    SoGLRenderAction& action() { return action_; }
    std::uint32_t id() const { return id_; }

private:
    GlLedger& ledger_;
    std::uint32_t id_;
    SoGLRenderAction action_;
    std::unique_ptr<terrain::HeadlessContext> context_;
    const void* handle_ = nullptr;
};

void expectSame(const Image& first, const Image& second, const std::string& what) { expectAlike(first, second, 0.02, what, 1); }

void leaveNoneCurrent() { eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

class Contexts : public testing::TestWithParam<Subject> {
protected:
    void SetUp() override {
#ifdef HAVE_OPENIMAGEIO
        namespace files = terrain::test;
        files::writeLevels(folder_.file("image.tif"), files::levelsOf(files::texelsOf(256, 256, 3, files::smoothTexel)), 64);
#endif
    }
    void TearDown() override { EXPECT_EQ(ledger_.strays(), std::vector<std::string>()) << "deleted where they were not"; }

    Ref<SoSeparator> scene(bool background = false) const {
        const auto dress = [this](SoSeparator* group) {
#ifdef HAVE_OPENIMAGEIO
            auto* texture = new SoTerrainTexture;
            texture->filename = folder_.file("image.tif").c_str();
            texture->clipSize = 64;
            group->addChild(texture);
#endif
        };
        auto root = sceneOf(GetParam().kind, surface_, {}, dress);
        SoTerrainShape* node = terrainIn(root.get());
        if (GetParam().kind == Kind::ChunkedLod) static_cast<SoChunkedLoDTerrain*>(node)->background = background;
        if (GetParam().kind == Kind::Clipmap) {
            auto* clipmap = static_cast<SoGeometryClipmapTerrain*>(node);
            clipmap->clipmapSize = 31;
            clipmap->implementation = GetParam().onCpu ? SoGeometryClipmapTerrain::CPU : SoGeometryClipmapTerrain::GPU;
        }
        return root;
    }
    /// As a viewer has it: a root of its own over a scene that others show too.
    static Ref<SoSeparator> viewerOf(SoNode* shared) {
        Ref<SoSeparator> root(new SoSeparator);
        root->addChild(shared);
        return root;
    }

    TemporaryFolder folder_;
    Surface surface_ = surfaceOf(fractalMap(65, 65, 20.0));
    GlLedger ledger_{currentContext};
};

}  // namespace

TEST_P(Contexts, MayGoInAnyOrder) {
    const auto root = scene();
    std::vector<int> order = {0, 1, 2};
    do {
        const std::uint32_t sharedId = SoGLCacheContextElement::getUniqueCacheContext();
        std::vector<std::unique_ptr<Canvas>> canvases;
        canvases.push_back(std::make_unique<Canvas>(ledger_));
        canvases.push_back(std::make_unique<Canvas>(ledger_, sharedId));
        canvases.push_back(std::make_unique<Canvas>(ledger_, sharedId, canvases[1].get()));
        std::vector<Ref<SoSeparator>> viewers;
        for (int i = 0; i < 3; ++i) viewers.push_back(viewerOf(root.get()));
        const Image picture = canvases[0]->render(viewers[0].get());
        EXPECT_GT(coveredPixels(picture), 1000);
        for (int i = 1; i < 3; ++i) expectSame(picture, canvases[std::size_t(i)]->render(viewers[std::size_t(i)].get()), "canvas " + std::to_string(i));
        for (const int goes : order) {
            const std::size_t at = std::size_t(goes);
            // What two contexts share goes with the last of them.
            const bool isLast = goes == 0 || !canvases[3 - at];
            if (isLast) canvases[at]->tell();
            if (isLast) {
                EXPECT_EQ(canvases[at]->left(), "none");
            }
            canvases[at].reset();
            viewers[at] = {};
            for (std::size_t i = 0; i < canvases.size(); ++i)
                if (canvases[i]) expectSame(picture, canvases[i]->render(viewers[i].get()), "canvas " + std::to_string(i) + " after " + std::to_string(goes));
        }
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(ledger_.total(), 0u) << GlLedger::text(ledger_.all());
}

TEST_P(Contexts, ThatShareTakeTurnsAtOneRoot) {
    const auto root = scene();
    const std::uint32_t id = SoGLCacheContextElement::getUniqueCacheContext();
    Canvas first(ledger_, id), second(ledger_, id, &first);
    const Image picture = first.render(root.get());
    EXPECT_GT(coveredPixels(picture), 1000);
    const auto once = ledger_.all();
    for (int turn = 0; turn < 4; ++turn) {
        expectSame(picture, second.render(root.get()), "second");
        expectSame(picture, first.render(root.get()), "first");
    }
    EXPECT_LE(ledger_.total(), GlLedger::sum(once) + 4) << GlLedger::text(ledger_.all()) << " after " << GlLedger::text(once);
    second.tell();
    EXPECT_EQ(second.left(), "none");
}

TEST_P(Contexts, KeepNothingOfNodesThatDieWhicheverIsCurrent) {
    Canvas first(ledger_), second(ledger_), shared(ledger_, second.id(), &second);
    for (int current = 0; current < 4; ++current) {
        auto root = scene();
        for (Canvas* canvas : {&first, &second, &shared}) EXPECT_GT(coveredPixels(canvas->render(viewerOf(root.get()).get())), 1000);
        if (current == 3)
            leaveNoneCurrent();
        else
            (current == 0 ? first : current == 1 ? second : shared).makeCurrent();
        root = {};
        EXPECT_EQ(first.leftButPrograms(), "none") << current;
        EXPECT_EQ(shared.leftButPrograms(), "none") << current;
        EXPECT_EQ(second.leftButPrograms(), "none") << current;
    }
    first.tell();
    EXPECT_EQ(first.left(), "none");
    second.tell();
    EXPECT_EQ(shared.left(), "none");
}

TEST_P(Contexts, KeepNothingOfPicturesOfTheMesh) {
    Canvas first(ledger_), second(ledger_), shared(ledger_, second.id(), &second);
    auto root = scene();
    SoTerrainShape* node = terrainIn(root.get());
    // Each as a viewer of its own, which stays.
    std::vector<Ref<SoSeparator>> viewers;
    std::vector<Canvas*> canvases{&first, &second, &shared};
    for (int i = 0; i < 3; ++i) viewers.push_back(viewerOf(root.get()));
    std::vector<Image> plain, again;
    for (int i = 0; i < 3; ++i) plain.push_back(canvases[std::size_t(i)]->render(viewers[std::size_t(i)].get()));
    const std::size_t textures = ledger_.all()[GlLedger::Texture];
    node->debugView = SoTerrainShape::ERRORS;
    node->wireframeOverlay = TRUE;
    for (int frame = 0; frame < 2; ++frame) {
        std::vector<Image> pictures;
        for (int i = 0; i < 3; ++i) pictures.push_back(canvases[std::size_t(i)]->render(viewers[std::size_t(i)].get()));
        EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
        EXPECT_EQ(pictures[0].pixels, pictures[2].pixels);
        EXPECT_EQ(ledger_.all()[GlLedger::Texture], textures + 3) << "the heights, in each";
    }
    node->debugView = SoTerrainShape::NONE;
    node->wireframeOverlay = FALSE;
    for (int i = 0; i < 3; ++i) again.push_back(canvases[std::size_t(i)]->render(viewers[std::size_t(i)].get()));
    EXPECT_EQ(ledger_.all()[GlLedger::Texture], textures);
    for (std::size_t i = 0; i < 3; ++i) expectSame(plain[i], again[i], "as before");
    node->debugView = SoTerrainShape::ERRORS;
    for (int i = 0; i < 3; ++i) canvases[std::size_t(i)]->render(viewers[std::size_t(i)].get());
    root = {};
    viewers.clear();
    for (Canvas* canvas : canvases) EXPECT_EQ(canvas->leftButPrograms(), "none");
    first.tell();
    EXPECT_EQ(first.left(), "none");
    second.tell();
    EXPECT_EQ(shared.left(), "none");
}

// Mesa's software drivers crash where one of several contexts deletes what another one has drawn with.
TEST_P(Contexts, ThatShareKeepProgramsWhenTerrainsGoAndMakeNoneTwice) {
    Canvas first(ledger_), second(ledger_, first.id(), &first);
    Image picture;
    GlLedger::Counts programs{};
    for (int i = 0; i < 12; ++i) {
        auto root = scene();
        const Image now = first.render(viewerOf(root.get()).get());
        if (i == 0) picture = now, programs = ledger_.all();
        expectSame(picture, now, "first " + std::to_string(i));
        expectSame(picture, second.render(viewerOf(root.get()).get()), "second " + std::to_string(i));
        (i % 2 == 0 ? first : second).makeCurrent();
        root = {};
        EXPECT_EQ(first.counts()[GlLedger::Program], programs[GlLedger::Program]) << i;
        EXPECT_EQ(second.counts()[GlLedger::Program], programs[GlLedger::Program]) << i;
    }
    first.tell();
    EXPECT_EQ(first.left(), "none");
}

TEST_P(Contexts, MayGoBeforeAndAfterTheNode) {
    for (const bool nodeFirst : {false, true})
        for (const bool told : {false, true}) {
            auto root = scene();
            auto canvas = std::make_optional<Canvas>(ledger_);
            canvas->render(root.get());
            if (nodeFirst) root = {};
            if (told) {
                canvas->tell();
                EXPECT_EQ(canvas->left(), "none");
            }
            canvas.reset();
            root = {};
        }
    EXPECT_EQ(ledger_.total(), 0u) << GlLedger::text(ledger_.all());
}

TEST_P(Contexts, MayHaveTheIdOfFormerOnes) {
    const auto root = scene();
    const std::uint32_t id = SoGLCacheContextElement::getUniqueCacheContext();
    Image picture;
    std::size_t bytes = 0;
    for (int i = 0; i < 12; ++i) {
        Canvas canvas(ledger_, id);
        const Image now = canvas.render(root.get());
        if (i == 0) picture = now;
        expectSame(picture, now, "round " + std::to_string(i));
        const SoTerrainStatistics statistics = terrainIn(root.get())->getStatistics();
        if (i == 0) bytes = statistics.memoryBytes + statistics.bufferBytes;
        EXPECT_EQ(statistics.memoryBytes + statistics.bufferBytes, bytes) << "round " << i;
        canvas.tell();
        ASSERT_EQ(canvas.left(), "none") << "round " << i;
    }
}

// Coin's own nodes draw wrongly then, but nothing may crash, and the ground is there.
TEST_P(Contexts, ThatGoUntoldMayLeaveTheirIdToOthers) {
    const auto root = scene();
    const std::uint32_t id = SoGLCacheContextElement::getUniqueCacheContext();
    Image picture;
    for (int i = 0; i < 5; ++i) {
        Canvas canvas(ledger_, id);
        const Image now = canvas.render(root.get());
        if (i == 0) picture = now;
        expectSame(picture, now, "round " + std::to_string(i));
        expectSame(picture, canvas.render(root.get()), "round " + std::to_string(i));
        if (i == 4) canvas.tell();
    }
}

TEST_P(Contexts, KeepNothingOfViewersThatWereClosed) {
    const auto shared = scene();
    Canvas canvas(ledger_);
    const auto main = viewerOf(shared.get());
    // Streams of vertices are rings of three.
    for (int i = 0; i < 3; ++i) canvas.render(main.get());
    const auto counts = ledger_.all();
    const SoTerrainStatistics before = terrainIn(shared.get())->getStatistics();
    for (int i = 0; i < 30; ++i) {
        const auto other = viewerOf(shared.get());
        canvas.render(other.get());
    }
    canvas.render(main.get());
    EXPECT_EQ(GlLedger::text(ledger_.all()), GlLedger::text(counts));
    // A context that nobody says goes takes its objects along; what belongs to it in main memory goes with the viewer.
    for (int i = 0; i < 10; ++i) {
        Canvas unknown(ledger_);
        unknown.render(viewerOf(shared.get()).get());
    }
    canvas.render(main.get());
    const SoTerrainStatistics after = terrainIn(shared.get())->getStatistics();
    EXPECT_EQ(GlLedger::text(ledger_.all()), GlLedger::text(counts));
    EXPECT_EQ(after.bufferBytes, before.bufferBytes);
    EXPECT_EQ(after.memoryBytes, before.memoryBytes);
}

TEST_P(Contexts, DoNotFillUpWhileTheWindowChangesItsSize) {
    const auto root = scene();
    Canvas canvas(ledger_);
    for (int i = 0; i < 3; ++i) canvas.render(root.get());
    const std::size_t one = ledger_.total();
    std::size_t most = 0;
    for (int i = 0; i < 60; ++i) {
        canvas.action().setViewportRegion(SbViewportRegion(short(20 + i % 140), short(20 + i % 47)));
        canvas.render(root.get());
        most = std::max(most, ledger_.total());
    }
    EXPECT_LE(most, 20 * one);
    canvas.action().setViewportRegion(SbViewportRegion(160, 120));
    for (int i = 0; i < 20; ++i) canvas.render(root.get());
    EXPECT_EQ(ledger_.total(), one) << GlLedger::text(ledger_.all());
}

TEST_P(Contexts, OfManyPlacesKeepTheirMeshes) {
    const auto shared = scene();
    Ref<SoSeparator> root(new SoSeparator);
    for (int i = 0; i < 36; ++i) {
        auto* place = new SoSeparator;
        place->addChild(shared.get());
        root->addChild(place);
    }
    Canvas canvas(ledger_);
    for (int i = 0; i < 3; ++i) canvas.render(root.get());
    const auto counts = ledger_.all();
    for (int i = 0; i < 3; ++i) canvas.render(root.get());
    EXPECT_EQ(GlLedger::text(ledger_.all()), GlLedger::text(counts));
    EXPECT_EQ(terrainIn(shared.get())->getStatistics().uploadedBytes, 0u) << "a mesh was given up that is drawn in every frame";
}

INSTANTIATE_TEST_SUITE_P(, Contexts,
                         testing::Values(Subject{Kind::BruteForce}, Subject{Kind::Roam}, Subject{Kind::GeoMipmap}, Subject{Kind::ChunkedLod},
                                         Subject{Kind::Clipmap}, Subject{Kind::Clipmap, true}),
                         [](const auto& info) { return identifierOf(info.param); });

namespace {

/// While one lives, programs don't link from that one on which is made after so many others.
class BrokenLinker {
public:
    explicit BrokenLinker(int good) {
        good_ = good;
        made_ = 0;
        real_ = std::exchange(epoxy_glGetProgramiv, &query);
    }
    ~BrokenLinker() { epoxy_glGetProgramiv = real_; }
    BrokenLinker(const BrokenLinker&) = delete;
    BrokenLinker& operator=(const BrokenLinker&) = delete;
    /// How many programs were linked.
    int made() const { return made_; }

private:
    static void query(GLuint program, GLenum what, GLint* value) {
        epoxy_glGetProgramiv = real_;
        epoxy_glGetProgramiv(program, what, value);
        real_ = std::exchange(epoxy_glGetProgramiv, &query);
        if (what == GL_LINK_STATUS && ++made_ > good_) *value = GL_FALSE;
    }
    static inline PFNGLGETPROGRAMIVPROC real_ = nullptr;
    static inline int good_ = 0, made_ = 0;
};

}  // namespace

TEST(ClipmapsOfContexts, WhereGlFailsAreNotTriedAgainButInOthers) {
    for (const int good : {0, 1}) {
        GlLedger ledger(currentContext);
        const auto root = sceneOf(Kind::Clipmap, surfaceOf(fractalMap(65, 65, 20.0)));
        auto* node = static_cast<SoGeometryClipmapTerrain*>(terrainIn(root.get()));
        node->clipmapSize = 31;
        Canvas broken(ledger), whole(ledger);
        const Messages messages;
        Image picture;
        {
            const BrokenLinker linker(good);
            picture = broken.render(root.get());
            const int tried = linker.made();
            EXPECT_EQ(tried, good + 1);
            for (int i = 0; i < 3; ++i) broken.render(root.get());
            const auto before = ledger.born();
            for (int i = 0; i < 5; ++i) broken.render(root.get());
            EXPECT_EQ(ledger.born(), before) << "GL objects are made in every frame";
            node->clipmapSize = 15;
            broken.render(root.get());
            EXPECT_EQ(linker.made(), tried) << "what does not link in a context will not do so later";
        }
        EXPECT_EQ(messages.all().size(), 2u) << "once, and once more after a field was set";
        EXPECT_GT(coveredPixels(picture), 1000);
        node->clipmapSize = 31;
        whole.render(root.get());
        EXPECT_GT(ledger.all()[GlLedger::Program], std::size_t(good)) << "not tried in another context";
        broken.tell(), whole.tell();
        EXPECT_EQ(ledger.total(), 0u) << GlLedger::text(ledger.all());
    }
}

TEST(TilesOfContexts, MayBeOnTheirWayWhenTheContextGoes) {
    GlLedger ledger(currentContext);
    const auto root = sceneOf(Kind::ChunkedLod, surfaceOf(fractalMap(257, 257, 60.0)), {.pixelError = 0.5f}, unlitTexture);
    auto* node = static_cast<SoChunkedLoDTerrain*>(terrainIn(root.get()));
    node->background = TRUE;
    node->tileSize = 8;
    Canvas stays(ledger);
    int unfinished = 0;
    for (int i = 0; i < 30; ++i) {
        Canvas canvas(ledger);
        canvas.render(root.get());
        unfinished += !node->getStatistics().converged;
        if (i % 3 == 0) stays.render(root.get());
        if (i % 2 == 0) canvas.tell();
    }
    EXPECT_GT(unfinished, 20) << "or nothing was on its way";
    for (int frame = 0; frame == 0 || !node->getStatistics().converged; ++frame) {
        ASSERT_LT(frame, 5000) << "never complete";
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        stays.render(root.get());
    }
    stays.tell();
    EXPECT_EQ(stays.left(), "none");
    EXPECT_EQ(ledger.strays(), std::vector<std::string>());
}
