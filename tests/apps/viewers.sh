#!/bin/bash
# Viewers of SoQt on one scene: two at once, one beside a context without a window, and many that open and close. No crash, and GL objects
# and memory stay as they were.
. "$(dirname "$0")/common.sh"
for tool in Xvfb xvfb-run xauth pkg-config; do command -v $tool >/dev/null || skip "$tool is missing"; done
[ "${SOTERRAIN_SANITIZERS:-no}" = no ] || skip "Qt and SoQt are not built with sanitizers"
"$TEST" --help 2>/dev/null | grep -q offscreen || skip "no programs"
modules="Qt5Widgets Qt5OpenGL epoxy glm"
pkg-config --exists $modules || skip "Qt 5 is missing"
# shellcheck disable=SC2046,SC2086
$CXX -std=gnu++20 -O1 -fPIC -I"$SOURCE/lib" -I"$SOURCE/nodes" ${CLIENT_CFLAGS-} $(pkg-config --cflags $modules) "$SOURCE/tests/apps/viewers.cpp" -o "$SCRATCH/viewers" \
    -L"$BUILD/.libs" -lSoTerrain -lSoQt ${CLIENT_LIBS--lCoin -lepoxy} $(pkg-config --libs $modules) 2>"$SCRATCH/compiler" || {
    grep -q 'Inventor/Qt\|-lSoQt' "$SCRATCH/compiler" && skip "SoQt is missing"
    cat "$SCRATCH/compiler"
    fail "viewers.cpp does not build"
    finish
}
unset WAYLAND_DISPLAY QT_QPA_PLATFORM EGL_PLATFORM
export XDG_RUNTIME_DIR=$SCRATCH QT_QPA_PLATFORM=xcb LD_LIBRARY_PATH=$BUILD/.libs${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
pictures=$BUILD/tests/pictures
mkdir -p "$pictures"

# view CLASS: sets `beside` and `alone` to the megabytes that it grew by
view() {
    expect 0 timeout 200 xvfb-run -a -s '-screen 0 800x600x24' "$SCRATCH/viewers" "$pictures" "$1"
    echo "$1:" && cat "$SCRATCH/out"
    beside=$(sed -n 's/growth beside one: \(.*\) MB/\1/p' "$SCRATCH/out")
    alone=$(sed -n 's/growth alone: \(.*\) MB/\1/p' "$SCRATCH/out")
}
for class in SoROAMTerrain SoGeometryClipmapTerrain; do
    view $class
    for grew in "${beside:-1000}" "${alone:-1000}"; do
        # Drivers keep a megabyte or two now and then.
        LC_ALL=C awk -v grew="$grew" 'BEGIN { exit !(grew <= 4) }' || fail "$class: viewers that were closed leave $grew MB"
    done
done
finish
