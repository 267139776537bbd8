#include "TerrainViews.h"

#include <algorithm>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/elements/SoViewportRegionElement.h>
#include <Inventor/misc/SoContextHandler.h>

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

void deleteLater(void * closure, uint32_t)
{
    const std::unique_ptr<terrain::GlName> name(static_cast<terrain::GlName *>(closure));
    terrain::deleteNames({name.get(), 1});
}

std::vector<terrain::GlName> namesOf(TerrainView & view)
{
    std::vector<terrain::GlName> names = view.drawing ? view.drawing->release() : std::vector<terrain::GlName>();
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

TerrainViews::TerrainViews()
{
    SoContextHandler::addContextDestructionCallback(contextGoes, this);
}

TerrainViews::~TerrainViews()
{
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

void TerrainViews::giveUp(TerrainView & view)
{
    for (const terrain::GlName & name : namesOf(view))
        SoGLCacheContextElement::scheduleDeleteCallback(view.key.context, deleteLater, new terrain::GlName(name));
}

void TerrainViews::discardDrawing(TerrainView & view)
{
    if (view.drawing) terrain::deleteNames(view.drawing->release());
    view.drawing.reset();
}

TerrainView & TerrainViews::find(const ViewKey & key, std::uint64_t frame)
{
    // A node in many places is drawn many times between two frames of one view, so age counts in rounds over all views.
    const std::uint64_t oldest = 32 * (views_.size() + 1);
    std::erase_if(views_, [&](const auto & view) {
        const bool isOld = view->key != key && frame - view->lastFrame > oldest;
        if (isOld) giveUp(*view);
        return isOld;
    });
    for (const auto & view : views_)
        if (view->key == key) {
            view->lastFrame = frame;
            return *view;
        }
    views_.push_back(std::make_unique<TerrainView>(key));
    views_.back()->lastFrame = frame;
    return *views_.back();
}

std::size_t TerrainViews::memoryBytes() const
{
    std::size_t total = 0;
    for (const auto & view : views_) total += (view->algorithm ? view->algorithm->bytes() : 0) + view->renderer.memoryBytes() +
                                          (view->drawing ? view->drawing->memoryBytes() : 0);
    return total;
}

std::size_t TerrainViews::bufferBytes() const
{
    std::size_t total = 0;
    for (const auto & view : views_) total += view->renderer.bufferBytes() + (view->drawing ? view->drawing->bufferBytes() : 0);
    return total;
}
