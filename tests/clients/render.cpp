// A program that knows Coin and EGL only: `render FILE.iv PICTURE.ppm` draws a scene without a display and counts its colours.
#include <epoxy/gl.h>

#include <epoxy/egl.h>

#include <cstdio>
#include <vector>

#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/nodes/SoSeparator.h>

int main(int argc, char** argv) {
    constexpr int width = 320, height = 240;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_DEPTH_SIZE, 24, EGL_NONE};
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, wanted, &config, 1, &count) || count < 1) return 77;
    const EGLSurface surface = eglCreatePbufferSurface(display, config, size);
    eglMakeCurrent(display, surface, surface, eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr));

    SoDB::init();
    SoInteraction::init();
    SoInput input;
    SoSeparator* root = argc == 3 && input.openFile(argv[1]) ? SoDB::readAll(&input) : nullptr;
    if (!root) return 1;
    root->ref();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    SoGLRenderAction action(SbViewportRegion(width, height));
    action.setCacheContext(1);
    action.apply(root);

    std::vector<unsigned char> pixels(width * height * 3);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    int red = 0, green = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 3) {
        red += pixels[i] > 2 * pixels[i + 1] + 20;
        green += pixels[i + 1] > 2 * pixels[i] + 20;
    }
    std::printf("red %d green %d GL error %u\n", red, green, glGetError());
    if (FILE* file = std::fopen(argv[2], "wb")) {
        std::fprintf(file, "P6\n%d %d\n255\n", width, height);
        for (int y = height - 1; y >= 0; --y) std::fwrite(pixels.data() + y * width * 3, 3, width, file);
        std::fclose(file);
    }
    root->unref();
}
