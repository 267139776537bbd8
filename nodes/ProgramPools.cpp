#include "ProgramPools.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/misc/SoState.h>

namespace {

struct Pools {
    std::mutex mutex;
    std::map<std::pair<std::uint32_t, std::thread::id>, std::shared_ptr<terrain::ProgramPool>> all;
};

/// Never deleted: nodes may outlive everything else of the library.
Pools & pools()
{
    static Pools * const only = new Pools;
    return *only;
}

void contextGoes(std::uint32_t context, void *)
{
    std::vector<std::shared_ptr<terrain::ProgramPool>> gone;
    {
        const std::lock_guard lock(pools().mutex);
        for (auto place = pools().all.begin(); place != pools().all.end();)
            if (place->first.first == context) {
                gone.push_back(std::move(place->second));
                place = pools().all.erase(place);
            } else {
                ++place;
            }
    }
    // Coin makes the context current before it tells.
    for (const auto & pool : gone) terrain::deleteNames(pool->release());
}

}  // namespace

std::shared_ptr<terrain::ProgramPool> programPoolOf(SoState * state)
{
    const std::uint32_t context = std::uint32_t(SoGLCacheContextElement::get(state));
    const std::lock_guard lock(pools().mutex);
    std::shared_ptr<terrain::ProgramPool> & pool = pools().all[{context, std::this_thread::get_id()}];
    if (!pool) {
        pool = std::make_shared<terrain::ProgramPool>();
        // Another time changes nothing, unless Coin was finished and begun anew.
        SoContextHandler::addContextDestructionCallback(contextGoes, nullptr);
    }
    return pool;
}
