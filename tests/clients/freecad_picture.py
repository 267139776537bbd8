"""Run by FreeCAD: opens SCENE, saves PICTURE and prints how many of its pixels are red and green."""
import os
import sys
import traceback

import FreeCAD
import FreeCADGui
from PySide2.QtGui import QImage


def main():
    FreeCADGui.open(os.environ["SCENE"])
    view = FreeCADGui.ActiveDocument.ActiveView
    kinds = [thing.TypeId for thing in FreeCAD.ActiveDocument.Objects]
    view.fitAll()
    view.saveImage(os.environ["PICTURE"], 320, 240, "White")
    image = QImage(os.environ["PICTURE"]).convertToFormat(QImage.Format_RGB888)
    red = green = 0
    for y in range(image.height()):
        row = bytes(image.constScanLine(y))
        for x in range(0, 3 * image.width(), 3):
            red += row[x] > 2 * row[x + 1] + 20
            green += row[x + 1] > 2 * row[x] + 20
    print(f"{kinds} red {red} green {green}")


try:
    main()
except Exception:
    traceback.print_exc()
sys.stdout.flush()
# FreeCAD would ask whether to save.
os._exit(0)
