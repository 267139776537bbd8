// The programs of one context, or of contexts that share their objects.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/Result.h"
#include "gl/GlProgram.h"

namespace terrain {

/// Builds each program once for all who draw with it, and keeps it until the context goes. Not only because compiling takes long:
/// Mesa's software drivers (22.3) crash when a context draws after one that it shares objects with has deleted a program that
/// both have drawn with, whatever is in use by then. Uniforms are a program's own, so whoever draws sets all of them.
class ProgramPool {
public:
    using Build = std::function<Result<GlProgram>()>;

    /// The program of that name, made by `build` the first time; the pointer is good while the context lives. What could not be
    /// built is not tried again. The pool's context must be current.
    Result<GlProgram*> find(const std::string& name, const Build& build);
    /// All programs, which are the caller's to delete; forgets them.
    std::vector<GlName> release();

private:
    std::map<std::string, Result<GlProgram>> programs_;
};

}  // namespace terrain
