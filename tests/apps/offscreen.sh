#!/bin/bash
# Without a display: pictures, profile, statistics, flights and measured errors.
. "$(dirname "$0")/common.sh"
unset DISPLAY WAYLAND_DISPLAY
make_raw "$SCRATCH/map.raw"
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a quadmesh --offscreen=64x48 --output "$SCRATCH/probe.ppm"
grep -q 'offscreen rendering' "$SCRATCH/err" && skip "no EGL with desktop OpenGL"

# colors FILE: number of different pixel values in a PPM
colors() {
    tail -n +4 "$1" | od -An -v -t u1 -w3 | sort -u | wc -l
}

for algorithm in bruteforce chunkedlod geomipmapping roam indexedfaceset quadmesh; do
    expect 0 "$TEST" -h "$SCRATCH/map.raw" -a "$algorithm" -c --offscreen=160x120 -v --frames 6 --output "$SCRATCH/$algorithm-%02d.ppm" \
        -p "$SCRATCH/$algorithm.csv" --stats --measure-error 2 --record "$SCRATCH/$algorithm-flight.csv"
    for i in 00 01 02 03 04 05; do
        [ -s "$SCRATCH/$algorithm-$i.ppm" ] || { fail "$algorithm: no picture $i"; continue; }
        [ "$(colors "$SCRATCH/$algorithm-$i.ppm")" -gt 20 ] || fail "$algorithm: picture $i shows no terrain"
    done
    head -1 "$SCRATCH/$algorithm.csv" | grep -qx \
        frame,time_ms,frame_ms,select_ms,upload_ms,draw_ms,triangles,patches,error_px,resident_bytes || fail "$algorithm: profile header"
    [ "$(wc -l <"$SCRATCH/$algorithm.csv")" = 7 ] || fail "$algorithm: not one row for every frame"
    awk -F, 'NF != 10 { exit 1 }' "$SCRATCH/$algorithm.csv" || fail "$algorithm: rows without ten columns"
    [ "$(cut -d, -f1 "$SCRATCH/$algorithm.csv" | tail -n +2 | tr '\n' ' ')" = "0 1 2 3 4 5 " ] || fail "$algorithm: frame numbers"
    [ "$(wc -l <"$SCRATCH/$algorithm-flight.csv")" = 7 ] || fail "$algorithm: recorded flight"
    for key in algorithm frames frame_ms median p95 worst triangles measured_error_px rms p999 max not_drawn renderer start_ms; do
        grep -q "\"$key\"" "$SCRATCH/out" || fail "$algorithm: --stats lacks $key"
    done
    grep -q '"not_drawn": 0' "$SCRATCH/out" || { fail "$algorithm: samples were not drawn"; cat "$SCRATCH/out"; }
    error=$(sed -n '/measured_error_px/,/}/s/.*"max": \([0-9.e-]*\).*/\1/p' "$SCRATCH/out")
    awk -v e="$error" 'BEGIN { exit !(e != "" && e <= 2.0) }' || fail "$algorithm: measured error $error px exceeds 2"
done

# Without anything else to write, one line tells about the frames.
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a roam --offscreen=64x48 --frames 3
[ "$(wc -l <"$SCRATCH/out")" = 1 ] && grep -Eq '^3 frames, median [0-9.]+ ms, mean [0-9]+ triangles, worst error bound [0-9.]+ px$' "$SCRATCH/out" ||
    fail "no line of figures: $(cat "$SCRATCH/out")"
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a roam --offscreen=64x48 --output "$SCRATCH/quiet.ppm"
[ -s "$SCRATCH/out" ] && fail "a line of figures beside --output"

# Tiles are built in the background, but nothing that is shown or measured may lack some: one frame is drawn until they are all
# there, and the frames of a flight wait for them where they are written.
bound() {
    sed -n 's/.*"bound_max": \([0-9.e-]*\).*/\1/p' "$SCRATCH/out"
}
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a chunkedlod -g 8 -e 0.5 -c --offscreen --stats
awk -v b="$(bound)" 'BEGIN { exit !(b != "" && b <= 0.5) }' || fail "one frame of chunkedlod was not complete: $(cat "$SCRATCH/out")"
grep -q '"unfinished_frames": 0' "$SCRATCH/out" || fail "--stats tells of unfinished frames: $(cat "$SCRATCH/out")"
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a chunkedlod -g 8 -e 0.5 -c --offscreen -v --frames 4 --output "$SCRATCH/tiles-%d.ppm" --stats
awk -v b="$(bound)" 'BEGIN { exit !(b != "" && b <= 0.5) }' || fail "frames of chunkedlod were not complete: $(cat "$SCRATCH/out")"
for algorithm in chunkedlod geomipmapping; do
    expect 0 "$TEST" -h "$SCRATCH/map.raw" -a "$algorithm" -g 8 -e 4 -c -v -s -A 300 -F 20 -p "$SCRATCH/tiles.csv" --offscreen=160x120 --stats
    [ "$(wc -l <"$SCRATCH/tiles.csv")" -gt 1 ] || fail "$algorithm: no frames with -s"
    grep -q '"unfinished_frames": [0-9]' "$SCRATCH/out" || fail "$algorithm: --stats does not tell how many frames were unfinished"
    [ -s "$SCRATCH/err" ] && fail "$algorithm: $(cat "$SCRATCH/err")"
done

# A headerless map that is no square, in 16 bits: 65 x 32 samples; its grid shows in the triangles of the quad mesh.
head -c 4160 "$SCRATCH/map.raw" >"$SCRATCH/wide.raw"
expect 0 "$TEST" -h "$SCRATCH/wide.raw" -a quadmesh --raw-size 65x32 --raw-type uint16le --offscreen=64x48
grep -q ' mean 3968 triangles' "$SCRATCH/out" || fail "--raw-size and --raw-type: $(cat "$SCRATCH/out")"
expect 0 "$TEST" -h "$SCRATCH/wide.raw" -a roam --raw-size 65x32 --raw-type uint16le --offscreen=64x48

# Detail grows as the error shrinks.
triangles() {
    expect 0 "$TEST" -h "$SCRATCH/map.raw" -a roam -e "$1" --offscreen --stats
    sed -n '/"triangles"/,/}/s/.*"mean": \([0-9.]*\).*/\1/p' "$SCRATCH/out"
}
awk -v fine="$(triangles 0.5)" -v coarse="$(triangles 8)" 'BEGIN { exit !(fine > 1.3 * coarse && coarse > 0) }' || fail "-e changes no detail"

# A recorded flight flown again shows the same pictures.
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a quadmesh --offscreen=160x120 --flight "$SCRATCH/quadmesh-flight.csv" --frames 6 \
    -F 1666.666667 --output "$SCRATCH/again-%02d.ppm"
cmp -s "$SCRATCH/quadmesh-03.ppm" "$SCRATCH/again-03.ppm" || fail "the recorded flight leads elsewhere"

# -s: exactly -A, frames skipped rather than delayed; without -s every frame.
start=$(date +%s%N)
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a quadmesh --offscreen -v -s -A 1500 -F 1 -p "$SCRATCH/s.csv"
elapsed=$((($(date +%s%N) - start) / 1000000))
[ "$elapsed" -ge 1500 ] || fail "-s took $elapsed ms of 1500"
[ "$(wc -l <"$SCRATCH/s.csv")" -lt 1500 ] || fail "-s skipped no frame of a millisecond"
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a quadmesh --offscreen=32x32 -v -A 100 -F 10 -p "$SCRATCH/every.csv"
[ "$(wc -l <"$SCRATCH/every.csv")" = 11 ] || fail "without -s not every frame was drawn"

# Fields that an algorithm lacks are named, and the program goes on.
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a roam -g 33 --offscreen
grep -q -e '-g has no effect on roam' "$SCRATCH/err" || fail "-g with roam is not mentioned"

# A scene file.
cat >"$SCRATCH/scene.iv" <<'SCENE'
#Inventor V2.1 ascii
Separator {
    SoHeightMap { filename "map.raw" spacing 0.0154 0.0154 heightScale 0.0008 }
    SoROAMTerrain { pixelError 1 }
}
SCENE
printf '#Inventor V2.1 ascii\nSeparator {\n  Cubee { }\n  Foo [ }\n' >"$SCRATCH/bad.iv"
expect 1 "$TEST" "$SCRATCH/bad.iv" --offscreen
grep -q "bad.iv: expected an Inventor scene, found .*Cubee" "$SCRATCH/err" || fail "a bad scene file does not say why: $(cat "$SCRATCH/err")"
expect 0 "$TEST" --scene "$SCRATCH/scene.iv" --offscreen=160x120 --output "$SCRATCH/scene.ppm" --stats
[ "$(colors "$SCRATCH/scene.ppm")" -gt 20 ] || fail "the scene file shows nothing"
grep -q '"SoROAMTerrain"' "$SCRATCH/out" || fail "the scene's terrain is not the one that is measured"

# PNG where this build can write it.
if expect 0 "$TEST" -h "$SCRATCH/map.raw" -a quadmesh --offscreen --output "$SCRATCH/p.png" && [ -s "$SCRATCH/p.png" ]; then
    [ "$(head -c 4 "$SCRATCH/p.png" | tail -c 3)" = PNG ] || fail "p.png is no PNG"
fi
finish
