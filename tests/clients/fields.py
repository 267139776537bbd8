"""Every field of every node of ours, reached from Python by its name alone. Leaves with 77 where pivy is missing."""
import os
import sys

sys.setdlopenflags(os.RTLD_NOW | os.RTLD_GLOBAL)
try:
    from pivy import coin
except ImportError as error:
    print(f"skipped: no pivy ({error})")
    sys.exit(77)

NAMES = ["SoHeightMap", "SoBruteForceTerrain", "SoROAMTerrain", "SoGeoMipmapTerrain", "SoChunkedLoDTerrain", "SoGeometryClipmapTerrain"]
VALUES = {"SFInt32": "63", "SFUInt32": "63", "SFFloat": "3.25", "SFVec2f": "2.5 7.25", "SFVec2i32": "17 19", "SFString": '""', "SFNode": "Cube { }"}


def read(text):
    scene = coin.SoInput()
    scene.setBuffer("#Inventor V2.1 ascii\n" + text)
    root = coin.SoDB.readAll(scene)
    root.ref()
    return root


def main():
    failed = 0
    for name in NAMES:
        root = read(f"Separator {{ {name} {{ }} }}")
        node = root.getChild(0)
        fields = coin.SoFieldList()
        count = node.getFields(fields)
        if node.getTypeId().getName().getString() != name or count < 7:
            print(f"{name}: found {node.getTypeId().getName().getString()} with {count} fields")
            failed += 1
        for i in range(count):
            field = fields[i]
            kind = field.getTypeId().getName().getString()
            if kind not in VALUES:
                continue
            if not field.set(VALUES[kind]):
                print(f"{name}: a field of type {kind} did not take {VALUES[kind]}")
                failed += 1
        if name != "SoHeightMap":
            node.getField("pixelError").set("0.75")
            text = str(node.getField("pixelError").get())
            if "0.75" not in text:
                print(f"{name}.pixelError: expected 0.75, found {text}")
                failed += 1
    sys.exit(1 if failed else 0)


main()
