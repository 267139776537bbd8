#include "gl/GlObjects.h"

#include <utility>

namespace terrain {

void GlBuffer::fill(GLenum target, const void* data, std::size_t bytes, GLenum usage) {
    if (name_ == 0) glGenBuffers(1, &name_);
    glBindBuffer(target, name_);
    glBufferData(target, GLsizeiptr(bytes), data, usage);
    bytes_ = bytes;
}

void GlBuffer::refill(GLenum target, const void* data, std::size_t bytes) {
    if (name_ == 0 || bytes > bytes_) fill(target, nullptr, bytes + bytes / 4, GL_STREAM_DRAW);
    update(target, 0, data, bytes);
}

bool GlBuffer::grow(GLenum usage, std::size_t bytes) {
    if (bytes <= bytes_) return true;
    // Of all targets those that no caller relies on.
    GlBuffer larger;
    larger.fill(GL_ARRAY_BUFFER, nullptr, bytes + bytes / 4, usage);
    const bool copies = epoxy_gl_version() >= 31 || epoxy_has_gl_extension("GL_ARB_copy_buffer");
    if (copies && bytes_ > 0) {
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, name_);
        glCopyBufferSubData(GL_ELEMENT_ARRAY_BUFFER, GL_ARRAY_BUFFER, 0, 0, GLsizeiptr(bytes_));
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    }
    const bool isKept = copies || bytes_ == 0;
    if (name_ != 0) glDeleteBuffers(1, &name_);
    *this = larger;
    return isKept;
}

void GlBuffer::update(GLenum target, std::size_t offset, const void* data, std::size_t bytes) {
    glBindBuffer(target, name_);
    glBufferSubData(target, GLintptr(offset), GLsizeiptr(bytes), data);
}

GLuint GlBuffer::release() {
    bytes_ = 0;
    return std::exchange(name_, 0u);
}

}  // namespace terrain
