#!/bin/bash
# Usage: totals.sh FOLDER. Sums the results that `make check` and `make installcheck` left under FOLDER into one line,
# "N passed, N failed", with ", N skipped" where any was. A GoogleTest program counts by its cases, a shell test as one, a program that
# died or failed outside its cases as one more failure. Fails if anything failed or nothing passed.
shopt -s nullglob globstar
passed=0 failed=0 skipped=0

for result in "$1"/**/*.trs; do
    log=${result%.trs}.log
    ok=0 bad=0 skip=0
    if [ -f "$log" ] && grep -q '^\[==========\] Running' "$log"; then
        ok=$(grep -c '\[       OK \] .* ms)$' "$log")
        bad=$(grep -c '\[  FAILED  \] .* ms)$' "$log")
        skip=$(grep -c '\[  SKIPPED \] .* ms)$' "$log")
        grep -q '\[==========\] .* ran\.' "$log" || bad=$((bad + 1))
        if [ "$bad" -eq 0 ] && grep -q '^:test-result: \(FAIL\|ERROR\|XPASS\)' "$result"; then bad=1; fi
    else
        ok=$(grep -c '^:test-result: PASS' "$result")
        bad=$(grep -c '^:test-result: \(FAIL\|ERROR\|XPASS\)' "$result")
        skip=$(grep -c '^:test-result: SKIP' "$result")
    fi
    passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + skip))
done

line="$passed passed, $failed failed"
[ "$skipped" -eq 0 ] || line+=", $skipped skipped"
echo "$line"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
