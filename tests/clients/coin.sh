#!/bin/bash
# A program that links Coin and nothing of ours draws scenes with our nodes from modules/, and their stand-ins without.
set -u
. "$SOTERRAIN_SRCDIR/tests/clients/common.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sanitize=()
[ "${SOTERRAIN_SANITIZERS:-no}" = no ] || sanitize=(-fsanitize="$SOTERRAIN_SANITIZERS")
# shellcheck disable=SC2086
$CXX -std=c++20 "${sanitize[@]}" ${CLIENT_CFLAGS-} "$clients/render.cpp" -o "$work/render" ${CLIENT_LIBS--lCoin -lepoxy} || exit 1
if ldd "$work/render" | grep -i soterrain; then
    echo "the client links our library"
    exit 1
fi
draws coin "$work/render"
exit $failed
