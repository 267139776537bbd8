#!/bin/bash
# Pictures of the mesh: by option without a display, by key in the window.
. "$(dirname "$0")/common.sh"
make_raw "$SCRATCH/map.raw"
map="-h $SCRATCH/map.raw -c -e 2"

# Each picture is another one, with its legend in the upper right corner.
for picture in none tiles levels errors loading; do
    EGL_PLATFORM=surfaceless expect 0 "$TEST" $map -a geomipmapping --debug-view $picture --offscreen=320x240 --output "$SCRATCH/$picture.ppm"
    for other in none tiles levels errors loading; do
        [ $other = $picture ] && break
        cmp -s "$SCRATCH/$picture.ppm" "$SCRATCH/$other.ppm" && fail "--debug-view $picture shows what $other shows"
    done
done
EGL_PLATFORM=surfaceless expect 0 "$TEST" $map --overlay --offscreen=320x240 --output "$SCRATCH/overlay.ppm"
EGL_PLATFORM=surfaceless expect 0 "$TEST" $map --offscreen=320x240 --output "$SCRATCH/plain.ppm"
cmp -s "$SCRATCH/overlay.ppm" "$SCRATCH/plain.ppm" && fail "--overlay shows nothing"
EGL_PLATFORM=surfaceless expect 0 "$TEST" $map --meters --offscreen=320x240 --output "$SCRATCH/meters.ppm"
cmp -s "$SCRATCH/meters.ppm" "$SCRATCH/plain.ppm" && fail "--meters shows nothing"
expect 2 "$TEST" $map --debug-view colours
grep -q 'expected one of none, tiles, levels, errors, loading, found "colours"' "$SCRATCH/err" || { fail "a wrong picture"; cat "$SCRATCH/err"; }
EGL_PLATFORM=surfaceless expect 0 "$TEST" $map -a quadmesh --debug-view tiles --offscreen=64x48 --output "$SCRATCH/other.ppm"
[ "$(grep -c -e '--debug-view.*no effect on quadmesh' "$SCRATCH/err")" = 1 ] || { fail "no word about a shape without pictures"; cat "$SCRATCH/err"; }

# Frozen, the mesh has as many triangles in all frames that follow: of an animation, and of a flight that is replayed.
EGL_PLATFORM=surfaceless expect 0 "$TEST" $map --frames 6 -A 6000 --record "$SCRATCH/flight.csv" --offscreen=64x48
for animation in "--frames 6 -A 6000" "--flight $SCRATCH/flight.csv --frames 6 -A 6000"; do
    EGL_PLATFORM=surfaceless expect 0 "$TEST" $map $animation --freeze-at 2500 -p "$SCRATCH/profile.csv" --offscreen=160x120
    column=$(head -1 "$SCRATCH/profile.csv" | tr ',' '\n' | grep -n '^triangles$' | cut -d: -f1)
    counts=$(tail -n +2 "$SCRATCH/profile.csv" | cut -d, -f"$column")
    [ "$(echo "$counts" | tail -n +3 | sort -u | wc -l)" = 1 ] || fail "--freeze-at lets the mesh change in $animation: "$counts
    [ "$(echo "$counts" | head -3 | sort -u | wc -l)" -gt 1 ] || fail "--freeze-at freezes too early in $animation: "$counts
done

. "$(dirname "$0")/display.sh"
open_window $map --no-settings
shot terrain
for key in F6 F7 F8 F9; do
    xdotool key $key
    shot $key
    moved terrain $key || fail "$key shows the terrain as it is"
done
moved F6 F7 && moved F7 F8 && moved F8 F9 || fail "two keys show the same picture"
xdotool key F5
shot again
same terrain again || fail "F5 does not show the terrain again"
xdotool key o
shot edges
moved terrain edges || fail "O shows no edges"
xdotool key o
xdotool key g
shot meters
moved terrain meters || fail "G shows no meters"
xdotool key g
xdotool key z
says frozen || fail "Z does not freeze: $(title)"
press s
press Left
shot outside
moved terrain outside || fail "no frozen mesh from elsewhere"
xdotool key z
sleep 1
title | grep -q frozen && fail "Z does not thaw"
close_window

# Without GLSL: one word about it, and pictures all the same.
MESA_GL_VERSION_OVERRIDE=2.1 open_window $map --no-settings --overlay
shot terrain
xdotool key F8
shot errors
moved terrain errors || fail "no errors without GLSL"
xdotool key w
sleep 0.5
told=$(grep -c "expected OpenGL 3.0 or newer, found 2.1; errors are shown triangle by triangle, edges are GL's own lines" "$SCRATCH/err")
[ "$told" = 2 ] || { fail "$told messages without GLSL, not one for each picture"; cat "$SCRATCH/err"; }
close_window
finish
