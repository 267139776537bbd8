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

void GlBuffer::update(GLenum target, std::size_t offset, const void* data, std::size_t bytes) {
    glBindBuffer(target, name_);
    glBufferSubData(target, GLintptr(offset), GLsizeiptr(bytes), data);
}

GLuint GlBuffer::release() {
    bytes_ = 0;
    return std::exchange(name_, 0u);
}

}  // namespace terrain
