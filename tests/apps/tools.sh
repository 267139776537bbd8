#!/bin/bash
# The height tools: from the command line, and by clicks in the window.
. "$(dirname "$0")/common.sh"
export EGL_PLATFORM=surfaceless
# Rises by 1 from sample to sample to the east; samples are 2 apart, heights half as high: a slope of 1 in 4, to the west.
LC_ALL=C awk 'BEGIN { for (y = 0; y < 101; ++y) for (x = 0; x < 101; ++x) printf "%c", 20 + x }' >"$SCRATCH/ramp.raw"
ramp=("$TEST" -h "$SCRATCH/ramp.raw" --spacing 2 --height-scale 0.5)

# No picture is needed for an answer, so none for a machine without GL either.
expect 0 "${ramp[@]}" --offscreen --pick 100,60 --pick 100,300 --marker 20,30,Hut --profile-line 20,50,180,50 --line-out "$SCRATCH/line.csv"
said() { grep -q "$1" "$SCRATCH/out" || { fail "no '$1'"; cat "$SCRATCH/out"; }; }
said '^pick: x 100.00, y 60.00, height 35.00, slope 14.0° to 270° W$'
said '^pick: x 100.00, y 300.00: outside of the map$'
said '^marker Hut: x 20.00, y 30.00, height 15.00'
said '^line: ground 164.92, horizontal 160.00, climb 40.00, descent 0.00, steepest 14.0°, heights 15.00 to 55.00$'
[ "$(head -1 "$SCRATCH/line.csv")" = distance,x,y,height ] || fail "header of the profile"
tail -1 "$SCRATCH/line.csv" | grep -q '^160,180,50,55$' || fail "end of the profile: $(tail -1 "$SCRATCH/line.csv")"
expect 0 "${ramp[@]}" --offscreen --profile-line 300,50,400,50
said 'no ground under the line'
for wrong in '--pick 1' '--pick 1,2,3' '--profile-line 1,2' '--profile-line 1,2,3' '--marker x,y' '--line-out l.csv'; do
    # shellcheck disable=SC2086
    expect 2 "${ramp[@]}" --offscreen $wrong
done

# All algorithms, and scenes of any kind, give the same answers.
for algorithm in bruteforce chunkedlod clipmap geomipmapping quadmesh; do
    expect 0 "${ramp[@]}" -a $algorithm --offscreen --pick 100,60 --profile-line 20,50,180,50
    said '^pick: x 100.00, y 60.00, height 35.00, slope 14.0° to 270° W$'
    said '^line: ground 164.92, '
done
cat >"$SCRATCH/kit.iv" <<'SCENE'
#Inventor V2.1 ascii
Separator { Translation { translation 1000 0 5 } Scale { scaleFactor 3 3 3 }
    SoTerrainKit { fields [ SFNode heightMap ] heightMap SoHeightMap { fields [ SFString filename, SFVec2f spacing, SFFloat heightScale ]
        filename "ramp.raw" spacing 2 2 heightScale 0.5 } } }
SCENE
expect 0 "$TEST" --scene "$SCRATCH/kit.iv" --offscreen --pick 100,60
said '^pick: x 100.00, y 60.00, height 35.00, slope 14.0° to 270° W$'

# A georeferenced map has the coordinates of its file.
cat >"$SCRATCH/map.asc" <<'GRID'
ncols 3
nrows 3
xllcenter 500000
yllcenter 4649000
cellsize 10
1 2 3
1 2 3
1 2 3
GRID
expect 0 "$TEST" -h "$SCRATCH/map.asc" --offscreen --pick 15,5
grep -q 'GDAL\|unknown format\|no reader' "$SCRATCH/err" || said 'E 500015.00, N 4649005.00'

# In pictures: the yellow line and the red pin.
expect 0 "${ramp[@]}" --offscreen=160x120 --output "$SCRATCH/plain.ppm"
if grep -q 'offscreen rendering' "$SCRATCH/err"; then finish; fi
expect 0 "${ramp[@]}" --offscreen=160x120 --output "$SCRATCH/tools.ppm" --marker 100,140,Hut --profile-line 60,150,150,180
[ "$(cmp -l "$SCRATCH/plain.ppm" "$SCRATCH/tools.ppm" | wc -l)" -gt 100 ] || fail "a picture without line and marker"

# In the window.
for tool in Xvfb xdotool import; do command -v $tool >/dev/null || finish; done
unset WAYLAND_DISPLAY QT_QPA_PLATFORM EGL_PLATFORM
export XDG_RUNTIME_DIR=$SCRATCH XDG_CONFIG_HOME=$SCRATCH/config
Xvfb -displayfd 3 -screen 0 1100x900x24 -nolisten tcp 3>"$SCRATCH/display" >/dev/null 2>&1 &
server=$!
trap 'kill $server 2>/dev/null; wait $server 2>/dev/null; rm -rf "$SCRATCH"' EXIT
for _ in $(seq 100); do [ -s "$SCRATCH/display" ] && break; sleep 0.1; done
[ -s "$SCRATCH/display" ] || finish
DISPLAY=:$(cat "$SCRATCH/display")
export DISPLAY
timeout 100 "${ramp[@]}" -c --no-settings --pick 100,60 >"$SCRATCH/out" 2>"$SCRATCH/err" &
program=$!
window=
for _ in $(seq 100); do
    window=$(xdotool search --onlyvisible --name '^SoTerrainTest: .*px' 2>/dev/null | tail -1)
    [ -n "$window" ] && break
    kill -0 $program 2>/dev/null || break
    sleep 0.1
done
if [ -z "$window" ]; then
    grep -q 'without SoQt' "$SCRATCH/err" && finish
    fail "no window"
    finish
fi
said '^pick: x 100.00, y 60.00, height 35.00'
mkdir -p "$BUILD/tests/pictures"
shot() {
    sleep 1
    import -silent -depth 8 -window root "$SCRATCH/$1.ppm"
    [ -z "${2-}" ] || import -silent -window root "$BUILD/tests/pictures/$2.png"
}
# differs A B: more than the status bar
differs() { [ "$(cmp -l "$SCRATCH/$1.ppm" "$SCRATCH/$2.ppm" | wc -l)" -gt "${3:-2000}" ]; }
click() { xdotool mousemove "$1" "$2" && sleep 0.3 && xdotool click 1 && sleep 0.6; }
sleep 1
xdotool windowfocus "$window" mousemove 400 300
shot first
xdotool keydown ctrl && click 700 500 && xdotool keyup ctrl
shot picked
differs first picked || fail "Ctrl+click shows nothing"
xdotool mousemove 500 400 mousedown 1 mousemove 530 400 mousemove 560 400 mouseup 1
shot looked
differs picked looked 50000 || fail "dragging does not look around"
xdotool key m && sleep 0.3 && click 300 470 && click 640 380 && click 420 330
shot measured tools_measured
differs looked measured 100000 || fail "no profile after a line of three corners"
xdotool mousemove 600 740
shot cursor tools_cursor
differs measured cursor 200 || fail "the profile has no cursor"
xdotool key n && sleep 0.3 && click 620 420
sleep 0.6
xdotool type Hut && xdotool key Return && sleep 0.6
xdotool windowfocus "$window"
shot marked tools_marked
differs cursor marked 500 || fail "no marker"
xdotool key 2
shot switched tools_switched
xdotool key Delete
shot cleared
differs switched cleared 500 || fail "Del clears nothing"
xdotool key ctrl+q
for _ in $(seq 50); do kill -0 $program 2>/dev/null || break; sleep 0.1; done
kill -0 $program 2>/dev/null && { fail "Ctrl+Q does not quit"; kill $program; }
wait $program || fail "exit status $? of the window"
[ -s "$SCRATCH/err" ] && grep -v XDG_RUNTIME_DIR "$SCRATCH/err" | grep -q . && fail "$(cat "$SCRATCH/err")"
finish
