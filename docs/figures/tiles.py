"""geomipmap.svg: blocks of different levels that meet in the lines of the coarser one. chunks.svg: the tree of tiles around a viewer, and the wall
between two of them. morphing.svg: how far a tile of Chunked LoD stands from its parent, and the error that shows."""
import sys

from svg import AMBER, BLUE, Drawing, GREEN, GREY, INK, LIGHT, PALE, RED, at

TILE = 8


def lines(level):
    return [0, TILE] if level == 3 else list(range(0, TILE + 1, 1 << level))


def side_triangles(level, border):
    """A trapezoid along the bottom of a block: its outer line has the lines of `border`, its inner one those of `level`."""
    step = 1 << level
    outer, inner = [(x, 0) for x in lines(border)], [(x, step) for x in lines(level)[1:-1]]
    i = j = 0
    while i + 1 < len(outer) or j + 1 < len(inner):
        # Whichever of the two next points is nearer to the left makes the next triangle.
        if j + 1 == len(inner) or (i + 1 < len(outer) and outer[i + 1][0] <= inner[j + 1][0]):
            yield outer[i], outer[i + 1], inner[j]
            i += 1
        else:
            yield outer[i], inner[j + 1], inner[j]
            j += 1


def turned(p, side):
    for _ in range(side):
        p = (TILE - p[1], p[0])
    return p


def block(level, borders):
    """(kind, triangle) of a block whose borders have these levels: bottom, right, top, left."""
    if level == 3:
        return [("inner", ((0, 0), (8, 0), (8, 8))), ("inner", ((0, 0), (8, 8), (0, 8)))]
    found, step = [], 1 << level
    for x in lines(level)[1:-2]:
        for y in lines(level)[1:-2]:
            a, b, c, e = (x, y), (x + step, y), (x + step, y + step), (x, y + step)
            even = (x + y) // step % 2 == 0
            found += [("inner", t) for t in ([(a, b, c), (a, c, e)] if even else [(a, b, e), (b, c, e)])]
    for side in range(4):
        found += [("side", tuple(turned(p, side) for p in t)) for t in side_triangles(level, max(level, borders[side]))]
    return found


def geomipmap(folder):
    levels = [[0, 1, 2, 3], [0, 0, 1, 2]]
    d = Drawing(760, 400)
    scale = 21
    tint = [PALE[BLUE], PALE[GREEN], PALE[AMBER], PALE[RED]]
    level_of = lambda row, column: levels[row][column] if 0 <= row < 2 and 0 <= column < 4 else -1
    for row in range(2):
        for column in range(4):
            level = levels[row][column]
            borders = [level_of(row - 1, column), level_of(row, column + 1), level_of(row + 1, column), level_of(row, column - 1)]
            frame = at(44 + column * TILE * scale, 350 - row * TILE * scale, scale)
            for kind, t in block(level, borders):
                d.polygon([frame(p) for p in t], tint[level] if kind == "inner" else "white", GREY, 0.8)
    for row in range(3):
        d.line((44, 350 - row * TILE * scale), (44 + 32 * scale, 350 - row * TILE * scale), INK, 1.6)
    for column in range(5):
        d.line((44 + column * TILE * scale, 350), (44 + column * TILE * scale, 350 - 16 * scale), INK, 1.6)
    for column in range(4):
        d.text((44 + (column + 0.5) * TILE * scale, 370), "level %d above level %d" % (levels[1][column], levels[0][column]))
    d.text((380, 390), "tinted: inner cells of a level; white: the four trapezoids, whose outer sides have the lines of the coarser neighbour")
    d.write(folder + "/geomipmap.svg")


def tiles_for(viewer, x, y, size):
    """A tile is split while it is nearer than 1.2 times its size."""
    gap = [max(low - v, 0, v - low - size) for low, v in zip((x, y), viewer)]
    if size > 2 and (gap[0] ** 2 + gap[1] ** 2) ** 0.5 < 1.2 * size:
        half = size / 2
        for dx in (0, half):
            for dy in (0, half):
                yield from tiles_for(viewer, x + dx, y + dy, half)
    else:
        yield x, y, size


def chunks(folder):
    d = Drawing(760, 360)
    frame = at(20, 310, 9)
    viewer = (9, 7)
    tint = {2: PALE[BLUE], 4: PALE[GREEN], 8: PALE[AMBER], 16: PALE[RED]}
    for x, y, size in tiles_for(viewer, 0, 0, 32):
        d.polygon([frame(p) for p in ((x, y), (x + size, y), (x + size, y + size), (x, y + size))], tint[size], GREY)
    d.dot(frame(viewer), 5, RED)
    d.text((164, 332), "tiles from above: each the largest whose error")
    d.text((164, 350), "on screen is within pixelError (red: the viewer)")
    # The wall along a border.
    fine = [(360, 190), (395, 160), (430, 172), (465, 130), (500, 118), (535, 140), (570, 132), (605, 96), (640, 110), (675, 128), (725, 150)]
    coarse = [(360, 190), (465, 120), (570, 150), (640, 88), (725, 150)]
    at_x = lambda chain, x: next(a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]) for a, b in zip(chain, chain[1:]) if a[0] <= x <= b[0])
    xs = sorted({p[0] for p in fine + coarse} | set(range(360, 726)))
    d.polygon([(x, at_x(fine, x)) for x in xs] + [(x, at_x(coarse, x)) for x in reversed(xs)], PALE[RED], None)
    d.polyline(fine, BLUE, 2.2)
    d.polyline(coarse, AMBER, 2.2)
    for p in fine:
        d.dot(p, 3, BLUE)
    for p in coarse:
        d.dot(p, 3.5, AMBER)
    d.text((542, 230), "along a border: the line of the finer tile (blue), of the coarser")
    d.text((542, 248), "one (amber), and the wall that fills what lies between them")
    d.write(folder + "/chunks.svg")


def morphing(folder):
    d = Drawing(760, 330)
    left, bottom, width, height, most, p, ratio = 60, 280, 620, 240, 5.0, 2.0, 0.5
    place = lambda s, v: (left + width * s / most, bottom - height * v / most)
    d.line((left, bottom), (left + width + 12, bottom), INK, 1.2, arrow=True)
    d.line((left, bottom), (left, bottom - height - 12), INK, 1.2, arrow=True)
    for i in range(6):
        d.text((place(i, 0)[0], bottom + 18), str(i), size=12)
        d.text((left - 10, place(0, i)[1] + 4), str(i), "end", size=12)
    d.text((left + width / 2, bottom + 38), "S: pixels that the error of the parent takes; grows as the camera comes nearer")
    d.line(place(0, p), place(most, p), GREY, 1.2, "5 4")
    d.text((place(most, p)[0] + 6, place(0, p)[1] + 4), "p", "start", GREY, 14, "italic")
    steps = [most * i / 200 for i in range(201)]
    share = lambda s: 0.0 if s <= p else min(1.0, (1 - p / s) / (1 - ratio))
    d.polyline([place(s, s) for s in steps], AMBER, 2)
    d.polyline([place(s, s * ratio) for s in steps], BLUE, 2)
    d.polyline([place(s, s * (1 - share(s) * (1 - ratio))) for s in steps if s <= p / ratio], RED, 3.5)
    for row, (colour, text) in enumerate([(AMBER, "S: if the parent were drawn"), (BLUE, "S e / E: if the tile itself were drawn"),
                                          (RED, "what shows: the tile slides from the one to the other")]):
        y = place(0, 4.7)[1] + 20 * row
        d.line((left + 20, y), (left + 50, y), colour, 3)
        d.text((left + 58, y + 4), text, "start")
    d.text((left - 40, bottom - height - 18), "pixels", "start", size=12)
    for s in (p, p / ratio):
        d.line(place(s, 0), place(s, p), GREY, 1, "2 3")
    d.text((place(p, 0)[0] + 4, bottom - 6), "t = 0", "start", GREY, 12)
    d.text((place(p / ratio, 0)[0] - 4, bottom - 6), "t = 1", "end", GREY, 12)
    d.write(folder + "/morphing.svg")


geomipmap(sys.argv[1])
chunks(sys.argv[1])
morphing(sys.argv[1])
