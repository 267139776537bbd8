#include "gl/HeadlessContext.h"

#include <epoxy/gl.h>

#include <epoxy/egl.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace terrain {

struct HeadlessContext::Impl {
    // The display is never terminated: EGL gives the same one to everybody in the process who asks for this platform.
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    GLuint framebuffer = 0;
    GLuint color = 0;
    GLuint depth = 0;
    int width = 0;
    int height = 0;

    std::string openDisplay();
    std::string createContext(EGLContext sharedWith);
    std::string createFramebuffer();
};

namespace {

bool hasClientExtension(const char* name) {
    const char* all = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    return all && std::strstr(all, name);
}

std::string eglProblem(const char* call) {
    char text[64];
    std::snprintf(text, sizeof text, "%s failed (EGL error 0x%x)", call, unsigned(eglGetError()));
    return text;
}

// Reads from the context's frame buffer and gives the caller its read binding and pack state back.
class ReadScope {
public:
    explicit ReadScope(GLuint framebuffer) {
        glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &framebuffer_);
        glGetIntegerv(GL_PACK_ALIGNMENT, &alignment_);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
    }
    ~ReadScope() {
        glPixelStorei(GL_PACK_ALIGNMENT, alignment_);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, GLuint(framebuffer_));
    }
    ReadScope(const ReadScope&) = delete;
    ReadScope& operator=(const ReadScope&) = delete;

private:
    GLint framebuffer_ = 0;
    GLint alignment_ = 4;
};

}  // namespace

// Each step returns an empty string, or what went wrong.
std::string HeadlessContext::Impl::openDisplay() {
    if (!epoxy_has_egl()) return "no EGL library";
    if (!hasClientExtension("EGL_EXT_platform_base")) return "EGL without EGL_EXT_platform_base";
    EGLint major = 0, minor = 0;
    if (hasClientExtension("EGL_MESA_platform_surfaceless")) {
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display != EGL_NO_DISPLAY && eglInitialize(display, &major, &minor)) return {};
    }
    // Drivers that have no surfaceless platform offer their devices instead.
    if (hasClientExtension("EGL_EXT_platform_device") && hasClientExtension("EGL_EXT_device_enumeration")) {
        EGLDeviceEXT device = nullptr;
        EGLint count = 0;
        if (eglQueryDevicesEXT(1, &device, &count) && count > 0) {
            display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
            if (display != EGL_NO_DISPLAY && eglInitialize(display, &major, &minor)) return {};
        }
    }
    return "no EGL platform that works without a display";
}

std::string HeadlessContext::Impl::createContext(EGLContext sharedWith) {
    if (!eglBindAPI(EGL_OPENGL_API)) return "EGL without desktop OpenGL";
    const EGLint attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, attributes, &config, 1, &count) || count < 1) return "no EGL configuration for desktop OpenGL";
    // Without a requested version the driver gives its newest compatibility profile, which Coin needs.
    context = eglCreateContext(display, config, sharedWith, nullptr);
    if (context == EGL_NO_CONTEXT) return eglProblem("eglCreateContext");
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return eglProblem("eglMakeCurrent");
    return epoxy_gl_version() >= 30 ? std::string() : "OpenGL " + std::to_string(epoxy_gl_version() / 10.0);
}

std::string HeadlessContext::Impl::createFramebuffer() {
    GLint side = 0, viewport[2] = {0, 0};
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &side);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    if (width > std::min(side, viewport[0]) || height > std::min(side, viewport[1])) {
        return "a limit of " + std::to_string(std::min(side, viewport[0])) + "x" + std::to_string(std::min(side, viewport[1]));
    }
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &color);
    glGenRenderbuffers(1, &depth);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glBindRenderbuffer(GL_RENDERBUFFER, color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return "an incomplete frame buffer";
    glViewport(0, 0, width, height);
    return {};
}

HeadlessContext::HeadlessContext() : impl_(std::make_unique<Impl>()) {}

HeadlessContext::~HeadlessContext() {
    if (impl_->context == EGL_NO_CONTEXT) return;
    const bool current = eglGetCurrentContext() == impl_->context;
    // Only the frame buffer objects need the context; they go with it when another one is current.
    if (current) {
        glDeleteFramebuffers(1, &impl_->framebuffer);
        glDeleteRenderbuffers(1, &impl_->color);
        glDeleteRenderbuffers(1, &impl_->depth);
        eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(impl_->display, impl_->context);
}

Result<std::unique_ptr<HeadlessContext>> HeadlessContext::create(int width, int height, const HeadlessContext* sharedWith) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width < 1 || height < 1) return Error{"offscreen frame buffer", "a size of at least 1x1", size};
    std::unique_ptr<HeadlessContext> context(new HeadlessContext);
    Impl& impl = *context->impl_;
    impl.width = width;
    impl.height = height;
    std::string problem = impl.openDisplay();
    if (problem.empty()) problem = impl.createContext(sharedWith ? sharedWith->impl_->context : EGL_NO_CONTEXT);
    if (!problem.empty()) return Error{"offscreen rendering", "EGL with desktop OpenGL 3.0 or newer and no display", problem};
    problem = impl.createFramebuffer();
    if (!problem.empty()) return Error{"offscreen frame buffer", "a size that this OpenGL can draw, not " + size, problem};
    return context;
}

void HeadlessContext::makeCurrent() {
    eglBindAPI(EGL_OPENGL_API);
    eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context);
}

void HeadlessContext::bindFramebuffer() {
    glBindFramebuffer(GL_FRAMEBUFFER, impl_->framebuffer);
    glViewport(0, 0, impl_->width, impl_->height);
}

Image HeadlessContext::readColor() const {
    Image image{impl_->width, impl_->height, 3, {}};
    const std::size_t stride = std::size_t(image.width) * 3;
    image.pixels.resize(stride * std::size_t(image.height));
    const ReadScope scope(impl_->framebuffer);
    glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
    // GL counts rows from the bottom.
    for (int y = 0; y < image.height / 2; ++y) {
        auto* top = image.pixels.data() + stride * std::size_t(y);
        std::swap_ranges(top, top + stride, image.pixels.data() + stride * std::size_t(image.height - 1 - y));
    }
    return image;
}

std::vector<float> HeadlessContext::readDepth() const {
    std::vector<float> depth(std::size_t(impl_->width) * std::size_t(impl_->height));
    const ReadScope scope(impl_->framebuffer);
    glReadPixels(0, 0, impl_->width, impl_->height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    return depth;
}

std::string HeadlessContext::renderer() const {
    const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return name ? name : "";
}

int HeadlessContext::width() const {
    return impl_->width;
}

int HeadlessContext::height() const {
    return impl_->height;
}

}  // namespace terrain
