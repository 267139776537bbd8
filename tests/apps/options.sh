#!/bin/bash
# Wrong command lines end with 2 and usage on standard error, bad data with 1 and one message.
. "$(dirname "$0")/common.sh"
export -n DISPLAY WAYLAND_DISPLAY QT_QPA_PLATFORM
make_raw "$SCRATCH/map.raw"

for line in "" "-x" "-h" "-h m -a magic" "-h m -e nan" "-h m -e -1" "-h m -r -1" "-h m -r 1.5" "-h m -g 0" "-h m -A 0" "-h m -F x" \
    "-h m --offscreen=0x0" "-h m --frames 0" "-h m --spacing 0" "-h m stray" "-h m --output a.png" "--scene s -h m" "-h m --channel -1" "-h m --raw-size 65" \
    "-h m --raw-type float"; do
    # shellcheck disable=SC2086
    expect 2 "$TEST" $line
    grep -q '^Usage: SoTerrainTest' "$SCRATCH/err" || fail "no usage on standard error: $line"
    [ -s "$SCRATCH/out" ] && fail "standard output of a wrong line: $line"
done

expect 2 "$TEST" -h m -a magic
for name in bruteforce chunkedlod geomipmapping roam indexedfaceset quadmesh; do grep -q "$name" "$SCRATCH/err" || fail "-a does not list $name"; done

expect 0 "$TEST" --help
for word in -h -t -p -a -A -F -e -r -g -f -c -v -s --scene --offscreen --output --frames --flight --record --spacing --height-scale \
    --channel --raw-size --raw-type --measure-error --stats --help --version; do
    grep -q -e "$word" "$SCRATCH/out" || fail "--help does not tell about $word"
done
expect 0 "$TEST" --version
grep -Eq '^SoTerrainTest [0-9]+\.[0-9]+' "$SCRATCH/out" || fail "--version prints no version"

printf 'nonsense' >"$SCRATCH/bad.png"
printf 'time_ms,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,oops\n' >"$SCRATCH/bad.csv"
printf 'no scene\n' >"$SCRATCH/bad.iv"
message() {
    [ "$(grep -c SoTerrainTest: "$SCRATCH/err")" = 1 ] || { fail "not one message: $1"; cat "$SCRATCH/err"; }
    grep -q "$1" "$SCRATCH/err" || { fail "the message does not name $1"; cat "$SCRATCH/err"; }
}
expect 1 "$TEST" -h "$SCRATCH/none.png" --offscreen && message none.png
expect 1 "$TEST" -h "$SCRATCH/bad.png" --offscreen && message bad.png
expect 1 "$TEST" -h "$SCRATCH/map.raw" -t "$SCRATCH/none.jpg" --offscreen && message none.jpg
expect 1 "$TEST" -h "$SCRATCH/map.raw" --flight "$SCRATCH/none.csv" --offscreen && message none.csv
expect 1 "$TEST" -h "$SCRATCH/map.raw" --flight "$SCRATCH/bad.csv" --offscreen && message bad.csv:2
expect 1 "$TEST" -h "$SCRATCH/map.raw" -p "$SCRATCH/no/p.csv" --offscreen && message p.csv
expect 1 "$TEST" --scene "$SCRATCH/none.iv" --offscreen && message none.iv
printf '#Inventor V2.1 ascii\nSeparator { SoHeightMap { filename "none.png" } SoROAMTerrain {} }\n' >"$SCRATCH/hollow.iv"
expect 1 "$TEST" --scene "$SCRATCH/hollow.iv" --offscreen && message none.png
expect 1 "$TEST" -h "$SCRATCH/map.raw" --raw-size 66x65 --offscreen && message map.raw
expect 1 "$TEST" -h "$SCRATCH/map.raw" --offscreen --output "$SCRATCH/no/frame.ppm" && message frame.ppm

# A window without a display is a message, not an abort.
expect 1 env -u DISPLAY -u WAYLAND_DISPLAY -u QT_QPA_PLATFORM "$TEST" -h "$SCRATCH/map.raw"
grep -q -e --offscreen "$SCRATCH/err" || fail "no hint to --offscreen without a display"
expect 1 env -u WAYLAND_DISPLAY -u QT_QPA_PLATFORM DISPLAY=:4711 "$TEST" -h "$SCRATCH/map.raw"
grep -q -e --offscreen "$SCRATCH/err" || fail "no hint to --offscreen with a display that is not there"
finish
