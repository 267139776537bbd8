#!/bin/bash
# Uses the installed package as other people would: each header alone, a program by pkg-config, a program that knows Coin only, and the
# installed examples, which draw the installed terrain. With DESTDIR the package is not where it was configured for, as a moved one.
# `make installcheck` calls it. CXX, CXXFLAGS, COIN_LIBS, PKG_CONFIG, PC (the .pc file), STAGE (DESTDIR), PREFIX, LIBDIR, INCLUDEDIR,
# HEADERS, CLASSES, CONSUMERS (this folder), EXAMPLES, DATA and RESULTS (a file that gets a line per check) come from there.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$(dirname "$RESULTS")"
: >"$RESULTS"
failures=0

check() {
    local name=$1 result=PASS
    shift
    "$@" >"$work/log" 2>&1
    case $? in
        0) ;;
        77) result=SKIP; tail -1 "$work/log" ;;
        *) result=FAIL ;;
    esac
    if [ $result = FAIL ]; then
        failures=$((failures + 1))
        cat "$work/log"
    fi
    echo "$result: installcheck, $name"
    echo ":test-result: $result $name" >>"$RESULTS"
}

staged=()
[ -z "$STAGE" ] || staged=(--define-variable=libdir="$STAGE$LIBDIR" --define-variable=includedir="$STAGE$INCLUDEDIR")
package() { "$PKG_CONFIG" "${staged[@]}" "$@" "$PC"; }

compile() { $CXX -Wall -Wextra -Werror $CXXFLAGS $cflags "$@"; }

header_alone() {
    echo "#include <SoTerrain/$1>" >"$work/header.cpp"
    compile -fsyntax-only "$work/header.cpp"
}

by_pkg_config() {
    compile "$CONSUMERS/linked.cpp" -o "$work/linked" $libs && LD_LIBRARY_PATH=$libdir "$work/linked"
}

knows_only_coin() {
    $CXX $CXXFLAGS "$CONSUMERS/foreign.cpp" -o "$work/foreign" $COIN_LIBS &&
        LD_LIBRARY_PATH=$moduledir "$work/foreign" "$CONSUMERS/terrain.iv" SoROAMTerrain SoBruteForceTerrain
}

knows_all_classes() {
    local class
    for class in $CLASSES; do [ -e "$moduledir/$class.so" ] || { echo "no $moduledir/$class.so"; return 1; }; done
}

is_terrain() { bash "$CONSUMERS/../clients/is_terrain.sh" "$1"; }

# What Mesa and Qt leave is not ours to find.
run_example() { ASAN_OPTIONS=detect_leaks=0 LIBGL_ALWAYS_SOFTWARE="${LIBGL_ALWAYS_SOFTWARE-1}" LD_LIBRARY_PATH=$libdir "$@"; }

example_by_pkg_config() {
    cp -r "$EXAMPLES" "$work/examples" &&
        PKG_CONFIG_PATH=$(dirname "$PC") make -C "$work/examples/pkg-config" CXX="$CXX" CXXFLAGS="$CXXFLAGS" PKG_CONFIG="$PKG_CONFIG ${staged[*]}" &&
        run_example "$work/examples/pkg-config/picture" "$DATA/terrain.png" "$work/pkg-config.ppm" && is_terrain "$work/pkg-config.ppm"
}

# by_cmake EXAMPLE: builds it in $work/EXAMPLE
by_cmake() {
    command -v cmake >/dev/null || { echo "skipped: no cmake (Debian: cmake)"; return 77; }
    local compiler=${CXX#*ccache }
    cmake -S "$EXAMPLES/$1" -B "$work/$1" -DCMAKE_CXX_COMPILER="${compiler%% *}" -DCMAKE_CXX_FLAGS="$CXXFLAGS" -DCMAKE_PREFIX_PATH="$STAGE$PREFIX" &&
        cmake --build "$work/$1"
}

example_by_cmake() {
    by_cmake cmake || return
    run_example "$work/cmake/picture" "$DATA/terrain.png" "$work/cmake.ppm" && is_terrain "$work/cmake.ppm"
}

refuses_other_versions() {
    command -v cmake >/dev/null || { echo "skipped: no cmake (Debian: cmake)"; return 77; }
    mkdir "$work/later" &&
        printf '%s\n' 'cmake_minimum_required(VERSION 3.16)' 'project(later CXX)' 'find_package(SoTerrain 0.99)' \
            'if(SoTerrain_FOUND)' 'message(FATAL_ERROR "0.99 was found")' 'endif()' >"$work/later/CMakeLists.txt" &&
        cmake -S "$work/later" -B "$work/later/build" -DCMAKE_PREFIX_PATH="$STAGE$PREFIX"
}

example_with_qt() {
    "$PKG_CONFIG" --exists Qt5Widgets || { echo "skipped: no Qt (Debian: qtbase5-dev)"; return 77; }
    command -v xvfb-run >/dev/null || { echo "skipped: no xvfb-run (Debian: xvfb, xauth)"; return 77; }
    by_cmake qt || return
    run_example timeout 60 xvfb-run -a "$work/qt/terrain-window" "$DATA/terrain.iv" "$work/qt.ppm" && is_terrain "$work/qt.ppm"
}

cflags=$(package --cflags) && libs=$(package --libs) && libdir=$(package --variable=libdir) && moduledir=$(package --variable=moduledir) ||
    { echo ":test-result: FAIL pkg-config" >>"$RESULTS"; exit 1; }
for header in $HEADERS; do check "$(basename "$header") stands alone" header_alone "$(basename "$header")"; done
check "a program finds the library by pkg-config" by_pkg_config
check "a program that knows only Coin reads the nodes" knows_only_coin
check "every node class has its module" knows_all_classes
check "the example for pkg-config draws the terrain" example_by_pkg_config
check "the example for CMake draws the terrain" example_by_cmake
check "CMake refuses a version that is not this one" refuses_other_versions
check "the example with Qt draws the terrain" example_with_qt
exit $((failures > 0))
