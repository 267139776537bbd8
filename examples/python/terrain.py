#!/usr/bin/python3
"""Terrain in Python, with Debian's python3-pivy: terrain.py [HEIGHTS [TEXTURE]] [--picture FILE.ppm]

Opens a window where there is a display (drag, wheel and keys are Quarter's), or writes a picture where there is none or
--picture asks for one. pivy has no bindings for SoTerrain's classes and needs none: a node is made by its class name, and all that
can be set are fields.
"""
import argparse
import ctypes
import ctypes.util
import os
import sys

# Coin looks its own symbols up in the whole process, so they must be global before pivy is imported.
sys.setdlopenflags(os.RTLD_NOW | os.RTLD_GLOBAL)
from pivy import coin

DATA = ("data", "/usr/share/soterrain", "/usr/local/share/soterrain")
WIDTH, HEIGHT = 640, 480


def shipped(name):
    """The path of a file that comes with SoTerrain, or its name where there is none."""
    return next((path for path in (os.path.join(folder, name) for folder in DATA) if os.path.exists(path)), name)


def find_nodes():
    """Makes SoTerrain's classes known. Coin finds them itself where LD_LIBRARY_PATH names their folder; the library does it anywhere."""
    if coin.SoType.fromName("SoROAMTerrain").isBad():
        try:
            ctypes.CDLL("libSoTerrain.so.0").soterrain_init()
        except OSError as error:
            sys.exit(f"terrain.py: {error}: install soterrain-modules, or set LD_LIBRARY_PATH to the folder with SoROAMTerrain.so")


def make(class_name, **fields):
    """A node of a class that pivy does not know, with its fields as a scene file would write them."""
    node = coin.SoType.fromName(class_name).createInstance()
    for name, value in fields.items():
        if not node.set(f"{name} {value}"):
            sys.exit(f"terrain.py: {class_name} has no field {name} that could be {value}")
    return node


def quoted(text):
    return '"' + text.replace('"', '\\"') + '"'


def make_scene(heights, texture):
    ground = coin.SoSeparator()
    light = coin.SoDirectionalLight()
    light.direction = (0.5, 0.5, -1.0)
    ground.addChild(light)
    if texture:
        ground.addChild(make("SoTerrainTexture", filename=quoted(texture)))
    else:
        material = coin.SoMaterial()
        material.diffuseColor = (0.35, 0.6, 0.2)
        ground.addChild(material)
    ground.addChild(make("SoHeightMap", filename=quoted(heights), heightScale=0.0011))
    ground.addChild(make("SoROAMTerrain", pixelError=1))
    return ground


def show(ground):
    """A window with a viewer."""
    from PySide2.QtGui import QSurfaceFormat
    from PySide2.QtWidgets import QApplication
    compatible = QSurfaceFormat()
    compatible.setProfile(QSurfaceFormat.CompatibilityProfile)
    compatible.setDepthBufferSize(24)
    QSurfaceFormat.setDefaultFormat(compatible)
    application = QApplication(sys.argv[:1])
    from pivy.quarter import QuarterWidget
    viewer = QuarterWidget()
    viewer.setBackgroundColor(coin.SbColor4f(0.7, 0.8, 0.95, 1.0))
    viewer.setSceneGraph(ground)
    viewer.getSoRenderManager().getCamera().orientation.setValue(coin.SbVec3f(1, 0, 0), 1.1)
    viewer.viewAll()
    viewer.setWindowTitle("SoTerrain")
    viewer.resize(WIDTH, HEIGHT)
    viewer.show()
    return application.exec_()


def make_context():
    """A GL context without a window system: EGL on Mesa."""
    pbuffer, opengl, surface_type, renderable_type, depth_size, none = 0x0001, 0x0008, 0x3033, 0x3040, 0x3025, 0x3038
    surfaceless, opengl_api, width, height = 0x31DD, 0x30A2, 0x3057, 0x3056
    egl = ctypes.CDLL("libEGL.so.1")
    pointer = ctypes.c_void_p
    for name in ("eglGetPlatformDisplay", "eglCreatePbufferSurface", "eglCreateContext"):
        getattr(egl, name).restype = pointer
    display = pointer(egl.eglGetPlatformDisplay(surfaceless, None, None))
    wanted = (ctypes.c_int * 7)(surface_type, pbuffer, renderable_type, opengl, depth_size, 24, none)
    size = (ctypes.c_int * 5)(width, WIDTH, height, HEIGHT, none)
    config, count = pointer(), ctypes.c_int()
    works = egl.eglInitialize(display, None, None) and egl.eglBindAPI(opengl_api)
    works = works and egl.eglChooseConfig(display, wanted, ctypes.byref(config), 1, ctypes.byref(count)) and count.value > 0
    if not works:
        sys.exit("terrain.py: no GL without a display")
    surface = pointer(egl.eglCreatePbufferSurface(display, config, size))
    egl.eglMakeCurrent(display, surface, surface, pointer(egl.eglCreateContext(display, config, None, None)))


def draw(ground, name):
    """The same into a file. Coin's SoOffscreenRenderer needs an X server, so the context is our own."""
    make_context()
    root = coin.SoSeparator()
    root.ref()
    camera = coin.SoPerspectiveCamera()
    root.addChild(camera)
    root.addChild(ground)
    view = coin.SbViewportRegion(WIDTH, HEIGHT)
    camera.orientation.setValue(coin.SbVec3f(1, 0, 0), 1.1)
    camera.viewAll(root, view)
    camera.heightAngle = 0.5  # nearer: viewAll() leaves room for a sphere around the terrain
    gl = ctypes.CDLL("libGL.so.1")
    gl.glEnable(0x0B71)  # GL_DEPTH_TEST
    gl.glClearColor(*(ctypes.c_float(part) for part in (0.7, 0.8, 0.95, 1.0)))
    action = coin.SoGLRenderAction(view)
    action.setCacheContext(1)
    # Textures and meshes of large maps take more than one frame until they are complete.
    for _ in range(10):
        gl.glClear(0x4100)  # GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT
        action.apply(root)
    row = WIDTH * 3
    pixels = (ctypes.c_ubyte * (row * HEIGHT))()
    gl.glReadPixels(0, 0, WIDTH, HEIGHT, 0x1907, 0x1401, pixels)  # GL_RGB, GL_UNSIGNED_BYTE
    data = bytes(pixels)
    with open(name, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (WIDTH, HEIGHT))
        file.writelines(data[y * row:(y + 1) * row] for y in reversed(range(HEIGHT)))
    print(f"terrain.py: wrote {name}")
    root.unref()


def main():
    parser = argparse.ArgumentParser(description="Terrain in Python")
    parser.add_argument("heights", nargs="?", help="height map; without one, the shipped terrain")
    parser.add_argument("texture", nargs="?", help="its texture")
    parser.add_argument("--picture", metavar="FILE.ppm", help="write a picture instead of opening a window")
    arguments = parser.parse_args()
    find_nodes()
    texture = arguments.texture if arguments.heights else shipped("terrain_texture.jpg")
    ground = make_scene(arguments.heights or shipped("terrain.png"), texture)
    ground.ref()
    if not arguments.picture and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return show(ground)
    draw(ground, arguments.picture or "terrain.ppm")
    return 0


if __name__ == "__main__":
    sys.exit(main())
