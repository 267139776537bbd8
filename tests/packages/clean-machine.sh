#!/bin/bash
# Usage: clean-machine.sh FOLDER [CLIENT]...
#
# Tries the packages in FOLDER (libsoterrain0_*.deb and the others, as `make deb` leaves them) on Debian 12 machines with nothing else: for
# every client a new one (a chroot from debootstrap), with that client's own packages besides. Every client draws the installed
# terrain, and its picture is checked. CLIENTs are: tools dev coin python freecad; without any, all. FreeCAD takes a gigabyte.
#
# Needs root, debootstrap and a Debian mirror (MIRROR). Keeps the bare machine, downloaded packages and pictures in clean-machine/
# (CLEAN_MACHINE). One line a check, and the totals; fails if one failed. Mounts end with the script, because they are its own.
set -u
[ $# -ge 1 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
[ "$(id -u)" -eq 0 ] || { echo "clean-machine.sh: only root can make machines" >&2; exit 1; }
command -v debootstrap >/dev/null || { echo "clean-machine.sh: debootstrap is missing" >&2; exit 1; }
if [ "${CLEAN_MACHINE_UNSHARED-}" != yes ]; then
    CLEAN_MACHINE_UNSHARED=yes exec unshare --mount --propagation private bash "$0" "$@"
fi

here=$(cd "$(dirname "$0")" && pwd)
packages=$(cd "$1" && pwd) || exit 1
shift
clients=${*:-tools dev coin python freecad}
cache=${CLEAN_MACHINE:-$PWD/clean-machine}
mirror=${MIRROR:-http://deb.debian.org/debian}
base=$cache/base machine=$cache/machine archives=$cache/archives pictures=$cache/pictures taken=$cache/taken
passed=0 failed=0 skipped=0
mkdir -p "$archives" "$pictures" "$taken"

leave() {
    umount "$machine/proc" 2>/dev/null
    [ ! -d "$machine" ] || rm -rf --one-file-system "$machine"
}
trap leave EXIT
trap 'exit 130' INT TERM

say() { echo "clean-machine: $*"; }

# check NAME COMMAND...
check() {
    local name=$1
    shift
    if "$@" >"$cache/log" 2>&1; then
        echo "PASS: $name"
        passed=$((passed + 1))
    else
        echo "FAIL: $name"
        tail -20 "$cache/log" | sed 's/^/    /'
        failed=$((failed + 1))
    fi
}

inside() { chroot "$machine" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 LIBGL_ALWAYS_SOFTWARE=1 "$@"; }

make_base() {
    [ -e "$base/.complete" ] && return
    say "debootstrap"
    rm -rf --one-file-system "$base"
    debootstrap --variant=minbase bookworm "$base" "$mirror" >"$cache/debootstrap.log" 2>&1 || { tail "$cache/debootstrap.log"; exit 1; }
    touch "$base/.complete"
}

# new_machine PACKAGE...: Debian with what these need. A package that lies in the folder comes from there.
new_machine() {
    local names=() name file
    leave
    cp -a "$base" "$machine"
    mount -t proc proc "$machine/proc"
    printf '#!/bin/sh\nexit 101\n' >"$machine/usr/sbin/policy-rc.d"
    chmod +x "$machine/usr/sbin/policy-rc.d"
    cp /etc/resolv.conf /etc/hosts "$machine/etc/"
    # Nothing here has to outlive a power cut.
    echo force-unsafe-io >"$machine/etc/dpkg/dpkg.cfg.d/unsafe-io"
    apt-config dump Acquire | grep -iE '::(proxy|check-valid-until|check-date) ' >"$machine/etc/apt/apt.conf.d/00host"
    printf '%s\n' "deb $mirror bookworm main" "deb $mirror bookworm-updates main" \
        "deb ${SECURITY_MIRROR:-${mirror%/debian}/debian-security} bookworm-security main" >"$machine/etc/apt/sources.list"
    mkdir -p "$machine/packages"
    cp -al "$archives/." "$machine/var/cache/apt/archives/" 2>/dev/null || cp -a "$archives/." "$machine/var/cache/apt/archives/"
    # apt takes a dependency from the folder too, so all of it is a repository of one machine.
    for file in "$packages"/*.deb; do cp "$file" "$machine/packages/"; done
    for name in "$@"; do
        file=$(cd "$packages" && ls "$name"_*.deb 2>/dev/null | head -1)
        names+=("${file:+/packages/}${file:-$name}")
    done
    inside apt-get -q update && inside env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends -o APT::Keep-Downloaded-Packages=true install "${names[@]}" &&
        find "$machine/var/cache/apt/archives" -maxdepth 1 -name '*.deb' ! -name '*soterrain*' -exec cp -aln {} "$archives/" \;
}

only_packages() { ! inside sh -c 'command -v g++ || ls /usr/local/lib/*.so* /usr/local/include/*' 2>/dev/null | grep .; }

# draws_terrain PICTURE COMMAND...: COMMAND leaves the picture in the machine's /tmp.
draws_terrain() {
    local picture=$1
    shift
    rm -f "$pictures/$picture"
    inside "$@" && cp "$machine/tmp/$picture" "$pictures/" && bash "$here/../clients/is_terrain.sh" "$pictures/$picture"
}

in_window() { echo timeout 120 xvfb-run -a; }

client_tools() {
    check "tools: soterrain-tools installs" new_machine soterrain-tools soterrain-data libsoterrain0 libsimage-dev gnuplot-nox
    check "tools: nothing but packages" only_packages
    check "tools: SoTerrainTest draws the installed map" \
        draws_terrain tools.ppm SoTerrainTest -h terrain.png -t terrain_texture.jpg -c --offscreen=640x480 --output /tmp/tools.ppm
    check "tools: SoTerrainTest draws the installed scene" \
        draws_terrain scene.ppm SoTerrainTest --scene terrain.iv --offscreen=640x480 --output /tmp/scene.ppm
    check "tools: soterrain-bench compares nodes" inside soterrain-bench --map terrain.png --frames 2 --nodes SoROAMTerrain,SoChunkedLoDTerrain
    check "tools: soterrain-report writes a page" inside sh -c \
        'cd /tmp && soterrain-report terrain.png --quick --nodes SoROAMTerrain,SoQuadMesh -o report && grep -q "<svg" report/report.html'
    check "tools: soterrain-generate makes a map that SoTerrainTest draws" inside sh -c \
        'cd /tmp && soterrain-generate --size 129 --droplets 1000 --output made.png --texture made.jpg && SoTerrainTest -h made.png -t made.jpg --offscreen'
}

client_dev() {
    check "dev: libsoterrain-dev installs" new_machine libsoterrain-dev libsoterrain0 soterrain-data g++ make cmake pkg-config libegl-dev qtbase5-dev xvfb xauth libsimage-dev libepoxy-dev
    inside cp -r /usr/share/doc/libsoterrain-dev/examples /tmp/
    check "dev: the example for pkg-config draws" draws_terrain pkg-config.ppm sh -c \
        'make -C /tmp/examples/pkg-config && /tmp/examples/pkg-config/picture /usr/share/soterrain/terrain.png /tmp/pkg-config.ppm'
    check "dev: the example for CMake draws" draws_terrain cmake.ppm sh -c \
        'cd /tmp/examples/cmake && cmake -B build && cmake --build build && build/picture /usr/share/soterrain/terrain.png /tmp/cmake.ppm'
    check "dev: the example with Qt draws" draws_terrain qt.ppm sh -c \
        "cd /tmp/examples/qt && cmake -B build && cmake --build build && $(in_window) build/terrain-window /usr/share/soterrain/terrain.iv /tmp/qt.ppm"
    cp "$here/../clients/render.cpp" "$machine/tmp/"
    check "dev: a program that knows only Coin compiles" inside g++ -std=c++20 /tmp/render.cpp -o /tmp/render -lCoin -lepoxy
    cp "$machine/tmp/render" "$machine/tmp/examples/python/terrain.py" "$taken/" 2>/dev/null
}

client_coin() {
    [ -x "$taken/render" ] || { echo "SKIP: coin: the client dev compiles its program"; skipped=$((skipped + 1)); return; }
    check "coin: soterrain-modules installs" new_machine soterrain-modules soterrain-data libsoterrain0 libepoxy0 libegl1 libgl1 libsimage-dev
    check "coin: nothing but packages" only_packages
    cp "$taken/render" "$machine/tmp/"
    check "coin: a program that knows only Coin draws" draws_terrain coin.ppm soterrain-run /tmp/render /usr/share/soterrain/terrain.iv /tmp/coin.ppm
}

client_python() {
    [ -e "$taken/terrain.py" ] || { echo "SKIP: python: the client dev has the example"; skipped=$((skipped + 1)); return; }
    check "python: soterrain-modules and python3-pivy install" new_machine soterrain-modules soterrain-data libsoterrain0 python3-pivy libegl1 xvfb xauth imagemagick
    cp "$taken/terrain.py" "$machine/tmp/"
    check "python: the example draws without a display" draws_terrain python.ppm sh -c 'cd /tmp && python3 terrain.py --picture python.ppm'
    check "python: the example draws with modules by name" draws_terrain python_run.ppm sh -c 'cd /tmp && soterrain-run python3 terrain.py --picture python_run.ppm'
    check "python: the example opens a window" draws_terrain python_window.png timeout 120 xvfb-run -a -s "-screen 0 640x480x24" sh -c \
        'cd /tmp; python3 terrain.py & sleep 12; import -window root python_window.png; kill $!'
}

client_freecad() {
    check "freecad: soterrain-modules and FreeCAD install" new_machine soterrain-modules soterrain-data libsoterrain0 freecad-python3 xvfb xauth libsimage-dev
    cp "$here/../clients/freecad_picture.py" "$here/../clients/ROAM.iv" "$machine/tmp/"
    sed -n "/^<?xml/,/^<\/FCParameters/p" "$here/../clients/freecad.sh" >"$machine/tmp/user.cfg"
    freecad() { echo "cd $1 && SCENE=$2 PICTURE=/tmp/$3 $(in_window) freecad -u /tmp/user.cfg /tmp/freecad_picture.py"; }
    check "freecad: opens the installed scene" draws_terrain freecad.png sh -c "$(freecad /usr/share/soterrain terrain.iv freecad.png)"
    inside sh -c "$(freecad /tmp ROAM.iv freecad_roam.png)" >"$cache/freecad.txt" 2>/dev/null
    cp "$machine/tmp/freecad_roam.png" "$pictures/" 2>/dev/null
    check "freecad: shows the node and not its stand-in" grep -E 'red 0 green [1-9][0-9]{3}' "$cache/freecad.txt"
    rm -r "$machine/usr/share/freecad/Mod/SoTerrain"
    inside sh -c "$(freecad /tmp ROAM.iv none.png)" >"$cache/freecad.txt" 2>/dev/null
    check "freecad: shows the stand-in without the add-on" grep -E 'red [1-9][0-9]{3,} green 0' "$cache/freecad.txt"
    inside sh -c "$(freecad /tmp ROAM.iv run.png | sed 's/ freecad -u/ soterrain-run freecad -u/')" >"$cache/freecad.txt" 2>/dev/null
    check "freecad: shows the node under soterrain-run" grep -E 'red 0 green [1-9][0-9]{3}' "$cache/freecad.txt"
}

make_base
for client in $clients; do "client_$client"; done
echo "clean machines: $passed passed, $failed failed, $skipped skipped; pictures are in $pictures"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
