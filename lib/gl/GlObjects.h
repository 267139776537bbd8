// GL buffers as values that know their size.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <epoxy/gl.h>

namespace terrain {

/// One GL buffer object of the context that is current when it is filled. Nothing is deleted in the destructor, because by then
/// another context may be current, or none: the owner takes the name by release() and deletes it where it belongs.
class GlBuffer {
public:
    /// Replaces the contents. Asks for new storage each time, so that the GPU may go on reading the old one.
    void fill(GLenum target, const void* data, std::size_t bytes, GLenum usage);
    /// Replaces the contents, in the storage that is there if it is large enough: asking for new storage in every frame costs more
    /// than filling it.
    void refill(GLenum target, const void* data, std::size_t bytes);
    /// Makes room for so many bytes and keeps what is there: GL copies it, nothing is sent. False where GL can't and all is lost.
    bool grow(GLenum usage, std::size_t bytes);
    /// Overwrites a part. GL keeps the order: what is drawn before still reads the old.
    void update(GLenum target, std::size_t offset, const void* data, std::size_t bytes);
    void bind(GLenum target) const { glBindBuffer(target, name_); }
    bool exists() const { return name_ != 0; }
    /// Whether the current context has it.
    bool isThere() const { return name_ == 0 || glIsBuffer(name_); }
    std::size_t bytes() const { return bytes_; }
    /// The name, or 0; forgets it.
    GLuint release();

private:
    GLuint name_ = 0;
    std::size_t bytes_ = 0;
};

/// A buffer that is filled anew in most frames: a ring of three, so that none is overwritten while the GPU may still read it.
class GlStream {
public:
    void fill(GLenum target, const void* data, std::size_t bytes) {
        current_ = (current_ + 1) % ring_.size();
        ring_[current_].refill(target, data, bytes);
    }
    GlBuffer& current() { return ring_[current_]; }
    const GlBuffer& current() const { return ring_[current_]; }
    std::array<GlBuffer, 3>& all() { return ring_; }
    std::size_t bytes() const { return ring_[0].bytes() + ring_[1].bytes() + ring_[2].bytes(); }

private:
    std::array<GlBuffer, 3> ring_;
    std::size_t current_ = 0;
};

/// A vertex array object of its own while it lives. Contexts that share their objects do not share these, so none is kept for
/// later, when another context may be current.
class VertexArrayScope {
public:
    VertexArrayScope() {
        glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &before_);
        glGenVertexArrays(1, &name_);
        glBindVertexArray(name_);
    }
    ~VertexArrayScope() {
        glBindVertexArray(GLuint(before_));
        glDeleteVertexArrays(1, &name_);
    }
    VertexArrayScope(const VertexArrayScope&) = delete;
    VertexArrayScope& operator=(const VertexArrayScope&) = delete;

private:
    GLuint name_ = 0;
    GLint before_ = 0;
};

/// A frame buffer object of its own while it lives, for drawing and reading. Not kept, for the same reason.
class FramebufferScope {
public:
    FramebufferScope() {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawing_);
        glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &reading_);
        glGenFramebuffers(1, &name_);
        glBindFramebuffer(GL_FRAMEBUFFER, name_);
    }
    ~FramebufferScope() {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(drawing_));
        glBindFramebuffer(GL_READ_FRAMEBUFFER, GLuint(reading_));
        glDeleteFramebuffers(1, &name_);
    }
    FramebufferScope(const FramebufferScope&) = delete;
    FramebufferScope& operator=(const FramebufferScope&) = delete;

private:
    GLuint name_ = 0;
    GLint drawing_ = 0, reading_ = 0;
};

}  // namespace terrain
