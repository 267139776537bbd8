// GL programs, and names of GL objects of any kind.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "base/Result.h"

namespace terrain {

/// An object of the context that was current when it was made.
struct GlName {
    enum Kind { Buffer, Texture, Program };
    Kind kind;
    GLuint name;
};
/// Deletes objects of the current context.
void deleteNames(std::span<const GlName> names);

/// A linked program. As with GlBuffer, nothing is deleted in the destructor: the owner takes the name by release().
class GlProgram {
public:
    GlProgram() = default;

    /// Without a vertex shader vertices are treated by fixed functions. `attributes`: names and places of the vertex shader's inputs. Error: what the compiler or the linker says.
    static Result<GlProgram> build(const std::string& what, const std::string& vertexShader, const std::string& fragmentShader,
                                   const std::vector<std::pair<const char*, GLuint>>& attributes);

    bool exists() const { return name_ != 0; }
    GLuint name() const { return name_; }
    void use() const { glUseProgram(name_); }
    /// Place of a uniform; -1, which GL ignores, where the program does not use it. `uniform`: a string literal.
    GLint operator[](const char* uniform);
    GLuint release() { return std::exchange(name_, 0u); }

private:
    GLuint name_ = 0;
    std::vector<std::pair<const char*, GLint>> places_;  ///< few, and literals lie where they lie
};

}  // namespace terrain
