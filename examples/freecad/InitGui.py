# Makes SoTerrain's nodes known to FreeCAD, so that any .iv file with them opens. Copy this file to
#   ~/.local/share/FreeCAD/Mod/SoTerrain/InitGui.py
# (the Debian package soterrain-modules brings it along) and start FreeCAD again.
import ctypes

import FreeCAD

try:
    ctypes.CDLL("libSoTerrain.so.0").soterrain_init()
except OSError as error:
    FreeCAD.Console.PrintWarning(f"SoTerrain: {error}\n")
