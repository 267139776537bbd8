"""What the figures share: a drawing that is written as SVG, and colours."""

INK, GREY, LIGHT, RED, BLUE, GREEN, AMBER = "#222222", "#888888", "#dddddd", "#c0392b", "#2c6fb0", "#3b8a3e", "#d68910"
PALE = {RED: "#f6d5d1", BLUE: "#d4e4f4", GREEN: "#d6ecd2", AMBER: "#fbe7c6", GREY: "#eeeeee"}


class Drawing:
    """Coordinates are pixels, y down; a frame (see `at`) turns others into these."""

    def __init__(self, width, height):
        self.parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d" '
                      'font-family="DejaVu Sans, Helvetica, sans-serif" font-size="13">' % (width, height, width, height),
                      '<rect width="%d" height="%d" fill="white"/>' % (width, height)]

    @staticmethod
    def points(points):
        return " ".join("%.1f,%.1f" % (x, y) for x, y in points)

    def line(self, a, b, colour=INK, width=1.0, dash=None, arrow=False):
        extra = ' stroke-dasharray="%s"' % dash if dash else ""
        self.parts.append('<line x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f" stroke="%s" stroke-width="%.2f"%s/>' % (*a, *b, colour, width, extra))
        if arrow:
            length = ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5 or 1.0
            dx, dy = (b[0] - a[0]) / length * 8, (b[1] - a[1]) / length * 8
            self.polygon([b, (b[0] - dx - dy / 2.5, b[1] - dy + dx / 2.5), (b[0] - dx + dy / 2.5, b[1] - dy - dx / 2.5)], colour, None)

    def polyline(self, points, colour=INK, width=1.5, dash=None):
        extra = ' stroke-dasharray="%s"' % dash if dash else ""
        self.parts.append('<polyline points="%s" fill="none" stroke="%s" stroke-width="%.2f"%s/>' % (self.points(points), colour, width, extra))

    def polygon(self, points, fill="none", stroke=INK, width=1.0):
        self.parts.append('<polygon points="%s" fill="%s" stroke="%s" stroke-width="%.2f" stroke-linejoin="round"/>'
                          % (self.points(points), fill, stroke or "none", width))

    def rect(self, x, y, width, height, fill="none", stroke=INK, line=1.0):
        self.polygon([(x, y), (x + width, y), (x + width, y + height), (x, y + height)], fill, stroke, line)

    def dot(self, at, radius=3.0, fill=INK):
        self.parts.append('<circle cx="%.1f" cy="%.1f" r="%.1f" fill="%s"/>' % (*at, radius, fill))

    def text(self, at, text, anchor="middle", colour=INK, size=13, style=""):
        self.parts.append('<text x="%.1f" y="%.1f" text-anchor="%s" fill="%s" font-size="%d"%s>%s</text>'
                          % (*at, anchor, colour, size, ' font-style="italic"' if style == "italic" else "",
                             text.replace("&", "&amp;").replace("<", "&lt;")))

    def write(self, path):
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(self.parts + ["</svg>"]) + "\n")


def at(x, y, scale):
    """A frame: its origin in pixels, y up."""
    return lambda p: (x + p[0] * scale, y - p[1] * scale)
