"""errors.svg: exact errors of a hierarchy, made monotone, beside ROAM's nested ones. screen.svg: a vertical error seen by a camera. The numbers of
the first are computed from the nine samples that it shows."""
import sys

from svg import AMBER, BLUE, Drawing, GREEN, GREY, INK, LIGHT, PALE, RED, at

HEIGHTS = [1.0, 1.8, 1.4, 3.2, 3.6, 3.7, 1.7, 2.3, 1.0]


def deviation(low, high, sample):
    return HEIGHTS[sample] - (HEIGHTS[low] + (HEIGHTS[high] - HEIGHTS[low]) * (sample - low) / (high - low))


def measured(low, high):
    """Largest deviation of all samples between two ends from the straight line."""
    return max((abs(deviation(low, high, i)) for i in range(low + 1, high)), default=0.0)


def monotone(low, high):
    if high - low < 2:
        return 0.0
    middle = (low + high) // 2
    return max(measured(low, high), monotone(low, middle), monotone(middle, high))


def nested(low, high):
    """ROAM's: that of the middle, and the larger one of the halves."""
    if high - low < 2:
        return 0.0
    middle = (low + high) // 2
    return abs(deviation(low, high, middle)) + max(nested(low, middle), nested(middle, high))


def errors(folder):
    d = Drawing(760, 330)
    frame = at(30, 250, 42)
    samples = [frame((i, h)) for i, h in enumerate(HEIGHTS)]
    for low, high, colour in ((0, 8, RED), (0, 4, BLUE), (4, 8, BLUE)):
        d.polyline([samples[low], samples[high]], colour, 1.5, "6 4")
        worst = max(range(low + 1, high), key=lambda i: abs(deviation(low, high, i)))
        line = HEIGHTS[worst] - deviation(low, high, worst)
        d.line(frame((worst, line)), samples[worst], colour, 2.5, arrow=True)
    d.polyline(samples, INK, 2)
    for p in samples:
        d.dot(p)
    d.text((198, 290), "samples; the lines of 1 and of 2 pieces,", colour=INK)
    d.text((198, 308), "and the sample that is furthest from each")
    rows = [[(0, 8)], [(0, 4), (4, 8)], [(0, 2), (2, 4), (4, 6), (6, 8)]]
    for level, pieces in enumerate(rows):
        for i, (low, high) in enumerate(pieces):
            x, y = 570 - 180 + 360 * (i + 0.5) / len(pieces), 40 + 80 * level
            if level < 2:
                for k in range(2):
                    d.line((x, y), (570 - 180 + 360 * (2 * i + k + 0.5) / (2 * len(pieces)), y + 80), LIGHT, 2)
            raised = monotone(low, high) > measured(low, high) + 1e-9
            d.rect(x - 42, y - 24, 84, 52, PALE[AMBER] if raised else "white", GREY)
            d.text((x, y - 8), "δ = %.2f" % measured(low, high), size=12)
            d.text((x, y + 8), "ε = %.2f" % monotone(low, high), colour=BLUE, size=12)
            d.text((x, y + 23), "w = %.2f" % nested(low, high), colour=RED, size=12)
    d.text((570, 262), "δ measured: the largest deviation of all samples below")
    d.text((570, 282), "ε made monotone: at least that of either child", colour=BLUE)
    d.text((570, 302), "w ROAM's nested wedgies, which add up", colour=RED)
    d.text((570, 322), "(amber: raised to a child's)", colour=AMBER)
    d.write(folder + "/errors.svg")


def screen(folder):
    d = Drawing(760, 340)
    eye = (60, 90)
    plane = 210
    ground = [(430, 262), (465, 236), (500, 216), (540, 222), (580, 236), (620, 226), (660, 240), (700, 262)]
    flat = [(430, 262), (700, 262)]
    d.rect(430, 200, 270, 62, PALE[BLUE], BLUE)
    d.polyline(flat, RED, 2, "6 4")
    d.polyline(ground, INK, 2)
    top, foot = (500, 216), (500, 262)

    def onto(p):
        t = (plane - eye[0]) / (p[0] - eye[0])
        return (plane, eye[1] + t * (p[1] - eye[1]))

    for p in (top, foot):
        d.line(eye, p, GREY, 1, "4 3")
    d.line(foot, top, RED, 3)
    d.line((plane, 40), (plane, 290), INK, 2)
    d.line(onto(foot), onto(top), RED, 4)
    d.dot(eye, 5)
    d.text((60, 74), "eye")
    d.text((plane, 30), "window, 2 s pixels high")
    d.text((plane - 8, onto(top)[1] + 2), "δ", "end", RED, 15, "italic")
    d.text((514, 246), "e", "start", RED, 15, "italic")
    d.text((566, 190), "box of the element: samples and drawn surface", colour=BLUE)
    d.text((640, 218), "samples", size=12)
    d.text((566, 280), "drawn surface", colour=RED)
    d.line((eye[0], 312), (430, 312), GREEN, 1.5, arrow=True)
    d.line((430, 262), (430, 318), GREEN, 1, "3 3")
    d.line((eye[0], 95), (eye[0], 318), GREEN, 1, "3 3")
    d.text((245, 330), "W: the least depth of the box", colour=GREEN)
    d.write(folder + "/screen.svg")


errors(sys.argv[1])
screen(sys.argv[1])
