// picture HEIGHTS PICTURE.ppm: draws a height map without a display.
//
// What a program of its own does with SoTerrain: it makes the nodes, sets their fields, draws until the terrain is complete, and asks for
// figures. Everything about GL is the program's own affair; here EGL gives a context that needs no window system.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>

#include <cstdio>
#include <vector>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoMaterial.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoSeparator.h>

#include <SoTerrain/SoHeightMap.h>
#include <SoTerrain/SoROAMTerrain.h>
#include <SoTerrain/SoTerrain.h>

static const int width = 640, height = 480;

// A GL context of the compatibility profile, which is what Coin draws with.
static bool makeContext()
{
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_DEPTH_SIZE, 24, EGL_NONE};
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, wanted, &config, 1, &count) || count < 1)
        return false;
    EGLSurface surface = eglCreatePbufferSurface(display, config, size);
    return eglMakeCurrent(display, surface, surface, eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr));
}

static SoSeparator * makeScene(const char * heights, SoROAMTerrain * terrain)
{
    SoSeparator * root = new SoSeparator;
    SoPerspectiveCamera * camera = new SoPerspectiveCamera;
    SoDirectionalLight * light = new SoDirectionalLight;
    SoMaterial * ground = new SoMaterial;
    SoHeightMap * map = new SoHeightMap;
    light->direction.setValue(0.5f, 0.5f, -1.0f);
    ground->diffuseColor.setValue(0.35f, 0.6f, 0.2f);
    map->filename = heights;
    map->heightScale = 0.0011f;
    terrain->pixelError = 1.0f;
    root->addChild(camera);
    root->addChild(light);
    root->addChild(ground);
    root->addChild(map);
    root->addChild(terrain);
    // z is up: look north and down.
    camera->orientation.setValue(SbVec3f(1.0f, 0.0f, 0.0f), 1.1f);
    camera->viewAll(root, SbViewportRegion(width, height));
    // Nearer: viewAll() leaves room for a sphere around the terrain.
    camera->heightAngle = 0.5f;
    return root;
}

static bool writePicture(const char * name)
{
    std::vector<unsigned char> pixels(width * height * 3);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    std::FILE * file = std::fopen(name, "wb");
    if (!file) return false;
    std::fprintf(file, "P6\n%d %d\n255\n", width, height);
    for (int y = height - 1; y >= 0; --y) std::fwrite(pixels.data() + y * width * 3, 3, width, file);
    return std::fclose(file) == 0;
}

int main(int argc, char ** argv)
{
    if (argc != 3) {
        std::fprintf(stderr, "Usage: picture HEIGHTS PICTURE.ppm\n");
        return 2;
    }
    if (!makeContext()) {
        std::fprintf(stderr, "picture: no GL without a display\n");
        return 77;
    }
    SoDB::init();
    SoInteraction::init();
    SoTerrain::init();

    SoROAMTerrain * terrain = new SoROAMTerrain;
    SoSeparator * root = makeScene(argv[1], terrain);
    root->ref();
    SoGLRenderAction action(SbViewportRegion(width, height));
    action.setCacheContext(1);
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.7f, 0.8f, 0.95f, 1.0f);
    // A mesh may need several frames until it keeps pixelError, because one frame's work is limited.
    do {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        action.apply(root);
    } while (terrain->getStatistics().triangles > 0 && !terrain->getStatistics().converged);

    const SoTerrainStatistics statistics = terrain->getStatistics();
    std::printf("SoTerrain %s: %d triangles, error at most %.2f pixels\n", SoTerrain::getVersion(), int(statistics.triangles), statistics.errorPixels);
    const bool written = writePicture(argv[2]);
    if (!written) std::perror(argv[2]);
    root->unref();
    return written && statistics.triangles > 0 ? 0 : 1;
}
