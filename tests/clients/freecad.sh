#!/bin/bash
# FreeCAD opens scenes with our nodes: found by name, made known by examples/freecad/InitGui.py, and as stand-ins without either.
set -u
. "$SOTERRAIN_SRCDIR/tests/clients/common.sh"
if [ "${SOTERRAIN_SANITIZERS:-no}" != no ]; then
    echo "skipped: FreeCAD is not built with sanitizers"
    exit 77
fi
command -v freecad >/dev/null || { echo "skipped: no FreeCAD (Debian: freecad-python3)"; exit 77; }
command -v xvfb-run >/dev/null || { echo "skipped: no xvfb-run (Debian: xvfb, xauth)"; exit 77; }
unset LD_LIBRARY_PATH
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
# The start page is a web browser, which does not run as root.
cat >"$home/user.cfg" <<'END'
<?xml version="1.0" encoding="UTF-8"?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences"><FCParamGroup Name="General">
<FCText Name="AutoloadModule">NoneWorkbench</FCText>
</FCParamGroup></FCParamGroup></FCParamGroup></FCParamGroup></FCParameters>
END

# shows NAME COLOUR OTHER VARIABLE=VALUE...: of ROAM.iv FreeCAD's picture shows COLOUR and nothing of OTHER.
shows() {
    local name=$1 colour=$2 other=$3 output
    shift 3
    output=$(cd "$clients" && env "$@" HOME="$home" SCENE="$clients/ROAM.iv" PICTURE="$pictures/$name.png" \
        timeout 60 xvfb-run -a freecad -u "$home/user.cfg" "$clients/freecad_picture.py" 2>"$home/errors" | grep green)
    local shown=$(sed -n "s/.*$colour \([0-9]*\).*/\1/p" <<<"$output") hidden=$(sed -n "s/.*$other \([0-9]*\).*/\1/p" <<<"$output")
    if [ "${shown:-0}" -lt 5000 ] || [ "${hidden:-1}" -ne 0 ]; then
        echo "$name: expected $colour and no $other, found '$output'"
        cat "$home/errors"
        failed=1
    fi
}

shows client_freecad green red LD_LIBRARY_PATH="$modules"
shows client_freecad_unknown red green NONE=
mkdir -p "$home/.local/share/FreeCAD/Mod/SoTerrain"
cp "$SOTERRAIN_SRCDIR/examples/freecad/InitGui.py" "$home/.local/share/FreeCAD/Mod/SoTerrain"
shows client_freecad_addon green red LD_LIBRARY_PATH="$SOTERRAIN_BUILDDIR/.libs"
exit $failed
