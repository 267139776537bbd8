#include "OverlayPool.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/misc/SoState.h>

#include "gl/GlProgram.h"

namespace {

struct Pool {
    std::mutex mutex;
    std::map<std::uint32_t, std::shared_ptr<terrain::OverlayResources>> all;
};

/// Never deleted: nodes may outlive everything else of the library.
Pool & pool()
{
    static Pool * const only = new Pool;
    return *only;
}

void contextGoes(std::uint32_t context, void *)
{
    const std::lock_guard lock(pool().mutex);
    const auto found = pool().all.find(context);
    if (found == pool().all.end()) return;
    // Coin makes the context current before it tells.
    const terrain::GlName font{terrain::GlName::Texture, found->second->release()};
    terrain::deleteNames({&font, 1});
    pool().all.erase(found);
}

}  // namespace

std::shared_ptr<terrain::OverlayResources> overlayResourcesOf(SoState * state)
{
    const std::lock_guard lock(pool().mutex);
    auto & resources = pool().all[std::uint32_t(SoGLCacheContextElement::get(state))];
    if (!resources) {
        resources = std::make_shared<terrain::OverlayResources>();
        // Another time changes nothing, unless Coin was finished and begun anew.
        SoContextHandler::addContextDestructionCallback(contextGoes, nullptr);
    }
    return resources;
}
