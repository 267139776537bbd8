#!/bin/bash
# Uses the installed package as other people would: each header alone, a program by pkg-config, and a program that knows Coin only.
# `make installcheck` calls it. CXX, CXXFLAGS, COIN_LIBS, PKG_CONFIG, PC (the .pc file), STAGE (DESTDIR), LIBDIR, INCLUDEDIR,
# HEADERS, CONSUMERS (this folder) and RESULTS (a file that gets a line per check) come from there.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$(dirname "$RESULTS")"
: >"$RESULTS"
failures=0

check() {
    local name=$1 result=PASS
    shift
    "$@" >"$work/log" 2>&1 || result=FAIL
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

cflags=$(package --cflags) && libs=$(package --libs) && libdir=$(package --variable=libdir) && moduledir=$(package --variable=moduledir) ||
    { echo ":test-result: FAIL pkg-config" >>"$RESULTS"; exit 1; }
for header in $HEADERS; do check "$(basename "$header") stands alone" header_alone "$(basename "$header")"; done
check "a program finds the library by pkg-config" by_pkg_config
check "a program that knows only Coin reads the nodes" knows_only_coin
exit $((failures > 0))
