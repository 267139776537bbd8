"""Usage: docs_check.py links SOURCE          every relative link and image of README.md, docs/*.md and so on leads somewhere
          docs_check.py site BUILD/docs CLASS...   the site has a page for each node class, nothing public of them is undocumented, no link is broken

Prints what is wrong, a line each; the exit status is 1 then. The Markdown half reads files as GitHub does, names of headings included.
"""
import glob
import html
import os
import re
import sys
import urllib.parse
import xml.etree.ElementTree as ElementTree

sys.dont_write_bytecode = True
failures = 0


def complain(text):
    global failures
    failures += 1
    print(text)


# ------------------------------------------------------------------------------------------------------------------------ Markdown

def without_code(lines):
    fenced = False
    for line in lines:
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
            yield ""
        else:
            yield "" if fenced or line.startswith("    ") else re.sub(r"`[^`]*`", "", line)


def check_markdown(source):
    sys.path.insert(0, os.path.join(source, "docs"))
    from doxygen_filter import headings

    def read(path):
        with open(path, encoding="utf-8") as file:
            return file.read().split("\n")

    files = glob.glob(source + "/*.md") + glob.glob(source + "/docs/*.md") + glob.glob(source + "/*/README.md") + \
        glob.glob(source + "/docs/*/README.md")
    for path in sorted(files):
        for number, line in enumerate(without_code(read(path)), 1):
            targets = re.findall(r"\]\(([^)\s]+)\)", line) + re.findall(r"<img[^>]* src=\"([^\"]+)\"", line)
            for target in targets:
                if re.match(r"[a-z]+:", target):
                    continue
                name, _, fragment = target.partition("#")
                file = os.path.join(os.path.dirname(path), urllib.parse.unquote(name)) if name else path
                where = "%s:%d: %s" % (os.path.relpath(path, source), number, target)
                if not os.path.exists(file):
                    complain(where + " does not exist")
                elif fragment and not (file.endswith(".md") and fragment in {h[3] for h in headings(read(file))}):
                    complain(where + " has no such heading")


# ---------------------------------------------------------------------------------------------------------------------------- site

def has_text(node):
    return any("".join(part.itertext()).strip() for part in node.findall("briefdescription") + node.findall("detaileddescription"))


def check_members(compound, name):
    for member in compound.iter("memberdef"):
        if member.get("prot") == "private" or member.get("kind") == "friend":
            continue
        what = "%s::%s" % (name, member.findtext("name"))
        if not has_text(member):
            complain(what + " is not documented")
        for value in member.findall("enumvalue"):
            # The text of the enumeration may say what its values are.
            text = " ".join("".join(part.itertext()) for part in member.findall("detaileddescription") + member.findall("briefdescription"))
            if not has_text(value) and not re.search(r"\b%s\b" % value.findtext("name"), text):
                complain("%s: %s is not documented" % (what, value.findtext("name")))


def fields_of(compound):
    for member in compound.iter("memberdef"):
        if member.get("kind") == "variable" and re.match(r"So[SM]F", "".join(member.find("type").itertext())):
            yield member.findtext("name")


def check_class(folder, name, abstract):
    path = "%s/xml/class%s.xml" % (folder, name)
    if not os.path.exists(path):
        return complain(name + " has no page")
    compound = ElementTree.parse(path).getroot().find("compounddef")
    if not has_text(compound):
        complain(name + " is not documented")
    check_members(compound, name)
    for space in compound.iter("sp"):
        space.text = " "
    text = "".join(compound.find("detaileddescription").itertext())
    file_format = text.partition("FILE FORMAT/DEFAULTS")[2]
    for field in fields_of(compound):
        if not abstract and not re.search(r"\b%s\b" % field, file_format):
            complain("%s: %s is not under FILE FORMAT/DEFAULTS" % (name, field))


def check_site(folder, classes):
    public = {re.sub(r"\.h$", "", os.path.basename(path)) for path in glob.glob(os.environ.get("SOTERRAIN_SRCDIR", ".") + "/nodes/SoTerrain/*.h")}
    for name in sorted(public | set(classes)):
        if os.path.exists("%s/xml/struct%s.xml" % (folder, name)):
            compound = ElementTree.parse("%s/xml/struct%s.xml" % (folder, name)).getroot().find("compounddef")
            check_members(compound, name)
        else:
            check_class(folder, name, name not in classes or name == "SoTerrainShape")
    check_html(folder + "/html")


def check_html(folder):
    pages = {}
    for path in glob.glob(folder + "/*.html"):
        with open(path, encoding="utf-8") as file:
            pages[os.path.basename(path)] = file.read()
    if "index.html" not in pages:
        return complain("the site has no index.html")
    anchors = {name: set(re.findall(r"(?:id|name)=\"([^\"]+)\"", text)) for name, text in pages.items()}
    for name, text in sorted(pages.items()):
        for target in set(re.findall(r"(?:href|src|data)=\"([^\"]+)\"", text)):
            target = html.unescape(target)
            if re.match(r"[a-z]+:", target):
                continue
            file, _, fragment = target.partition("#")
            file = urllib.parse.unquote(file) or name
            if not os.path.exists(os.path.join(folder, file)):
                complain("%s: %s does not exist" % (name, target))
            elif fragment and file in anchors and fragment not in anchors[file]:
                complain("%s: %s has no such place" % (name, target))


if sys.argv[1:2] == ["links"] and len(sys.argv) == 3:
    check_markdown(os.path.realpath(sys.argv[2]))
elif sys.argv[1:2] == ["site"] and len(sys.argv) > 3:
    check_site(sys.argv[2], sys.argv[3:])
else:
    sys.exit(__doc__)
sys.exit(1 if failures else 0)
