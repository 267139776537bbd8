#!/bin/bash
# Usage: fuzz.sh SOURCE BUILD SECONDS FUZZER... Builds the fuzzers in BUILD/fuzz, for libFuzzer where there is a clang that has it, and runs
# them for SECONDS in all. Ends with a line for each: runs, coverage, and `clean` or the file that makes it fail. Inputs that reach new
# code stay in BUILD/fuzz/corpus and are begun with the next time. FUZZ_CXX=clang++-16 takes that one, FUZZ_CXX=g++ does without libFuzzer.
set -u
source=$1 build=$2 seconds=$3
shift 3
folder=$build/fuzz
options=${FUZZ_CONFIGURE-}
unset MAKEFLAGS MFLAGS MAKELEVEL
case $CXX in *ccache\ *) cache="ccache " ;; *) cache= ;; esac
mkdir -p "$folder" && cd "$folder" || exit 1

clang() {
    local candidate probe
    probe=$(mktemp -d)
    trap 'rm -rf "$probe"' RETURN
    echo '#include <cstdint>
#include <cstddef>
extern "C" int LLVMFuzzerTestOneInput(const uint8_t*, size_t) { return 0; }' >"$probe/probe.cpp"
    for candidate in ${FUZZ_CXX-$(echo clang++ clang++-{20..14})}; do
        "$candidate" -fsanitize=fuzzer,address,undefined "$probe/probe.cpp" -o "$probe/probe" 2>/dev/null || continue
        echo "$candidate"
        return
    done
}

if [ ! -f config.status ]; then
    cxx=$(clang)
    if [ -n "$cxx" ]; then
        set_up=(--enable-fuzzer --enable-sanitizers "CXX=$cache$cxx" "CC=$cache${cxx/++/}")
    else
        echo "fuzz: no clang with libFuzzer, so inputs are changed without regard to what they reach (Debian: clang)"
        set_up=(--enable-sanitizers "CXX=$CXX" "CC=$CC")
    fi
    # shellcheck disable=SC2086
    "$source/configure" -q "${set_up[@]}" CXXFLAGS="-O1 -g" $options >configure.log 2>&1 ||
        { tail -n 5 configure.log; rm -f config.status; exit 1; }
fi
make -s -j"${FUZZ_JOBS-$(nproc)}" "$@" >build.log 2>&1 || { tail -n 20 build.log; exit 1; }

export ASAN_OPTIONS="allocator_may_return_null=1:${ASAN_OPTIONS-}"
export LSAN_OPTIONS="suppressions=$source/tests/lsan.supp:print_suppressions=0"
export UBSAN_OPTIONS="print_stacktrace=1"
export EGL_PLATFORM="${EGL_PLATFORM-surfaceless}" LIBGL_ALWAYS_SOFTWARE="${LIBGL_ALWAYS_SOFTWARE-1}"
mkdir -p artifacts
failed=0 lines=()
for program in "$@"; do
    name=${program##*fuzz_}
    share=$((seconds / $#))
    # What a header promises OpenEXR allocates before it reads on: only memory that is used counts. And which library leaked tells only
    # the slow way through the stack, because those of other people have no frame pointers.
    case $name in files) allocation=4096 unwind=0 ;; *) allocation=1024 unwind=1 ;; esac
    [ "$share" -gt 0 ] || share=1
    mkdir -p "corpus/$name"
    dictionary=$source/tests/fuzz/$name.dict
    rm -f "artifacts/$name-"*
    ASAN_OPTIONS="fast_unwind_on_malloc=$unwind:$ASAN_OPTIONS" SOTERRAIN_FUZZ_SEEDS=$PWD/corpus/$name nice -n "${FUZZ_NICE-0}" "./$program" -max_total_time="$share" -timeout=10 -rss_limit_mb=2048 \
        -malloc_limit_mb=$allocation -print_final_stats=1 -max_len=8192 -artifact_prefix="$PWD/artifacts/$name-" \
        $([ -f "$dictionary" ] && echo "-dict=$dictionary") "corpus/$name" >"$name.log" 2>&1
    status=$?
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$name.log" | tail -n 1)
    coverage=$(sed -n 's/.* cov: \([0-9]*\) ft.*/\1/p' "$name.log" | tail -n 1)
    result=clean
    if [ $status -ne 0 ]; then
        failed=1
        result=$(find "$PWD/artifacts" -name "$name-*" | head -n 1)
        result="FAILED: $(grep -m 1 -E '^==fuzz==|ERROR: |runtime error:' "$name.log" | cut -c 1-160) (${result:-no input kept}, $PWD/$name.log)"
    fi
    lines+=("$name: ${runs:-?} runs in $share s, ${coverage:-unknown} edges covered, $result")
done
printf 'fuzz %s\n' "${lines[@]}"
exit $failed
