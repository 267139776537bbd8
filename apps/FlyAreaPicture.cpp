// The picture of the render area as an image.
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#ifdef HAVE_SOQT

#include <epoxy/gl.h>

#include <algorithm>
#include <string>

#include <Inventor/actions/SoGLRenderAction.h>

#include "FlyArea.h"

namespace app {

using terrain::Error;
using terrain::Image;

namespace {

// A frame buffer of its own: a window's may be hidden in part. The former one is bound again at the end.
class Target {
public:
    explicit Target(glm::ivec2 size) {
        glGetIntegerv(GL_FRAMEBUFFER_BINDING, &former_);
        glGenFramebuffers(1, &frame_);
        glGenRenderbuffers(2, buffers_);
        glBindFramebuffer(GL_FRAMEBUFFER, frame_);
        attach(buffers_[0], GL_RGBA8, GL_COLOR_ATTACHMENT0, size);
        attach(buffers_[1], GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, size);
    }
    ~Target() {
        glBindFramebuffer(GL_FRAMEBUFFER, GLuint(former_));
        glDeleteFramebuffers(1, &frame_);
        glDeleteRenderbuffers(2, buffers_);
    }
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;

    bool isComplete() const { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }

private:
    static void attach(GLuint buffer, GLenum format, GLenum place, glm::ivec2 size) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffer);
        glRenderbufferStorage(GL_RENDERBUFFER, format, size.x, size.y);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
    }

    GLint former_ = 0;
    GLuint frame_ = 0;
    GLuint buffers_[2] = {0, 0};
};

// Rows from top to bottom.
Image readPixels(glm::ivec2 size) {
    Image image{size.x, size.y, 3, {}};
    const std::size_t stride = std::size_t(size.x) * 3;
    image.pixels.resize(stride * std::size_t(size.y));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    for (int y = 0; y < size.y / 2; ++y) {
        auto* top = image.pixels.data() + stride * std::size_t(y);
        std::swap_ranges(top, top + stride, image.pixels.data() + stride * std::size_t(size.y - 1 - y));
    }
    return image;
}

}  // namespace

terrain::Result<Image> FlyArea::picture() {
    const glm::ivec2 size = sizePixels();
    if (renderer_.empty() || size.x < 1 || size.y < 1) return Error{"picture", "a window that has been drawn", "none yet"};
    glLockNormal();
    terrain::Result<Image> result = Error{"picture", "a frame buffer of the window's size", "one that OpenGL can't make"};
    {
        const Target target(size);
        if (target.isComplete()) {
            glEnable(GL_DEPTH_TEST);
            glClearColor(skyColor[0], skyColor[1], skyColor[2], 1.0f);
            glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            scene_.holdMeshes(true);
            getGLRenderAction()->apply(scene_.root());
            scene_.holdMeshes(false);
            result = readPixels(size);
        }
    }
    glUnlockNormal();
    return result;
}

}  // namespace app

#endif
