#include <epoxy/gl.h>

#include <epoxy/egl.h>

#include "World.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoOutput.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/nodes/SoCoordinate3.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoGroup.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/sensors/SoSensorManager.h>

#include <SoTerrain/SoBruteForceTerrain.h>
#include <SoTerrain/SoChunkedLoDTerrain.h>
#include <SoTerrain/SoGeoMipmapTerrain.h>
#include <SoTerrain/SoGeometryClipmapTerrain.h>
#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>
#include <SoTerrain/SoTerrainTexture.h>

namespace soak {

namespace {

constexpr int kSides[] = {33, 65, 129, 257, 513};
constexpr float kHeight = 60.0f;

/// A height from 0 to 1, the same wherever it is asked for.
float heightAt(float x, float y) {
    return 0.5f + 0.25f * std::sin(9.0f * x + 2.0f * std::sin(5.0f * y)) + 0.15f * std::sin(31.0f * y + 7.0f * x) +
           0.1f * std::sin(97.0f * x) * std::cos(83.0f * y);
}

enum Deed { Fly, SwitchAlgorithm, SwitchData, SwitchTexture, SetField, Edit, Pick, Write, Open, Close, Resize, kDeeds };
const char* const kDeedNames[kDeeds] = {"only flown",      "algorithms", "height maps",    "textures",       "fields", "edits",
                                        "picks and boxes", ".iv files",  "windows opened", "windows closed", "resizes"};

/// Values for fields of whatever node has them; some of them are refused with a warning.
struct FieldValues {
    const char* name;
    const char* values[5];
};
const FieldValues kFields[] = {
    {"pixelError", {"0.5", "1", "2", "6", "-1"}},
    {"frustumCulling", {"TRUE", "FALSE", "TRUE", "FALSE", "TRUE"}},
    {"freeze", {"FALSE", "FALSE", "FALSE", "TRUE", "FALSE"}},
    {"frozenFrustum", {"TRUE", "FALSE", "TRUE", "TRUE", "FALSE"}},
    {"debugView", {"NONE", "TILES", "LEVELS", "ERRORS", "LOADING"}},
    {"wireframeOverlay", {"FALSE", "TRUE", "FALSE", "FALSE", "FALSE"}},
    {"triangleCount", {"0", "0", "500", "5000", "20000"}},
    {"geomorph", {"TRUE", "FALSE", "TRUE", "FALSE", "TRUE"}},
    {"operationCount", {"10000", "100", "1000", "0", "50"}},
    {"tileSize", {"8", "16", "32", "64", "7"}},
    {"morphing", {"TRUE", "FALSE", "TRUE", "FALSE", "TRUE"}},
    {"memoryBudget", {"256", "1", "0", "8", "64"}},
    {"uploadBudget", {"1024", "16", "0", "64", "256"}},
    {"background", {"TRUE", "FALSE", "TRUE", "FALSE", "TRUE"}},
    {"clipmapSize", {"0", "15", "31", "63", "127"}},
    {"levels", {"0", "2", "3", "5", "-1"}},
    {"transitionWidth", {"0", "1", "4", "9", "0"}},
    {"updateBudget", {"0", "200", "1000", "4000", "0"}},
    {"activeLevels", {"0", "1", "2", "3", "0"}},
    {"detailLevels", {"0", "1", "2", "0", "9"}},
    {"blendNormals", {"TRUE", "FALSE", "TRUE", "FALSE", "TRUE"}},
    {"implementation", {"AUTO", "GPU", "CPU", "AUTO", "GPU"}},
    {"storage", {"STORED", "MEMORY_FREE", "STORED", "MEMORY_FREE", "STORED"}},
    {"showLevels", {"FALSE", "TRUE", "FALSE", "TRUE", "FALSE"}},
};

/// Overwrites a part of a height map, where this SoHeightMap can.
template <class HeightMap>
bool setHeights(HeightMap* map, int column, int row, int columns, int rows, const float* heights) {
    if constexpr (requires { map->setHeights(column, row, columns, rows, heights); }) {
        map->setHeights(column, row, columns, rows, heights);
        return true;
    }
    return false;
}

template <class Node>
Node* findIn(SoNode* root) {
    SoSearchAction search;
    search.setType(Node::getClassTypeId());
    search.setSearchingAll(TRUE);
    search.apply(root);
    return search.getPath() ? static_cast<Node*>(search.getPath()->getTail()) : nullptr;
}

}  // namespace

struct World::Window {
    std::unique_ptr<terrain::HeadlessContext> context;
    const void* handle = nullptr;
    std::unique_ptr<SoGLRenderAction> action;
    app::NodePtr<SoSeparator> root{new SoSeparator};
    SoPerspectiveCamera* camera = new SoPerspectiveCamera;
    SbVec3f eye{0.5f, 0.1f, 1.3f};
    float heading = 0.7f;
};

World::World(std::uint32_t seed, const std::string& folder, test::GlLedger& ledger, bool shares)
    : random_(seed), folder_(folder), ledger_(ledger), shares_(shares), deeds_(kDeeds, 0) {}

World::~World() {
    end();
}

bool World::makeFiles(const std::string& folder) {
    for (const int side : kSides) {
        std::FILE* file = std::fopen((folder + "/" + std::to_string(side) + ".raw").c_str(), "wb");
        if (!file) return false;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                std::fputc(int(255.0f * heightAt(float(x) / float(side - 1), float(y) / float(side - 1))), file);
        std::fclose(file);
    }
    // Any image of any size is one that SoTerrainTexture reads.
    constexpr int kTexels = 512;
    std::FILE* file = std::fopen((folder + "/colours.ppm").c_str(), "wb");
    if (!file) return false;
    std::fprintf(file, "P6\n%d %d\n255\n", kTexels, kTexels);
    for (int i = 0; i < kTexels * kTexels; ++i)
        for (const int colour : {i % kTexels / 2, i / kTexels / 2, (i * 7) % 255}) std::fputc(colour, file);
    std::fclose(file);
    return true;
}

void World::complain(const std::string& what) {
    if (problems_++ < 20) std::printf("frame %zu: %s\n", frames_, what.c_str());
}

SoNode* World::newData() {
    side_ = oneOf(kSides);
    const float spacing = 256.0f / float(side_ - 1);
    const bool isCurved = random(6) == 0;
    if (side_ <= 129 && random(4) == 0) {
        auto* coordinates = new SoCoordinate3;
        coordinates->point.setNum(side_ * side_);
        SbVec3f* points = coordinates->point.startEditing();
        for (int y = 0; y < side_; ++y)
            for (int x = 0; x < side_; ++x) {
                const float u = float(x) / float(side_ - 1), v = float(y) / float(side_ - 1);
                points[y * side_ + x].setValue(spacing * float(x) + (isCurved ? 9.0f * std::sin(5.0f * v) : 0.0f),
                                               spacing * float(y), kHeight * heightAt(u, v));
            }
        coordinates->point.finishEditing();
        return coordinates;
    }
    auto* map = new SoHeightMap;
    map->filename = (folder_ + "/" + std::to_string(side_) + ".raw").c_str();
    map->spacing.setValue(spacing, spacing);
    map->heightScale = kHeight / 255.0f;
    return map;
}

SoNode* World::newTexture() {
    switch (random(4)) {
    case 0:
        return new SoGroup;
    case 1: {
        unsigned char texels[16 * 16 * 3];
        for (int i = 0; i < 16 * 16 * 3; ++i) texels[i] = (unsigned char)(random(256));
        auto* texture = new SoTexture2;
        texture->image.setValue(SbVec2s(16, 16), 3, texels);
        return texture;
    }
    default: {
        auto* texture = new SoTerrainTexture;
        texture->filename = (folder_ + "/colours.ppm").c_str();
        texture->clipSize = 64 << random(3);
        return texture;
    }
    }
}

SoTerrainShape* World::newTerrain() {
    switch (random(6)) {
    case 0:
        return new SoBruteForceTerrain;
    case 1:
        return new SoROAMTerrain;
    case 2:
        return new SoGeoMipmapTerrain;
    case 3:
        return new SoChunkedLoDTerrain;
    default: {
        auto* clipmap = new SoGeometryClipmapTerrain;
        clipmap->clipmapSize = 31;
        return clipmap;
    }
    }
}

SoTerrainShape* World::terrain() const {
    return static_cast<SoTerrainShape*>(scene_->getChild(3));
}

void World::makeScene() {
    scene_ = app::NodePtr<SoSeparator>(new SoSeparator);
    auto* light = new SoDirectionalLight;
    light->direction.setValue(0.5f, 0.4f, -1.0f);
    scene_->addChild(light);
    scene_->addChild(newTexture());
    scene_->addChild(newData());
    scene_->addChild(newTerrain());
}

void World::openWindow() {
    if (windows_.size() >= 4) return;
    Window* partner = !windows_.empty() && random(2) == 0 ? windows_[std::size_t(random(int(windows_.size())))].get() : nullptr;
    if (!shares_) partner = nullptr;
    auto made = terrain::HeadlessContext::create(320, 240, partner ? partner->context.get() : nullptr);
    if (!made) return complain(made.error().message());
    auto window = std::make_unique<Window>();
    window->context = std::move(made).value();
    window->handle = eglGetCurrentContext();
    ledger_.disregard(window->handle);
    if (partner) ledger_.share(window->handle, partner->handle);
    if (!partner) ++contexts_;
    window->action = std::make_unique<SoGLRenderAction>(SbViewportRegion(320, 240));
    std::uint32_t id = partner ? partner->action->getCacheContext() : 0;
    if (!partner && !freeIds_.empty()) {
        id = freeIds_.back();
        freeIds_.pop_back();
    }
    window->action->setCacheContext(id ? id : SoGLCacheContextElement::getUniqueCacheContext());
    window->root->addChild(window->camera);
    window->root->addChild(scene_.get());
    windows_.push_back(std::move(window));
}

void World::closeWindow() {
    if (windows_.empty()) return;
    const auto place = windows_.begin() + random(int(windows_.size()));
    const auto window = std::move(*place);
    windows_.erase(place);
    const std::uint32_t id = window->action->getCacheContext();
    const bool isShared =
        std::any_of(windows_.begin(), windows_.end(), [id](const auto& w) { return w->action->getCacheContext() == id; });
    // As SoQt does, one in ten goes without a word.
    if (!isShared && random(10) > 0) {
        window->context->makeCurrent();
        SoContextHandler::destructingContext(id);
        freeIds_.push_back(id);
        const auto left = ledger_.in(window->handle);
        if (test::GlLedger::sum(left) > 0) complain("a context goes with " + test::GlLedger::text(left));
    }
    window->context.reset();
    ledger_.forget(window->handle);
}

void World::resize() {
    if (windows_.empty()) return;
    Window& window = *windows_[std::size_t(random(int(windows_.size())))];
    window.action->setViewportRegion(SbViewportRegion(short(40 + random(281)), short(30 + random(211))));
}

void World::setField() {
    SoTerrainShape* node = terrain();
    for (int attempt = 0; attempt < 30; ++attempt) {
        const FieldValues& chosen = oneOf(kFields);
        if (SoField* field = node->getField(chosen.name)) {
            field->set(oneOf(chosen.values));
            return;
        }
    }
}

void World::edit() {
    const int columns = 1 + random(std::min(side_ - 1, 40)), rows = 1 + random(std::min(side_ - 1, 40));
    const int column = random(side_ - columns + 1), row = random(side_ - rows + 1);
    SoNode* data = scene_->getChild(2);
    if (data->isOfType(SoHeightMap::getClassTypeId())) {
        const std::vector<float> heights(std::size_t(columns) * std::size_t(rows), random(0.0f, 255.0f));
        setHeights(static_cast<SoHeightMap*>(data), column, row, columns, rows, heights.data());
        return;
    }
    auto& points = static_cast<SoCoordinate3*>(data)->point;
    SbVec3f* point = points.startEditing() + row * side_ + column;
    for (int i = 0; i < columns; ++i) point[i][2] = random(0.0f, kHeight);
    points.finishEditing();
}

void World::pick() {
    if (windows_.empty()) return;
    Window& window = *windows_.front();
    SoRayPickAction action(window.action->getViewportRegion());
    action.setNormalizedPoint(SbVec2f(random(0.0f, 1.0f), random(0.0f, 1.0f)));
    action.apply(window.root.get());
    SoGetBoundingBoxAction box(window.action->getViewportRegion());
    box.apply(scene_.get());
    if (box.getBoundingBox().isEmpty()) complain("the scene has no bounding box");
}

void World::writeAndRead() {
    SoOutput output;
    void* written = std::malloc(1 << 16);
    output.setBuffer(written, 1 << 16, [](void* memory, std::size_t size) { return std::realloc(memory, size); });
    if (random(2) == 0) output.setBinary(TRUE);
    SoWriteAction(&output).apply(scene_.get());
    std::size_t size = 0;
    output.getBuffer(written, size);
    SoInput input;
    input.setBuffer(written, size);
    SoSeparator* read = SoDB::readAll(&input);
    std::free(written);
    if (!read) return complain("the scene can't be read back");
    const app::NodePtr<SoSeparator> kept(read);
    auto* scene =
        findIn<SoTerrainShape>(read) ? static_cast<SoSeparator*>(read->getNumChildren() == 1 ? read->getChild(0) : read) : nullptr;
    if (!scene || scene->getNumChildren() != 4) return complain("the scene is not what was written");
    for (const auto& window : windows_) window->root->replaceChild(1, scene);
    scene_ = app::NodePtr<SoSeparator>(scene);
}

void World::look(Window& window) {
    window.heading += random(-0.15f, 0.15f);
    window.eye += SbVec3f(0.01f * std::cos(window.heading), 0.01f * std::sin(window.heading), random(-0.03f, 0.03f));
    // Now and then it jumps, also to places outside.
    if (random(60) == 0) window.eye.setValue(random(-0.3f, 1.3f), random(-0.3f, 1.3f), random(0.6f, 3.0f));
    window.eye[2] = std::clamp(window.eye[2], 0.6f, 3.0f);
    if (std::fabs(window.eye[0] - 0.5f) > 1.0f || std::fabs(window.eye[1] - 0.5f) > 1.0f) window.eye.setValue(0.5f, 0.5f, 1.2f);
    window.camera->position.setValue(256.0f * window.eye[0], 256.0f * window.eye[1], kHeight * window.eye[2]);
    window.camera->orientation =
        SbRotation(SbVec3f(1.0f, 0.0f, 0.0f), 1.1f) * SbRotation(SbVec3f(0.0f, 0.0f, 1.0f), window.heading - 1.57f);
    window.camera->nearDistance = 1.0f;
    window.camera->farDistance = 900.0f;
}

double World::frame() {
    if (!scene_) makeScene();
    if (windows_.empty()) openWindow();
    ++frames_;
    const int chance = random(40);
    const Deed deed = chance >= kDeeds ? Fly : Deed(chance);
    ++deeds_[deed];
    switch (deed) {
    case SwitchAlgorithm:
        scene_->replaceChild(3, newTerrain());
        break;
    case SwitchData:
        scene_->replaceChild(2, newData());
        break;
    case SwitchTexture:
        scene_->replaceChild(1, newTexture());
        break;
    case SetField:
        setField();
        break;
    case Edit:
        edit();
        break;
    case Pick:
        pick();
        break;
    case Write:
        if (side_ <= 129) writeAndRead();
        break;
    case Open:
        openWindow();
        break;
    case Close:
        closeWindow();
        break;
    case Resize:
        resize();
        break;
    default:
        break;
    }
    const auto start = std::chrono::steady_clock::now();
    for (const auto& window : windows_) {
        look(*window);
        window->context->makeCurrent();
        window->context->bindFramebuffer();
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glEnable(GL_DEPTH_TEST);
        window->action->apply(window->root.get());
        glFinish();
        if (const GLenum error = glGetError())
            complain("GL error " + std::to_string(error) + " in " + terrain()->getTypeId().getName().getString());
    }
    SoDB::getSensorManager()->processTimerQueue();
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void World::end() {
    // Whichever goes first.
    if (random(2) == 0) scene_ = {};
    while (!windows_.empty()) closeWindow();
    scene_ = {};
    SoDB::getSensorManager()->processDelayQueue(TRUE);
    for (const std::string& stray : ledger_.strays())
        if (stray != lastProblem_) complain("deleted where it was not: " + (lastProblem_ = stray));
}

std::size_t World::glBytes() const {
    return scene_ ? terrain()->getStatistics().bufferBytes : 0;
}

std::string World::report() const {
    std::string text = std::to_string(frames_) + " frames";
    for (int deed = 0; deed < kDeeds; ++deed) text += ", " + std::to_string(deeds_[std::size_t(deed)]) + ' ' + kDeedNames[deed];
    return text;
}

}  // namespace soak
