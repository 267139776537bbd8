"""Usage: doxygen_filter.py SOURCE_FOLDER FILE     prints FILE as Doxygen is to read it

Markdown files are written for GitHub. Here their headings get the names that GitHub gives them, as `{#page_heading}`, and links to other files
and headings become links of the site.

Headers get into the groups of the site by their folder. Those of the nodes lose what each Coin class declares anew and Coin documents:
constructors, initClass(), actions. The comments behind fields go too, because \\var in the .cpp file says it all; and of .cpp files
nothing is left but such comments.
"""
import os
import re
import sys

GROUPS = {
    "nodes/SoTerrain": "nodes_group",
    "nodes": "inside_nodes",
    "lib/base": "inside_base",
    "lib/height": "inside_height",
    "lib/lod": "inside_lod",
    "lib/gl": "inside_gl",
}
COIN = ("addWriteReference affectsState audioRender callback computeBBox copy copyContents copyFieldValues createInstance doAction generatePrimitives "
        "getBoundingBox getMatrix getPrimitiveCount GLRender GLRenderBelowPath GLRenderInPath GLRenderOffPath getChildren handleEvent init "
        "initClass matches copyMatchInfo notify pick rayPick readInstance search setDefaultOnNonWritingFields setPart write").split()


def slug(heading):
    """The name that GitHub gives to a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip().lower())
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def page(path):
    """The name of a Markdown file's page."""
    return os.path.splitext(os.path.basename(path))[0].lower().replace("-", "_")


def anchor(path, fragment):
    return page(path) + "_" + fragment.replace("-", "_")


def headings(lines):
    """(number of the line, level, text, name) of each heading outside of blocks of code."""
    fenced, used = False, {}
    for number, line in enumerate(lines):
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
        found = None if fenced else re.match(r"(#{1,6})\s+(.*?)\s*#*$", line)
        if found:
            name = slug(found.group(2))
            count = used.get(name, 0)
            used[name] = count + 1
            yield number, len(found.group(1)), found.group(2), name if count == 0 else "%s-%d" % (name, count)


def in_site(path):
    return path in ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md") or re.match(r"docs/[^/]+\.md$", path)


def link(path, text, target):
    """What a link of a Markdown file becomes; its text alone where the site has no such page."""
    if re.match(r"[a-z]+:", target):
        return "[%s](%s)" % (text, target)
    name, _, fragment = target.partition("#")
    file = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
    source = re.match(r"nodes/(?:SoTerrain/)?(So\w+)\.(?:cpp|h)$", file)
    if source:
        return "[%s](@ref %s)" % (text, source.group(1))
    if not in_site(file):
        return text
    return "[%s](@ref %s)" % (text, anchor(file, fragment) if fragment else page(file))


def markdown(path, lines):
    titles = {number: (level, text, name) for number, level, text, name in headings(lines)}
    fenced = False
    for number, line in enumerate(lines):
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
        if number in titles:
            level, text, name = titles[number]
            own = page(path) if level == 1 else anchor(path, name)
            yield "%s %s%s" % ("#" * level, text, "" if own == "index" else " {#%s}" % own)
        elif fenced or line.startswith("    "):
            yield line
        else:
            yield re.sub(r"(?<!!)\[((?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*)\]\(([^)\s]+)\)",
                         lambda m: link(path, m.group(1), m.group(2)), line)


def header(path, lines):
    group = GROUPS.get(os.path.dirname(path))
    public = group == "nodes_group"
    name = os.path.splitext(os.path.basename(path))[0]
    drop = re.compile(r"\s*(virtual .*\b(%s)|static void initClass|(virtual )?~?%s)\(.*\).*;" % ("|".join(COIN), name))
    for number, line in enumerate(lines):
        if public and drop.match(line):
            line = ""
        if public and re.match(r"\s*So[SM]F\w+ ", line):
            line = re.sub(r"\s*///<.*", "", line)
        if re.match(r"\s*//", line):
            line = re.sub(r"(?<!\\)#(?=\w)", r"\#", line)
        if public and re.match(r"\s*(class Private;|std::unique_ptr<Private> pimpl;|friend class Private;)", line):
            line = ""
        if number == 0:
            line = "/*! \\addtogroup %s */ /*! @{ */ %s" % (group, "" if line.startswith("//") else line)
        yield line
    yield "/*! @} */"


def comments(lines):
    """Of a .cpp file nothing but comments for Doxygen."""
    inside = False
    for line in lines:
        inside = inside or line.startswith("/*!")
        yield line if inside else ""
        inside = inside and "*/" not in line


def main():
    root, path = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2])
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    path = os.path.relpath(path, root)
    if path.endswith(".md"):
        lines = markdown(path, lines)
    elif path.endswith(".h"):
        lines = header(path, lines)
    elif path.endswith(".cpp"):
        lines = comments(lines)
    sys.stdout.reconfigure(encoding="utf-8")
    sys.stdout.write("\n".join(lines))


if __name__ == "__main__":
    main()
