#!/bin/bash
# The report measures every node as the benchmark does, its page, CSV and JSON agree, and it fails without leaving anything.
. "$(dirname "$0")/common.sh"
REPORT=$BUILD/soterrain-report
make_map "$SCRATCH/map.pgm"
command -v gnuplot >/dev/null || skip "no gnuplot"
command -v python3 >/dev/null || skip "no python3"

# One message each, and no folder.
none() { # none STATUS PATTERN ARGUMENT...
    local status=$1 pattern=$2
    shift 2
    expect "$status" "$REPORT" "$@" -o "$SCRATCH/none"
    grep -q -- "$pattern" "$SCRATCH/err" || { fail "no message about $pattern: $*"; cat "$SCRATCH/err"; }
    [ "$status" = 2 ] || [ "$(wc -l <"$SCRATCH/err")" = 1 ] || { fail "more than one message: $*"; cat "$SCRATCH/err"; }
    [ ! -e "$SCRATCH/none" ] || { fail "something is left: $*"; rm -rf "$SCRATCH/none"; }
}
expect 0 "$REPORT" --help
expect 2 "$REPORT" "$SCRATCH/map.pgm"
none 2 'expected a map'
none 2 'bad value "0"' "$SCRATCH/map.pgm" --frames 0
none 2 'bad value "nan"' "$SCRATCH/map.pgm" -e nan
none 1 "$SCRATCH/no.png: expected" "$SCRATCH/no.png"
echo 'no picture' >"$SCRATCH/no-picture.png"
none 1 "$SCRATCH/no-picture.png: expected" "$SCRATCH/map.pgm" -t "$SCRATCH/no-picture.png"
none 1 "$SCRATCH/no-picture.png:1: expected" "$SCRATCH/map.pgm" --flight "$SCRATCH/no-picture.png"
mkdir "$SCRATCH/bin"
printf '#!/bin/sh\nexit 127\n' >"$SCRATCH/bin/gnuplot"
chmod +x "$SCRATCH/bin/gnuplot"
path=$PATH
PATH=$SCRATCH/bin:$PATH
none 1 'gnuplot: expected this program' "$SCRATCH/map.pgm"
PATH=$path
expect 1 "$REPORT" "$SCRATCH/map.pgm" -o "$SCRATCH/map.pgm/folder"
grep -q "expected a folder that can be written" "$SCRATCH/err" || fail "no message about the folder"
expect 1 "$REPORT" "$SCRATCH/map.pgm" --quick --nodes SoNoSuchNode -o "$SCRATCH/none"
grep -q "SoNoSuchNode is not measured: SoNoSuchNode: expected" "$SCRATCH/err" && [ ! -e "$SCRATCH/none" ] || fail "a report of nothing"

# A class that is none has a row that says so, and the page comes; the others are as the benchmark measures them.
nodes=SoIndexedFaceSet,SoQuadMesh,SoBruteForceTerrain,SoROAMTerrain,SoChunkedLoDTerrain,SoGeoMipmapTerrain,SoGeometryClipmapTerrain
expect 1 "$REPORT" "$SCRATCH/map.pgm" --quick --nodes "$nodes,SoNoSuch<Node" -o "$SCRATCH/report"
grep -q 'offscreen rendering' "$SCRATCH/err" && skip "no EGL with desktop OpenGL"
grep -qE '^ *[0-9]+ of [0-9]+ .*about [0-9:]+ left' "$SCRATCH/err" || fail "no progress"
expect 0 "$BUILD/soterrain-bench" --map "$SCRATCH/map.pgm" --frames 12 --error-every 4 --nodes "$nodes" --json "$SCRATCH/bench.json"
python3 "$SOURCE/tests/apps/report.py" "$SCRATCH/report" "$SCRATCH/bench.json" || fail "the report is not what it should be"
[ "$(ls -A "$SCRATCH/report")" = "report.csv
report.html
report.json" ] || fail "other files are in the folder: $(ls -A "$SCRATCH/report")"

# Interrupted: nothing is written, a former report stays, no process stays.
before=$(cksum "$SCRATCH/report/"*)
"$REPORT" "$SCRATCH/map.pgm" --quick -o "$SCRATCH/report" >"$SCRATCH/out" 2>"$SCRATCH/err" &
running=$!
for _ in $(seq 100); do
    grep -q ' 2 of' "$SCRATCH/err" && break
    sleep 0.1
done
kill -TERM $running
wait $running
[ $? = 130 ] || fail "exit status of an interrupted report"
[ "$before" = "$(cksum "$SCRATCH/report/"*)" ] && [ "$(ls -A "$SCRATCH/report" | wc -l)" = 3 ] || fail "an interrupted report leaves something"
ps -eo args | grep -F "$SCRATCH/map.pgm" | grep -vq grep && fail "a process is left"

# The page in a browser, at two widths.
if command -v chromium >/dev/null && command -v convert >/dev/null; then
    for width in 1280 400; do
        timeout 60 chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$SCRATCH/chromium" \
            --screenshot="$SCRATCH/page.png" --window-size=$width,2400 "file://$SCRATCH/report/report.html" >/dev/null 2>&1
        colors=$(convert "$SCRATCH/page.png" -format %k info: 2>/dev/null)
        [ "${colors:-0}" -gt 500 ] || fail "the page at a width of $width has ${colors:-no} colours"
    done
fi
finish
