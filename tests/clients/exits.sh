#!/bin/bash
# Programs that show terrains may end in any order: nodes, contexts and Coin itself may go first, last or with the process. Each ends with
# status 0 and without a word.
set -u
. "$SOTERRAIN_SRCDIR/tests/clients/common.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sanitize=()
[ "${SOTERRAIN_SANITIZERS:-no}" = no ] || sanitize=(-fsanitize="$SOTERRAIN_SANITIZERS")
# shellcheck disable=SC2086
$CXX -std=c++20 "${sanitize[@]}" ${CLIENT_CFLAGS-} "$clients/exits.cpp" -o "$work/exits" ${CLIENT_LIBS--lCoin -lepoxy} || exit 1

# One terrain of each kind on one map.
{
    echo '#Inventor V2.1 ascii'
    echo 'PerspectiveCamera { position 16 -18 26 orientation 1 0 0 0.75 nearDistance 2 farDistance 150 }'
    echo "SoHeightMap { filename \"$clients/hills.raw\" }"
    for kind in BruteForce ROAM GeoMipmap ChunkedLoD GeometryClipmap; do echo "So${kind}Terrain { }"; done
} >"$work/all.iv"

for order in '' n nt ntc tnc tcn c cn f nf ntf ntcf tf tcf cf fc ftc; do
    # What stays until the process goes is what is tried here, not a leak.
    ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0" LD_LIBRARY_PATH="$modules" "$work/exits" "$work/all.iv" "$order" >"$work/said" 2>&1
    status=$?
    # Coin asks GLX for what an EGL context can't tell it.
    output=$(grep -v 'glxglue_isdirect' "$work/said")
    [ $status -ne 77 ] || exit 77
    if [ $status -ne 0 ] || [ -n "$output" ]; then
        echo "order '$order': expected status 0 and no message, found $status, '$output'"
        failed=1
    fi
done
exit $failed
