"""bisection.svg: the levels of longest-edge bisection, a diamond, and what a forced split is. The mesh is made as the library makes it: a diamond
is named by the middle of its longest edge, and is split after both of its parents."""
import sys

from svg import AMBER, BLUE, Drawing, GREEN, GREY, INK, PALE, RED, at


def corners(c):
    s = (c[0] | c[1]) & -(c[0] | c[1])
    if c[0] & c[1] & s:
        parent = [v + s if (v + s) & (2 * s) else v - s for v in c]
        d = (parent[0] - c[0], parent[1] - c[1])
        return [(c[0] + d[0], c[1] + d[1]), (c[0] - d[1], c[1] + d[0]), (c[0] - d[0], c[1] - d[1]), (c[0] + d[1], c[1] - d[0])]
    if c[0] & s:
        return [(c[0] + s, c[1]), (c[0], c[1] + s), (c[0] - s, c[1]), (c[0], c[1] - s)]
    return [(c[0], c[1] - s), (c[0] + s, c[1]), (c[0], c[1] + s), (c[0] - s, c[1])]


class Mesh:
    def __init__(self, side):
        self.side, self.split = side, set()

    def inside(self, p):
        return 0 <= p[0] <= self.side and 0 <= p[1] <= self.side

    def refine(self, c):
        """Splits a diamond, and before that whichever of its parents are not; the centres in the order of the splits."""
        if c in self.split or not self.inside(c):
            return []
        q = corners(c)
        done = [d for parent in (q[1], q[3]) if c != self.root() and self.inside(parent) for d in self.refine(parent)]
        self.split.add(c)
        return done + [c]

    def root(self):
        return (self.side // 2, self.side // 2)

    def triangles(self):
        s = self.side
        todo, found = [((0, 0), (s, 0), (s, s)), ((s, s), (0, s), (0, 0))], []
        while todo:
            a, apex, b = todo.pop()
            middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
            if middle in self.split:
                todo += [(a, middle, apex), (apex, middle, b)]
            else:
                found.append((a, apex, b))
        return found


def every_level(side):
    mesh = Mesh(side)
    yield mesh.triangles()
    centres = [mesh.root()]
    for _ in range(4):
        for c in centres:
            mesh.refine(c)
        yield mesh.triangles()
        centres = sorted({(int(a[0] + b[0]) // 2, int(a[1] + b[1]) // 2) for a, apex, b in mesh.triangles()})


def draw_mesh(drawing, frame, triangles, colours=None):
    for t in triangles:
        drawing.polygon([frame(p) for p in t], (colours or {}).get(t, "white"), INK, 1.0)


def main(folder):
    d = Drawing(760, 480)
    for i, triangles in enumerate(every_level(4)):
        frame = at(20 + 150 * i, 140, 30)
        draw_mesh(d, frame, triangles)
        d.text((80 + 150 * i, 162), "%d step%s" % (i, "" if i == 1 else "s"))
    # A diamond: two triangles that share their longest edge.
    frame, q = at(100, 330, 55), [(1, 0), (0, 1), (-1, 0), (0, -1)]
    d.polygon([frame(p) for p in q], PALE[BLUE], INK, 1.5)
    d.line(frame(q[0]), frame(q[2]), INK, 1.5)
    d.line(frame(q[1]), frame(q[3]), RED, 1.5, "5 4")
    d.dot(frame((0, 0)), 4.5, RED)
    for i, (dx, dy) in enumerate([(16, 4), (0, -9), (-16, 4), (0, 18)]):
        x, y = frame(q[i])
        d.text((x + dx, y + dy), "q" + "₀₁₂₃"[i], style="italic")
    d.text((122, 322), "c", "start", RED, style="italic")
    d.text((100, 440), "a diamond, its centre c and")
    d.text((100, 458), "the edge that splitting it adds")
    # A forced split.
    mesh = Mesh(8)
    for c in [(4, 4), (4, 0), (2, 2), (2, 0), (0, 4), (4, 8), (8, 4)]:
        mesh.refine(c)
    wanted = (5, 5)
    q = corners(wanted)
    before = mesh.triangles()
    hit = {t: PALE[RED] for t in before if {t[0], t[2]} == {q[0], q[2]}}
    frame = at(265, 420, 24)
    draw_mesh(d, frame, before, hit)
    d.dot(frame(wanted), 4.5, RED)
    d.text((361, 440), "to split at the red point …")
    chain = mesh.refine(wanted)
    frame = at(520, 420, 24)
    draw_mesh(d, frame, mesh.triangles())
    for number, c in enumerate(chain, 1):
        x, y = frame(c)
        d.dot((x, y), 9, RED if c == wanted else BLUE)
        d.text((x, y + 4), str(number), colour="white", size=11)
    d.text((616, 440), "… its parents (blue) are split first,")
    d.text((616, 458), "so that no vertex stands on an edge")
    d.write(folder + "/bisection.svg")


main(sys.argv[1])
