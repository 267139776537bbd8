#!/bin/bash
# The manual pages are clean, tell of the options that --help tells of and of no others, and name every node class.
. "$(dirname "$0")/apps/common.sh"
manuals=$SOURCE/man

if command -v groff >/dev/null; then
    for page in "$manuals"/*.[1-9]; do
        groff -mandoc -ww -rCHECKSTYLE=3 -Tutf8 -K utf8 -z "$page" >"$SCRATCH/warnings" 2>&1
        [ ! -s "$SCRATCH/warnings" ] || { fail "$page:"; cat "$SCRATCH/warnings"; }
    done
fi

# in_help: the options of a help text; in_page: those of a page's lists.
in_help() { grep -oE '(^|[ ,[])--?[A-Za-z][a-z-]*' | tr -d ' ,[' | sort -u; }
in_page() { grep -E '^\.It Fl' "$1" | grep -oE 'Fl -?[A-Za-z][a-z-]*' | sed 's/Fl /-/' | sort -u; }

for program in SoTerrainTest soterrain-bench soterrain-generate soterrain-report soterrain-run; do
    "$BUILD/$program" --help | grep -vE '^Keys|^  (W S|Keypad|Enter|\]|Left|Ctrl|1 to|F5|F12)' | in_help >"$SCRATCH/help"
    in_page "$manuals/$program.1" >"$SCRATCH/page"
    diff "$SCRATCH/help" "$SCRATCH/page" >"$SCRATCH/differences" || { fail "$program: --help (<) and manual (>) differ"; cat "$SCRATCH/differences"; }
    [ -s "$SCRATCH/page" ] || fail "$program: no option in the manual"
done

for class in $(sed -n '/^NODE_CLASSES/,/[^\\]$/p' "$SOURCE/Makefile.am" | grep -oE 'So[A-Za-z]+'); do
    grep -q "^.It Ic $class" "$manuals/soterrain.7" || fail "soterrain.7 does not tell of $class"
done
finish
