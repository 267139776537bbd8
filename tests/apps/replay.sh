#!/bin/bash
# A recorded flight has the same triangles in every frame, whenever, wherever and after whatever it is flown; -s keeps -A.
. "$(dirname "$0")/common.sh"
make_raw "$SCRATCH/map.raw"
export EGL_PLATFORM=surfaceless
expect 0 "$TEST" -h "$SCRATCH/map.raw" -a roam --offscreen=64x48 -v --frames 24 --record "$SCRATCH/flight.csv"
grep -q 'offscreen rendering' "$SCRATCH/err" && skip "no EGL with desktop OpenGL"

# A rough map, a flight that ends far from where it begins, and as many tiles and updates as take their time: whatever was drawn
# before would show.
LC_ALL=C awk 'BEGIN { srand(3); for (i = 0; i < 257 * 257; ++i) printf "%c", 65 + int(40 * rand()) }' >"$SCRATCH/rough.raw"
{ head -1 "$SCRATCH/flight.csv"; sed -n '2p;8p;14p' "$SCRATCH/flight.csv"; } >"$SCRATCH/jump.csv"
write_scene() {
    echo "#Inventor V2.1 ascii
        Separator { SoHeightMap { fields [ SFString filename, SFVec2f spacing, SFFloat heightScale ]
            filename \"rough.raw\" spacing 0.0039 0.0039 heightScale 0.0003 } $1 }" >"$SCRATCH/$2.iv"
}
write_scene 'SoROAMTerrain { fields [ SFFloat pixelError, SFInt32 operationCount ] pixelError 4 operationCount 40 }' roam
write_scene 'SoChunkedLoDTerrain { fields [ SFFloat pixelError, SFInt32 tileSize ] pixelError 2 tileSize 8 }' chunkedlod
write_scene 'SoGeoMipmapTerrain { fields [ SFFloat pixelError ] pixelError 4 }' geomipmapping
write_scene 'SoGeometryClipmapTerrain { fields [ SFInt32 clipmapSize, SFInt32 updateBudget ] clipmapSize 31 updateBudget 60 }' clipmap
write_scene 'SoGeometryClipmapTerrain { fields [ SFFloat pixelError, SFInt32 clipmapSize ] pixelError 8 clipmapSize 0 }' smallest
write_scene 'SoBruteForceTerrain { fields [ SFFloat pixelError ] }' bruteforce

# triangles FILE: that column of a profile
triangles() { cut -d, -f7 "$1"; }

# same NAME FILE OTHER: both have the same triangles, and rows at all
same() {
    [ "$(wc -l <"$2")" -gt 5 ] || fail "$1: $2 has no frames"
    cmp -s <(triangles "$2") <(triangles "$3") || fail "$1: other triangles in $(basename "$3") than in $(basename "$2")"
}

for scene in roam chunkedlod geomipmapping clipmap smallest bruteforce; do
    fly=("$TEST" --scene "$SCRATCH/$scene.iv" --offscreen=240x180 --flight "$SCRATCH/jump.csv" -A 800)
    expect 0 "${fly[@]}" -p "$SCRATCH/$scene-once.csv"
    expect 0 "${fly[@]}" -p "$SCRATCH/$scene-three.csv" --repeat 3 --stats --summary "$SCRATCH/$scene-summary.csv"
    grep -q '"same_in_all": true' "$SCRATCH/out" || fail "$scene: other triangles in another repetition"
    grep -q '"repetitions": 3,' "$SCRATCH/out" || fail "$scene: --repeat 3 is not three flights"
    same $scene "$SCRATCH/$scene-once.csv" "$SCRATCH/$scene-three.csv"
    [ $scene = bruteforce ] || [ "$(triangles "$SCRATCH/$scene-once.csv" | sort -u | wc -l)" -gt 6 ] || fail "$scene: no detail changes"
    [ "$(wc -l <"$SCRATCH/$scene-summary.csv")" = 2 ] || fail "$scene: --summary has not two lines"
done

# Means, and the least and the most time of each frame.
head -1 "$SCRATCH/roam-three.csv" | grep -q 'resident_bytes,frame_ms_min,frame_ms_max,cpu_ms$' || fail "header of means: $(head -1 "$SCRATCH/roam-three.csv")"
LC_ALL=C awk -F, 'NR > 1 && !($11 <= $3 && $3 <= $12 && $11 < $12 && $13 > 0) { exit 1 }' "$SCRATCH/roam-three.csv" || fail "a mean beyond its bounds"
expect 0 "$TEST" -h "$SCRATCH/map.raw" --offscreen=64x48 --frames 4 --repeat 2 --summary "$SCRATCH/s.json"
for key in fps cpu_ms resident_bytes renderer settings pixelError size_px; do grep -q "\"$key\"" "$SCRATCH/s.json" || fail "--summary s.json lacks $key"; done
expect 2 "$TEST" -h "$SCRATCH/map.raw" --offscreen --repeat 3
expect 2 "$TEST" -h "$SCRATCH/map.raw" --offscreen -v -s --repeat 3
expect 2 "$TEST" -h "$SCRATCH/map.raw" --offscreen --flight "$SCRATCH/jump.csv" --record "$SCRATCH/jump.csv"

# value KEY: of animation_ms
value() { sed -n "/\"animation_ms\"/,/}/s/.*\"$1\": \([0-9.]*\).*/\1/p" "$SCRATCH/out"; }

# keeps_time NAME STEP COMMAND...: an animation of 1000 ms in steps of STEP is off by no more than one frame, and the program was not shorter
keeps_time() {
    local name=$1 step=$2 start elapsed
    shift 2
    start=$(date +%s%N)
    expect 0 timeout 100 "$@" -v -s -A 1000 -F "$step" --stats -p "$SCRATCH/s.csv"
    elapsed=$((($(date +%s%N) - start) / 1000000))
    echo "$name, -F $step: $(value lasted) of $(value wanted) ms in $(($(wc -l <"$SCRATCH/s.csv") - 1)) frames, the longest $(value longest_frame) ms; program $elapsed ms"
    LC_ALL=C awk -v wanted="$(value wanted)" -v lasted="$(value lasted)" -v longest="$(value longest_frame)" -v step="$step" -v program=$elapsed 'BEGIN {
        frame = longest > step ? longest : step; off = lasted - wanted; if (off < 0) off = -off
        exit !(wanted == 1000 && off <= frame && lasted <= program) }' || fail "$name, -F $step: the animation is not within one frame of -A"
    [ "$elapsed" -ge 1000 ] || fail "$name, -F $step: the program took $elapsed ms"
}
# Two million triangles a frame, on llvmpipe a quarter of a second or more.
LC_ALL=C awk 'BEGIN { for (y = 0; y < 1025; ++y) for (x = 0; x < 1025; ++x) printf "%c", 66 + (x * y) % 60 }' >"$SCRATCH/big.raw"
for step in 1 40 300; do keeps_time "light, offscreen" $step "$TEST" -h "$SCRATCH/map.raw" -a roam --offscreen=160x120; done
for step in 1 40; do keeps_time "slow, offscreen" $step "$TEST" -h "$SCRATCH/big.raw" -a bruteforce --offscreen=1920x1080; done

# In the window.
for tool in Xvfb xdotool; do command -v $tool >/dev/null || finish; done
unset WAYLAND_DISPLAY QT_QPA_PLATFORM EGL_PLATFORM
export XDG_RUNTIME_DIR=$SCRATCH XDG_CONFIG_HOME=$SCRATCH/config
Xvfb -displayfd 3 -screen 0 1920x1080x24 -nolisten tcp 3>"$SCRATCH/display" >/dev/null 2>&1 &
server=$!
trap 'kill $server 2>/dev/null; wait $server 2>/dev/null; rm -rf "$SCRATCH"' EXIT
for _ in $(seq 100); do [ -s "$SCRATCH/display" ] && break; sleep 0.1; done
[ -s "$SCRATCH/display" ] || finish
DISPLAY=:$(cat "$SCRATCH/display")
export DISPLAY
"$TEST" -h "$SCRATCH/map.raw" --frames 1 --stats >/dev/null 2>"$SCRATCH/err" || { grep -q 'without SoQt' "$SCRATCH/err" && finish; }

for scene in roam chunkedlod clipmap; do
    fly=("$TEST" --scene "$SCRATCH/$scene.iv" --flight "$SCRATCH/jump.csv" -A 800)
    expect 0 timeout 100 "${fly[@]}" -p "$SCRATCH/$scene-window.csv"
    expect 0 timeout 100 "${fly[@]}" -p "$SCRATCH/$scene-window-two.csv" --repeat 2 --stats
    grep -q '"same_in_all": true' "$SCRATCH/out" || fail "$scene in the window: other triangles in another repetition"
    same "$scene in the window" "$SCRATCH/$scene-window.csv" "$SCRATCH/$scene-window-two.csv"
done
keeps_time "light, window" 1 "$TEST" -h "$SCRATCH/map.raw" -a roam
keeps_time "slow, window" 40 "$TEST" -h "$SCRATCH/big.raw" -a bruteforce -f

# By keys: R records, P replays, Shift+P takes means of five; nothing takes the place of what was there.
mkdir "$SCRATCH/folder"
program_path=$(realpath "$TEST")
cp "$SCRATCH/roam.iv" "$SCRATCH/rough.raw" "$SCRATCH/folder"
(cd "$SCRATCH/folder" && exec "$program_path" --scene roam.iv >/dev/null 2>keys.err) &
program=$!
window=
for _ in $(seq 100); do
    window=$(xdotool search --onlyvisible --name '^SoTerrainTest: .*px' 2>/dev/null | tail -1)
    [ -n "$window" ] && break
    sleep 0.1
done
[ -n "$window" ] || fail "no window with a status line"
xdotool windowfocus "$window" mousemove 500 400
# wait_for FILE: until it is there
wait_for() {
    for _ in $(seq 300); do [ -s "$SCRATCH/folder/$1" ] && return; sleep 0.1; done
    fail "no $1; $(xdotool getwindowname "$window")"
}
# record KEY: flies while it is held
record() {
    xdotool key r && sleep 0.2 && xdotool keydown "$1" && sleep 0.7 && xdotool keyup "$1" && sleep 0.2 && xdotool key r
}
sleep 0.5
record w
wait_for soterrain-flight.csv
first=$(cksum <"$SCRATCH/folder/soterrain-flight.csv")
record Left
wait_for soterrain-flight-2.csv
[ "$(cksum <"$SCRATCH/folder/soterrain-flight.csv")" = "$first" ] || fail "the second record takes the place of the first"
xdotool key p
wait_for soterrain-replay.csv
press_on() { xdotool keydown "$1" && sleep 0.3 && xdotool keyup "$1" && sleep 0.3; }
press_on d
xdotool key p
wait_for soterrain-replay-2.csv
press_on q
xdotool key shift+p
wait_for soterrain-benchmark.json
sleep 0.6
xdotool key Escape
wait $program || fail "exit status $? after the replays"
cd "$SCRATCH/folder" || exit 99
same "P twice" soterrain-replay.csv soterrain-replay-2.csv
same "P and five repetitions" soterrain-replay.csv soterrain-benchmark.csv
grep -q '"repetitions": 5,' soterrain-benchmark.json || fail "five repetitions are $(grep repetitions soterrain-benchmark.json)"
grep -q '"same_in_all": true' soterrain-benchmark.json || fail "other triangles in another of five repetitions"
[ "$(wc -l <soterrain-benchmark-summary.csv)" = 2 ] || fail "no summary of five repetitions"
cd / || exit 99
finish
