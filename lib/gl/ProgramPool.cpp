#include "gl/ProgramPool.h"

#include <algorithm>

namespace terrain {

Result<GlProgram*> ProgramPool::find(const std::string& name, const Build& build) {
    // Another context may have taken the place of one that went without notice. Nothing of that is there any more, whatever has got
    // the same numbers since.
    const auto isGone = [](const auto& entry) { return entry.second && !glIsProgram(entry.second.value().name()); };
    if (std::any_of(programs_.begin(), programs_.end(), isGone)) programs_.clear();
    auto found = programs_.find(name);
    if (found == programs_.end()) found = programs_.emplace(name, build()).first;
    if (!found->second) return found->second.error();
    return &found->second.value();
}

std::vector<GlName> ProgramPool::release() {
    std::vector<GlName> names;
    for (auto& [name, program] : programs_)
        if (program) names.push_back({GlName::Program, program.value().release()});
    programs_.clear();
    return names;
}

}  // namespace terrain
