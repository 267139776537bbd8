// GL buffers as values that know their size.
#pragma once

#include <cstddef>
#include <vector>

#include <epoxy/gl.h>

namespace terrain {

/// One GL buffer object of the context that is current when it is filled. Nothing is deleted in the destructor, because by then another
/// context may be current, or none: the owner takes the name by release() and deletes it where it belongs.
class GlBuffer {
public:
    /// Replaces the contents. Asks for new storage each time, so that the GPU may go on reading the old one.
    void fill(GLenum target, const void* data, std::size_t bytes, GLenum usage);
    /// Overwrites a part.
    void update(GLenum target, std::size_t offset, const void* data, std::size_t bytes);
    void bind(GLenum target) const { glBindBuffer(target, name_); }
    bool exists() const { return name_ != 0; }
    std::size_t bytes() const { return bytes_; }
    /// The name, or 0; forgets it.
    GLuint release();

private:
    GLuint name_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace terrain
