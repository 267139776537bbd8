#!/bin/bash
# examples/python/terrain.py draws the shipped terrain: with the nodes found by name, and with the library alone.
set -u
. "$SOTERRAIN_SRCDIR/tests/clients/common.sh"
if [ "${SOTERRAIN_SANITIZERS:-no}" != no ]; then
    echo "skipped: python is not built with sanitizers"
    exit 77
fi
python=/usr/bin/python3
[ -x $python ] && $python -c 'from pivy import coin' 2>/dev/null || { echo "skipped: no pivy (Debian: python3-pivy)"; exit 77; }

# draws NAME FOLDER: with FOLDER as the only one of SoTerrain's, the picture has the ground's greens and the snow's white.
draws_terrain() {
    local picture=$pictures/$1.ppm
    rm -f "$picture"
    (cd "$SOTERRAIN_SRCDIR" && LD_LIBRARY_PATH=$2 $python examples/python/terrain.py --picture "$picture") || failed=1
    bash "$SOTERRAIN_SRCDIR/tests/clients/is_terrain.sh" "$picture" || failed=1
}

draws_terrain client_python_example "$modules"
draws_terrain client_python_example_library "$SOTERRAIN_BUILDDIR/.libs"
(cd "$SOTERRAIN_SRCDIR" && env -u LD_LIBRARY_PATH $python examples/python/terrain.py --picture "$pictures/none.ppm" 2>&1) |
    grep -q 'set LD_LIBRARY_PATH' || [ -e /usr/lib/*/libSoTerrain.so.0 ] || [ -e /usr/local/lib/libSoTerrain.so.0 ] || { echo "no hint where the library is missing"; failed=1; }
exit $failed
