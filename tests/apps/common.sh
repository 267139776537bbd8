# What the tests of whole programs share: SOURCE and BUILD folders, a scratch folder, and checks that count failures.
SOURCE=${SOTERRAIN_SRCDIR:-${top_srcdir:-.}}
BUILD=${SOTERRAIN_BUILDDIR:-${top_builddir:-.}}
TEST=$BUILD/SoTerrainTest
SCRATCH=$(mktemp -d) || exit 99
trap 'rm -rf "$SCRATCH"' EXIT
failures=0

fail() {
    echo "FAIL: $*"
    failures=$((failures + 1))
}

skip() {
    echo "SKIP: $*"
    exit 77
}

finish() {
    [ "$failures" = 0 ] && echo "all checks passed" && exit 0
    echo "$failures checks failed"
    exit 1
}

# expect STATUS COMMAND...: runs it; output goes to $SCRATCH/out and $SCRATCH/err
expect() {
    local wanted=$1 status=0
    shift
    "$@" >"$SCRATCH/out" 2>"$SCRATCH/err" || status=$?
    [ "$status" = "$wanted" ] || { fail "exit status $status instead of $wanted: $*"; cat "$SCRATCH/err"; }
}

# A map of 65x65 samples in 8 bits, waves in two directions, as binary PGM: needs no library to be read or written.
make_map() {
    { printf 'P5\n65 65\n255\n'; LC_ALL=C awk 'BEGIN { for (y = 0; y < 65; ++y) for (x = 0; x < 65; ++x)
        printf "%c", 66 + int(60 * sin(x / 7) * cos(y / 9)) }'; } >"$1"
}

# make_raw FILE: the same samples without a header
make_raw() {
    make_map "$SCRATCH/with-header.pgm" && tail -c 4225 "$SCRATCH/with-header.pgm" >"$1"
}
