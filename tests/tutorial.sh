#!/bin/bash
# Every block of docs/tutorial.md does what a reader expects: scenes load without a message and show something, commands succeed.
. "$(dirname "$0")/apps/common.sh"
unset DISPLAY WAYLAND_DISPLAY
export PYTHONDONTWRITEBYTECODE=1
[ "${SOTERRAIN_SANITIZERS:-no}" = no ] || skip "python and g++ of the tutorial are not built with sanitizers"
command -v python3 >/dev/null || skip "python3 is missing (Debian: python3)"
SOURCE=$(cd "$SOURCE" && pwd) BUILD=$(cd "$BUILD" && pwd)
make_map "$SCRATCH/probe.pgm"
expect 0 "$BUILD/SoTerrainTest" -h "$SCRATCH/probe.pgm" -a quadmesh --offscreen=64x48
grep -q 'offscreen rendering' "$SCRATCH/err" && skip "no EGL with desktop OpenGL"

# What an installed SoTerrain gives: programs that need no display, Coin's search path, a pkg-config file. Debian's pivy belongs to Debian's python.
mkdir "$SCRATCH/bin" "$SCRATCH/work" "$SCRATCH/blocks"
cat >"$SCRATCH/bin/SoTerrainTest" <<PROGRAM
#!/bin/bash
case "\$*" in
    *--offscreen*) exec "$BUILD/SoTerrainTest" "\$@" ;;
    *) exec "$BUILD/SoTerrainTest" "\$@" --offscreen=160x120 ;;
esac
PROGRAM
printf '#!/bin/bash\nexec "%s/soterrain-generate" "$@"\n' "$BUILD" >"$SCRATCH/bin/soterrain-generate"
[ -x /usr/bin/python3 ] && ln -s /usr/bin/python3 "$SCRATCH/bin/python3"
printf '#!/bin/bash\nPATH=%s exec %s "$@"\n' "$PATH" "${CXX:-g++}" >"$SCRATCH/bin/g++"
chmod +x "$SCRATCH"/bin/*
cat >"$SCRATCH/bin/soterrain.pc" <<PC
Name: SoTerrain
Description: not installed
Version: 0
Cflags: -I$SOURCE/nodes $CLIENT_CFLAGS
Libs: -L$BUILD/.libs -Wl,-rpath,$BUILD/.libs -lSoTerrain ${CLIENT_LIBS:--lCoin}
PC
export PATH=$SCRATCH/bin:$PATH PKG_CONFIG_PATH=$SCRATCH/bin LD_LIBRARY_PATH=$BUILD/modules:$BUILD/.libs

has() {
    case $1 in
        GDAL) grep -q '^#define HAVE_GDAL 1' "$BUILD/config.h" ;;
        OpenImageIO) grep -q '^#define HAVE_OPENIMAGEIO 1' "$BUILD/config.h" ;;
        pivy) python3 -c 'import pivy' 2>/dev/null ;;
        *) command -v "$1" >/dev/null ;;
    esac
}
has OpenImageIO || skip "this build reads no images"

# shows FILE: whether the scene draws more than a flat picture, and says nothing
shows() {
    expect 0 SoTerrainTest --scene "$1" --offscreen=160x120 --output "$SCRATCH/picture.ppm"
    [ -s "$SCRATCH/err" ] && fail "$1: $(cat "$SCRATCH/err")"
    [ "$(tail -n +4 "$SCRATCH/picture.ppm" | od -An -v -t u1 -w3 | sort -u | wc -l)" -gt 5 ] || fail "$1 shows nothing"
}

python3 "$SOURCE/tests/tutorial_blocks.py" "$SOURCE/docs/tutorial.md" "$SCRATCH/blocks" >"$SCRATCH/list" || fail "blocks of docs/tutorial.md"
cd "$SCRATCH/work" || exit 99
run=0
while read -r block line name needs; do
    for tool in $needs; do
        has "$tool" || { echo "left out: docs/tutorial.md:$line needs $tool"; continue 2; }
    done
    echo "docs/tutorial.md:$line $name"
    if [ "$name" = - ]; then
        expect 0 bash -eu -o pipefail "$block"
        [ -s "$SCRATCH/err" ] && fail "docs/tutorial.md:$line: $(cat "$SCRATCH/err")"
    else
        cp "$block" "$name"
        case $name in *.iv) shows "$name" ;; esac
    fi
    run=$((run + 1))
done <"$SCRATCH/list"
[ "$run" -ge 15 ] || fail "only $run blocks were tried"
for scene in *.iv; do
    grep -q " $scene " "$SCRATCH/list" || shows "$scene"
done

# A scene that cannot be read would be found.
printf '#Inventor V2.1 ascii\nSeparator { SoHeightMap { filename "nowhere.png" } SoROAMTerrain { } }\n' >bad.iv
(shows bad.iv) | grep -q '^FAIL: bad.iv: ' || fail "a scene without its map passes"
finish
