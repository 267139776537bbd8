#include "TerrainViews.h"

#include <algorithm>
#include <set>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoViewportRegionElement.h>
#include <Inventor/misc/SoContextHandler.h>

#include "MeshPicture.h"

namespace {

std::uint64_t hashOf(const SoFullPath * path)
{
    std::uint64_t hash = 0xcbf29ce484222325ull;
    const auto mix = [&hash](std::uint64_t value) { hash = (hash ^ value) * 0x100000001b3ull; };
    for (int i = 0; i < path->getLength(); ++i) {
        mix(std::uint64_t(reinterpret_cast<std::uintptr_t>(path->getNode(i))));
        mix(std::uint64_t(path->getIndex(i)));
    }
    return hash;
}

/// By kind, so that a name fits into a closure: Coin forgets callbacks without calling them when it finishes.
template <terrain::GlName::Kind kind>
void deleteLater(void * closure, uint32_t)
{
    const terrain::GlName name{kind, GLuint(reinterpret_cast<std::uintptr_t>(closure))};
    terrain::deleteNames({&name, 1});
}

SoScheduleDeleteCB * deleterOf(terrain::GlName::Kind kind)
{
    // Programs stay in their pools.
    return kind == terrain::GlName::Buffer ? deleteLater<terrain::GlName::Buffer> : deleteLater<terrain::GlName::Texture>;
}

std::vector<terrain::GlName> namesOf(TerrainView & view)
{
    std::vector<terrain::GlName> names = view.texture.release();
    if (view.drawing)
        for (const terrain::GlName & name : view.drawing->release()) names.push_back(name);
    if (view.debug)
        for (const terrain::GlName & name : view.debug->release()) names.push_back(name);
    for (const GLuint buffer : view.renderer.release()) names.push_back({terrain::GlName::Buffer, buffer});
    return names;
}

}  // namespace

ViewKey::ViewKey(SoGLRenderAction * action)
{
    SoState * state = action->getState();
    const SbViewportRegion & viewport = SoViewportRegionElement::get(state);
    this->context = std::uint32_t(SoGLCacheContextElement::get(state));
    this->path = hashOf(static_cast<const SoFullPath *>(action->getCurPath()));
    this->viewportOrigin = viewport.getViewportOriginPixels();
    this->viewportSize = viewport.getViewportSizePixels();
}

TerrainView::TerrainView(const ViewKey & k, SoNode * root) : key(k)
{
    root_.attach(root);
}

TerrainView::~TerrainView() {}

TerrainViews::TerrainViews()
{
    SoContextHandler::addContextDestructionCallback(contextGoes, this);
}

TerrainViews::~TerrainViews()
{
    // After SoDB::finish() nobody is left to be told.
    if (!SoDB::isInitialized()) return;
    SoContextHandler::removeContextDestructionCallback(contextGoes, this);
    for (const auto & view : views_) giveUp(*view);
}

void TerrainViews::contextGoes(std::uint32_t context, void * closure)
{
    auto & views = static_cast<TerrainViews *>(closure)->views_;
    for (const auto & view : views) {
        if (view->key.context != context) continue;
        // Coin makes the context current before it tells.
        terrain::deleteNames(namesOf(*view));
    }
    std::erase_if(views, [context](const auto & view) { return view->key.context == context; });
}

void TerrainViews::rootDies(void * view, SoSensor *)
{
    // Only given up: Coin is calling its sensors one after the other.
    giveUp(*static_cast<TerrainView *>(view));
}

void TerrainViews::giveUp(TerrainView & view)
{
    for (const terrain::GlName & name : namesOf(view))
        SoGLCacheContextElement::scheduleDeleteCallback(view.key.context, deleterOf(name.kind), reinterpret_cast<void *>(std::uintptr_t(name.name)));
    view.algorithm.reset();
    view.drawing.reset();
    view.debug.reset();
    view.texture = {};
    view.boxes.reset();
    view.isOver_ = true;
}

void TerrainViews::discardDrawing(TerrainView & view)
{
    if (view.drawing) terrain::deleteNames(view.drawing->release());
    view.drawing.reset();
}

void TerrainViews::discardDebug(TerrainView & view)
{
    if (view.debug) terrain::deleteNames(view.debug->release());
    view.debug.reset();
}

TerrainView & TerrainViews::find(SoGLRenderAction * action)
{
    const ViewKey key(action);
    // A node in many places is drawn many times between two frames of one view. So age counts in rounds, and a round ends when a place
    // is drawn again. Where only the viewport differs the window has probably got another size, and the former one soon goes.
    constexpr std::uint64_t kMostRounds = 96, kMostRoundsOfViewport = 12;
    for (const auto & view : views_)
        if (!view->isOver_ && view->key.hasPlaceOf(key) && view->lastRound_ == round_) {
            ++round_;
            break;
        }
    for (const auto & view : views_) {
        const std::uint64_t age = round_ - view->lastRound_;
        if (!view->isOver_ && view->key != key && age > (view->key.hasPlaceOf(key) ? kMostRoundsOfViewport : kMostRounds)) giveUp(*view);
    }
    std::erase_if(views_, [](const auto & view) { return view->isOver_; });
    auto found = std::find_if(views_.begin(), views_.end(), [&key](const auto & view) { return view->key == key; });
    if (found == views_.end()) {
        views_.push_back(std::make_unique<TerrainView>(key, action->getCurPath()->getHead()));
        found = views_.end() - 1;
        (*found)->root_.setDeleteCallback(rootDies, found->get());
    }
    TerrainView & view = **found;
    view.lastRound_ = round_;
    // Another context may have taken the id of one that went without notice. Its objects are not ours.
    if (!view.renderer.isThere() || !view.texture.isThere() || (view.drawing && !view.drawing->isThere()) || (view.debug && !view.debug->isThere())) {
        namesOf(view);
        view.algorithm.reset();
        view.drawing.reset();
        view.debug.reset();
    }
    return view;
}

std::size_t TerrainViews::memoryBytes() const
{
    // Views share images.
    std::set<const terrain::TiledImage *> images;
    std::size_t total = 0;
    for (const auto & view : views_) {
        total += (view->algorithm ? view->algorithm->bytes() : 0) + view->renderer.memoryBytes() + (view->drawing ? view->drawing->memoryBytes() : 0);
        const terrain::TiledImage * image = view->texture.image();
        if (image && images.insert(image).second) total += image->cacheBytes();
    }
    return total;
}

std::size_t TerrainViews::bufferBytes() const
{
    std::size_t total = 0;
    for (const auto & view : views_)
        total += view->renderer.bufferBytes() + (view->drawing ? view->drawing->bufferBytes() : 0) + (view->debug ? view->debug->bufferBytes() : 0) +
                 view->texture.textureBytes();
    return total;
}
