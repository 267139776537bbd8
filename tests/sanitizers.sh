#!/bin/bash
# Usage: sanitizers.sh SOURCE BUILD [KIND...]. Builds the project in BUILD/sanitize-KIND for KIND, which is `address` (with undefined) or
# `thread`, both by default, and runs every test there. Ends with a line for each and fails if any test did, if any sanitizer had something to
# report, or if nothing ran. TESTS="tests/test_lod" runs only those.
set -u
source=$1 build=$2
shift 2
[ $# -gt 0 ] || set -- address thread

unset MAKEFLAGS MFLAGS MAKELEVEL
reports='ERROR: (Address|Leak)Sanitizer|WARNING: ThreadSanitizer|runtime error:'

run() (
    kind=$1 list=$1 folder=$build/sanitize-$1 failed=0
    [ "$kind" != address ] || list=address,undefined
    mkdir -p "$folder" && cd "$folder" || exit 1
    if [ ! -f config.status ]; then
        # shellcheck disable=SC2086
        "$source/configure" -q --enable-sanitizers="$list" CC="$CC" CXX="$CXX" CXXFLAGS="-O1 -g1" ${SANITIZERS_CONFIGURE-} \
            >configure.log 2>&1 ||
            { rm -f config.status; tail -n 5 configure.log; exit 1; }
    fi
    jobs=-j${SANITIZERS_JOBS-$(nproc)}
    make "$jobs" all >build.log 2>&1 && make "$jobs" check TESTS= >>build.log 2>&1 || { tail -n 20 build.log; exit 1; }
    find tests -name '*.trs' -delete
    start=$SECONDS
    # What is instrumented takes several times as long; -k: a program that fails must not keep the others from running.
    make -k "$jobs" check TEST_TIMEOUT="${TEST_TIMEOUT-5400}" ${TESTS+TESTS="$TESTS"} >check.log 2>&1
    line=$(bash "$source/tests/totals.sh" tests) || failed=1
    echo "sanitizers $list: $line, in $(((SECONDS - start + 59) / 60)) minutes"
    while read -r result; do
        log=${result%.trs}.log
        grep -hE '^\[  SKIPPED \] .* ms\)$|^SKIP|^skipped:' "$log" | sed 's/^/    /'
        grep -qE "$reports" "$log" || continue
        failed=1
        echo "    $folder/$log: $(grep -m 1 -E "$reports" "$log" | cut -c 1-150)"
    done < <(find tests -name '*.trs' | sort)
    exit $failed
)

status=0
for kind in "$@"; do run "$kind" || status=1; done
exit $status
