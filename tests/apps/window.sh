#!/bin/bash
# The window: it opens, flies, obeys its keys and ends; a profile can be taken in it.
. "$(dirname "$0")/common.sh"
make_raw "$SCRATCH/map.raw"
. "$(dirname "$0")/display.sh"

open_window -h "$SCRATCH/map.raw" -a quadmesh
sleep 1
shot home
[ "$(od -An -v -t u1 -w3 -j 16 "$SCRATCH/home.ppm" | sort -u | wc -l)" -gt 50 ] || fail "the window shows no terrain"
last=home
for key in w s a d q e Left Right Up Down Prior Next l; do
    press $key
    shot "$key"
    moved "$last" "$key" || fail "key $key changes nothing"
    last=$key
done
press l
press Tab
shot back
moved home back && fail "Tab does not lead home"
xdotool mousedown 1 mousemove 600 400 mouseup 1
shot looked
moved back looked || fail "the mouse does not look around"
press space
sleep 0.6
title | grep -q 'constant height' || fail "Space keeps no height"
xdotool keydown alt key Return keyup alt
sleep 1
xdotool getwindowgeometry "$window" | grep -q 1100x800 || fail "Alt+Enter gives no full screen"
kill -0 $program 2>/dev/null || fail "the program ended by itself"
xdotool key Escape
for _ in $(seq 50); do kill -0 $program 2>/dev/null || break; sleep 0.1; done
kill -0 $program 2>/dev/null && { fail "Esc does not quit"; kill $program; }
status=0
wait $program || status=$?
[ $status = 0 ] || fail "exit status $status after Esc"

# Keys that change a terrain node are seen in its title.
"$TEST" -h "$SCRATCH/map.raw" -a roam -e 2 >/dev/null 2>"$SCRATCH/err" &
program=$!
find_window '^SoTerrainTest: roam .*px'
sleep 0.5
title | grep -q 'no culling' || fail "culling is on without -c"
xdotool key f && sleep 0.6
title | grep -q 'no culling' && fail "F does not switch culling"
xdotool key KP_Add && sleep 0.6
title | grep -q 'of 2.50 px' || fail "keypad + does not raise the pixel error: $(title)"
xdotool key KP_Subtract && sleep 0.6
title | grep -q 'of 2.00 px' || fail "keypad - does not lower the pixel error: $(title)"
xdotool key Return && sleep 0.6
title | grep -q 'full detail' || fail "Enter does not show full detail"
xdotool key Return && sleep 0.6
title | grep -q 'of 2.00 px' || fail "Enter does not go back: $(title)"
xdotool key Escape
wait $program || fail "exit status $? of roam"

# Fewer and more levels of a clipmap.
"$TEST" -h "$SCRATCH/map.raw" -a clipmap --clipmap-size 15 -e 0 >/dev/null 2>"$SCRATCH/err" &
program=$!
find_window '^SoTerrainTest: clipmap .*px'
triangles() {
    sleep 0.8
    title | sed 's/.*fps *\([0-9]*\) triangles.*/\1/'
}
all=$(triangles)
xdotool key bracketleft
fewer=$(triangles)
[ "$fewer" -lt "$all" ] || fail "[ leaves $fewer triangles of $all"
xdotool key bracketright
[ "$(triangles)" = "$all" ] || fail "] does not bring the level back"
xdotool key bracketleft key bracketleft
[ "$(triangles)" -lt "$fewer" ] || fail "a second [ leaves no level out"
xdotool key 0
[ "$(triangles)" = "$all" ] || fail "0 does not give back the choice of levels"
xdotool key Escape
wait $program || fail "exit status $? of clipmap"

# However long a mesh takes to converge, the title ends with the figures of the last frame, and then nothing is drawn any more.
LC_ALL=C awk 'BEGIN { srand(1); for (i = 0; i < 129 * 129; ++i) printf "%c", 65 + int(60 * rand()) }' >"$SCRATCH/rough.raw"
cat >"$SCRATCH/slow.iv" <<'SCENE'
#Inventor V2.1 ascii
Separator {
    SoHeightMap { fields [ SFString filename ] filename "rough.raw" }
    SoROAMTerrain { fields [ SFFloat pixelError, SFInt32 operationCount ] pixelError 50 operationCount 100 }
}
SCENE
"$TEST" --scene "$SCRATCH/slow.iv" -p "$SCRATCH/slow.csv" >/dev/null 2>"$SCRATCH/err" &
program=$!
find_window '^SoTerrainTest: .*of 50.00 px'
sleep 1
xdotool key Return
sleep 1
last=
same=0
for _ in $(seq 120); do
    now=$(title)
    [ "$now" = "$last" ] && same=$((same + 1)) || same=0
    [ $same = 6 ] && break
    last=$now
    sleep 0.5
done
xdotool key Escape
wait $program || fail "exit status $? of a slow mesh"
drawn=$(tail -1 "$SCRATCH/slow.csv" | LC_ALL=C awk -F, '{ printf "%d triangles   error %.2f of 0.00 px", $7, $9 }')
[[ $now == *"$drawn"* ]] || fail "the last frame has $drawn, the title says: $now"
[[ $drawn == *'error 0.00 of'* ]] || fail "the mesh did not converge: $drawn"
rested=$(cut -d, -f7,9 "$SCRATCH/slow.csv" | uniq -c | awk 'END { print $1 }')
[ "$rested" -le 6 ] || fail "a picture at rest was drawn $rested times"

# R records, P replays once and leaves a profile.
program_path=$(realpath "$TEST")
(cd "$SCRATCH" && exec "$program_path" -h map.raw -a roam >/dev/null 2>replay.err) &
program=$!
find_window '^SoTerrainTest: roam .*px'
sleep 0.5
xdotool key r && press w && xdotool key r && sleep 0.6
title | grep -q 'recorded soterrain-flight.csv' || fail "R records nothing: $(title)"
xdotool key p
for _ in $(seq 100); do grep -q 'profile in soterrain-replay.csv' "$SCRATCH/replay.err" && break; sleep 0.1; done
sleep 0.6
title | grep -q 'played, profile in soterrain-replay.csv' || fail "P does not say where its profile is: $(title)"
[ "$(wc -l <"$SCRATCH/soterrain-replay.csv")" -ge 3 ] || fail "the profile of the replay has no frames"
xdotool key Escape
wait $program || fail "exit status $? after the replay"

# An animation that is profiled ends by itself.
expect 0 timeout 60 "$TEST" -h "$SCRATCH/map.raw" -a quadmesh -v -s -A 1000 -F 100 -p "$SCRATCH/p.csv"
expect 0 timeout 60 "$TEST" -h "$SCRATCH/map.raw" -a roam --frames 3 --stats
grep -q '"frames": 3,' "$SCRATCH/out" || fail "--frames 3 gives $(grep '"frames"' "$SCRATCH/out")"
rows=$(wc -l <"$SCRATCH/p.csv")
[ "$rows" -ge 3 ] && [ "$rows" -le 11 ] || fail "the profile of a second in the window has $rows lines"
finish
