# Sourced by the tests of client programs. `draws PROGRAM... ` checks each scene with our nodes and without.
clients=$SOTERRAIN_SRCDIR/tests/clients
pictures=$SOTERRAIN_BUILDDIR/tests/pictures
modules=$SOTERRAIN_BUILDDIR/modules
mkdir -p "$pictures"
failed=0

# expect NAME COLOUR OTHER COMMAND...: the picture shows COLOUR, nothing of OTHER, and there is no GL error.
expect() {
    local name=$1 colour=$2 other=$3 output status
    shift 3
    output=$("$@" "$pictures/$name.ppm" 2>"$pictures/$name.err")
    status=$?
    if [ $status -eq 77 ]; then
        echo "$output"
        exit 77
    fi
    local shown=$(sed -n "s/.*$colour \([0-9]*\).*/\1/p" <<<"$output") hidden=$(sed -n "s/.*$other \([0-9]*\).*/\1/p" <<<"$output")
    if [ $status -ne 0 ] || [ "${shown:-0}" -lt 5000 ] || [ "${hidden:-1}" -ne 0 ] || [[ $output != *"GL error 0" ]]; then
        echo "$name: expected $colour, no $other and no GL error, found status $status, '$output'"
        cat "$pictures/$name.err"
        failed=1
    fi
    rm -f "$pictures/$name.err"
}

draws() {
    local kind=$1 scene
    shift
    for scene in BruteForce ROAM HeightMap Kit; do
        expect "client_${kind}_$scene" green red env LD_LIBRARY_PATH="$modules" "$@" "$clients/$scene.iv"
        expect "client_${kind}_${scene}_unknown" red green env -u LD_LIBRARY_PATH "$@" "$clients/$scene.iv"
    done
}
