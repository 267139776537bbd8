// Ends a program that shows terrains in one of several orders: `exits SCENE.iv ORDER`, where ORDER are letters: n deletes the nodes, t tells
// Coin that the context goes, c destroys the context, f finishes Coin. What no letter names stays until the program exits.
#include <epoxy/gl.h>

#include <epoxy/egl.h>

#include <cstdio>

#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/misc/SoContextHandler.h>
#include <Inventor/nodes/SoSeparator.h>

namespace {

/// Goes after main(), as one that a program keeps in a static variable.
struct Kept {
    SoSeparator* root = nullptr;
    ~Kept() {
        if (root) root->unref();
    }
    void clear() {
        root->unref();
        root = nullptr;
    }
} kept;

}  // namespace

int main(int argc, char** argv) {
    constexpr int width = 160, height = 120;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_DEPTH_SIZE, 24, EGL_NONE};
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) return 77;
    const EGLSurface surface = eglCreatePbufferSurface(display, config, size);
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
    eglMakeCurrent(display, surface, surface, context);

    SoDB::init();
    SoInteraction::init();
    {
        SoInput input;
        kept.root = argc == 3 && input.openFile(argv[1]) ? SoDB::readAll(&input) : nullptr;
    }
    if (!kept.root) return 1;
    kept.root->ref();
    for (int frame = 0; frame < 2; ++frame) {
        SoGLRenderAction action(SbViewportRegion(width, height));
        action.setCacheContext(1);
        action.apply(kept.root);
    }
    for (const char* letter = argv[2]; *letter; ++letter) switch (*letter) {
        case 'n':
            kept.clear();
            break;
        case 't':
            SoContextHandler::destructingContext(1);
            break;
        case 'c':
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
            eglDestroyContext(display, context);
            break;
        case 'f':
            SoDB::finish();
            // Coin's nodes can't be let go any more, whichever they are.
            kept.root = nullptr;
            break;
        default:
            return 2;
        }
    return 0;
}
