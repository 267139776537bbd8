"""What render.cpp does, through pivy: `render.py FILE.iv PICTURE.ppm`. Leaves with 77 where pivy or EGL is missing."""
import ctypes
import os
import sys

# A node library that Coin loads finds Coin's own symbols only if they are global.
sys.setdlopenflags(os.RTLD_NOW | os.RTLD_GLOBAL)
try:
    from pivy import coin
except ImportError as error:
    print(f"skipped: no pivy ({error})")
    sys.exit(77)

WIDTH, HEIGHT = 320, 240
PBUFFER_BIT, OPENGL_BIT, SURFACE_TYPE, RENDERABLE_TYPE, DEPTH_SIZE, NONE = 0x0001, 0x0008, 0x3033, 0x3040, 0x3025, 0x3038
EGL_WIDTH, EGL_HEIGHT, OPENGL_API, SURFACELESS_MESA = 0x3057, 0x3056, 0x30A2, 0x31DD
GL_DEPTH_TEST, GL_RGB, GL_UNSIGNED_BYTE, GL_COLOR_AND_DEPTH = 0x0B71, 0x1907, 0x1401, 0x4100


def make_context():
    egl = ctypes.CDLL("libEGL.so.1")
    pointer = ctypes.c_void_p
    for name in ("eglGetPlatformDisplay", "eglCreatePbufferSurface", "eglCreateContext"):
        getattr(egl, name).restype = pointer
    display = pointer(egl.eglGetPlatformDisplay(SURFACELESS_MESA, None, None))
    wanted = (ctypes.c_int * 7)(SURFACE_TYPE, PBUFFER_BIT, RENDERABLE_TYPE, OPENGL_BIT, DEPTH_SIZE, 24, NONE)
    size = (ctypes.c_int * 5)(EGL_WIDTH, WIDTH, EGL_HEIGHT, HEIGHT, NONE)
    config, count = pointer(), ctypes.c_int()
    works = egl.eglInitialize(display, None, None) and egl.eglBindAPI(OPENGL_API)
    works = works and egl.eglChooseConfig(display, wanted, ctypes.byref(config), 1, ctypes.byref(count)) and count.value > 0
    if not works:
        print("skipped: no EGL without a display")
        sys.exit(77)
    surface = pointer(egl.eglCreatePbufferSurface(display, config, size))
    context = pointer(egl.eglCreateContext(display, config, None, None))
    egl.eglMakeCurrent(display, surface, surface, context)


def main():
    make_context()
    scene = coin.SoInput()
    if not scene.openFile(sys.argv[1]):
        sys.exit(1)
    root = coin.SoDB.readAll(scene)
    root.ref()
    gl = ctypes.CDLL("libGL.so.1")
    gl.glClear(GL_COLOR_AND_DEPTH)
    gl.glEnable(GL_DEPTH_TEST)
    action = coin.SoGLRenderAction(coin.SbViewportRegion(WIDTH, HEIGHT))
    action.setCacheContext(1)
    action.apply(root)
    pixels = (ctypes.c_ubyte * (WIDTH * HEIGHT * 3))()
    gl.glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGB, GL_UNSIGNED_BYTE, pixels)
    data = bytes(pixels)
    reds, greens = data[0::3], data[1::3]
    red = sum(r > 2 * g + 20 for r, g in zip(reds, greens))
    green = sum(g > 2 * r + 20 for r, g in zip(reds, greens))
    print(f"red {red} green {green} GL error {gl.glGetError()}")
    with open(sys.argv[2], "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (WIDTH, HEIGHT))
        for y in reversed(range(HEIGHT)):
            file.write(data[y * WIDTH * 3:(y + 1) * WIDTH * 3])


main()
