"""Usage: tutorial_blocks.py FILE.md FOLDER     writes the blocks of code into FOLDER as 01.iv, 02.sh, …, and prints a line for each:
number, line in FILE.md, name of the file that the block is, or "-" for commands, and what it needs.

A comment before a block says what it is: `<!-- file: NAME needs: TOOL … -->`, `<!-- run needs: TOOL … -->`, `<!-- setup -->` (which the caller
does otherwise). Blocks of commands (sh) need no comment; any other block without one is an error."""
import re
import sys


def blocks(lines):
    comment, start, code = "", None, []
    for number, line in enumerate(lines, 1):
        if start is not None:
            if line == "```":
                yield start, language, comment, "\n".join(code) + "\n"
                comment, start, code = "", None, []
            else:
                code.append(line)
        elif line.startswith("```"):
            start, language = number, line[3:]
        elif line.startswith("<!--"):
            comment = line[4:-3].strip()
        elif line.strip():
            comment = ""


with open(sys.argv[1], encoding="utf-8") as file:
    lines = file.read().split("\n")
for count, (line, language, comment, code) in enumerate(blocks(lines), 1):
    if comment == "setup":
        continue
    found = re.match(r"(?:file: (?P<file>\S+)|run)?\s*(?:needs: (?P<needs>.*))?$", comment)
    name = found.group("file") if found else None
    if not found or not (name or language == "sh"):
        sys.exit("%s:%d: expected a comment that says what the block is, found '%s'" % (sys.argv[1], line, comment))
    path = "%s/%02d.%s" % (sys.argv[2], count, "sh" if not name else name.rpartition(".")[2])
    with open(path, "w", encoding="utf-8") as file:
        file.write(code)
    print(path, line, name or "-", found.group("needs") or "")
