"""clipmap.svg: three levels of a geometry clipmap of 15 x 15 vertices in their footprints, placed as the library places them. toroidal.svg: what is
newly exposed when a level moves, and where it lies in the texture."""
import sys

from svg import AMBER, BLUE, Drawing, GREEN, GREY, INK, LIGHT, PALE, RED, at

N = 15
M = (N + 1) // 4


def low(level, viewer):
    """First vertex of a level, in vertices of that level; the viewer in units of the finest one."""
    return [2 * (v // (2 << level)) - (2 * M - 2) for v in viewer]


def footprints(level, viewer):
    """(kind, x, y, columns, rows) in cells of the level."""
    x, y = low(level, viewer)
    b = M - 1
    starts = [0, b, 2 * b + 2, 3 * b + 2]
    for i in range(4):
        for j in range(4):
            if level == 0 or i in (0, 3) or j in (0, 3):
                yield "block", x + starts[i], y + starts[j], b, b
    if level == 0:
        yield "strip", x, y + 2 * b, N - 1, 2
        yield "strip", x + 2 * b, y, 2, 2 * b
        yield "strip", x + 2 * b, y + 2 * b + 2, 2, 2 * b
        return
    for i in (0, 3 * b + 2):
        yield "strip", x + i, y + 2 * b, b, 2
        yield "strip", x + 2 * b, y + i, 2, b
    fine = [v // 2 for v in low(level - 1, viewer)]
    width = (N - 1) // 2
    hole = (x + b, y + b)
    column = hole[0] if fine[0] > hole[0] else hole[0] + 2 * M - 1
    row = hole[1] if fine[1] > hole[1] else hole[1] + 2 * M - 1
    yield "trim", column, hole[1], 1, 2 * M
    yield "trim", fine[0], row, width, 1


def clipmap(folder):
    d = Drawing(760, 440)
    viewer = (5, 2)
    tint = [BLUE, GREEN, AMBER]
    frame = at(205, 230, 6.6)
    for level in (2, 1, 0):
        for kind, x, y, columns, rows in footprints(level, viewer):
            s = 1 << level
            fill = PALE[tint[level]] if kind == "block" else "white" if kind == "strip" else PALE[RED]
            d.polygon([frame(p) for p in ((x * s, y * s), ((x + columns) * s, y * s), ((x + columns) * s, (y + rows) * s), (x * s, (y + rows) * s))],
                      fill, tint[level] if kind != "trim" else RED, 1.4)
    d.dot(frame(viewer), 4.5, RED)
    d.text((232, 420), "three levels: blocks (tinted), strips (white), L-shaped trims (red)")
    # The share of the coarser level along a line through the viewer.
    x0, x1, base, top = 480, 730, 300, 130
    middle, width = (x0 + x1) / 2, 40
    d.line((x0, base), (x1 + 8, base), INK, 1.2, arrow=True)
    d.line((x0, base), (x0, top - 20), INK, 1.2, arrow=True)
    d.polyline([(x0, top), (x0 + 12, top), (x0 + 12 + width, base), (x1 - 12 - width, base), (x1 - 12, top), (x1, top)], BLUE, 2.5)
    d.dot((middle, base), 4.5, RED)
    d.text((middle, base + 20), "viewer")
    d.text((x0 - 8, top + 4), "1", "end", size=12)
    d.text((x0 - 8, base + 4), "0", "end", size=12)
    d.text((x0 + 6, top - 18), "α: share of the coarser level", "start", BLUE)
    for end in (x0 + 12, x0 + 12 + width):
        d.line((end, base), (end, base + 32), GREY, 1, "2 3")
    d.text((x0 + 12 + width / 2, base + 46), "w cells")
    d.text((x0 + 12, base + 64), "perimeter", "middle", GREY, 11)
    d.write(folder + "/clipmap.svg")


def toroidal(folder):
    d = Drawing(760, 330)
    n, cell, move = 12, 20, (4, 3)
    before = (5, 2)
    after = (before[0] + move[0], before[1] + move[1])
    frame = at(30, 300, 16)
    inside = lambda v, corner: all(corner[i] <= v[i] < corner[i] + n for i in range(2))
    new = [(x, y) for x in range(after[0], after[0] + n) for y in range(after[1], after[1] + n) if not inside((x, y), before)]
    colour = lambda v: PALE[AMBER] if v[1] >= before[1] + n else PALE[BLUE]
    cells = lambda v: [frame(p) for p in (v, (v[0] + 1, v[1]), (v[0] + 1, v[1] + 1), (v[0], v[1] + 1))]
    for v in new:
        d.polygon(cells(v), colour(v), LIGHT)
    for corner, dash in ((before, True), (after, False)):
        a, b = frame(corner), frame((corner[0] + n, corner[1] + n))
        d.polyline([a, (b[0], a[1]), b, (a[0], b[1]), a], GREY if dash else INK, 2, "5 4" if dash else None)
    d.text((250, 322), "the level before (dashed) and after the viewer moved, and what is new")
    frame = at(480, 270, 20)
    for x in range(after[0], after[0] + n):
        for y in range(after[1], after[1] + n):
            v = (x % n, y % n)
            d.polygon(cells(v), colour((x, y)) if (x, y) in new else "white", LIGHT)
    a, b = frame((0, 0)), frame((n, n))
    d.polyline([a, (b[0], a[1]), b, (a[0], b[1]), a], INK, 2)
    d.text((600, 290), "the texture: vertex (x, y) at (x mod n, y mod n),", size=12)
    d.text((600, 308), "so that all else stays where it is", size=12)
    d.write(folder + "/toroidal.svg")


clipmap(sys.argv[1])
toroidal(sys.argv[1])
