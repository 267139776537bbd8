#!/bin/bash
# Menus and dialogs of the window: files are opened, dropped and remembered; a bad one changes nothing.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/display.sh"
make_raw "$SCRATCH/map.raw"
cp "$SCRATCH/map.raw" "$SCRATCH/other map.raw"
{ printf 'P6\n2 2\n255\n'; printf '\377\0\0\0\377\0\0\0\377\377\377\0'; } >"$SCRATCH/colours.ppm"
printf 'no heights\n' >"$SCRATCH/bad.png"
head -c 12 /dev/zero >"$SCRATCH/oblong.raw"
cat >"$SCRATCH/scene.iv" <<'SCENE'
#Inventor V2.1 ascii
Separator {
    SoHeightMap { fields [ SFString filename, SFFloat heightScale ] filename "map.raw" heightScale 0.1 }
    SoGeoMipmapTerrain { fields [ SFFloat pixelError ] pixelError 3 }
}
SCENE

# choose TITLE FILE: types a file's name into a dialog.
choose() {
    find_dialog "$1"
    xdotool type --delay 5 "$2"
    sleep 0.3
    xdotool key Return
    sleep 0.5
    xdotool windowfocus "$window"
}

# Nothing to show: an invitation.
open_window
shot empty
says 'no terrain' || [ -e /usr/share/soterrain/terrain.png ] || fail "an empty window says: $(title)"
xdotool key ctrl+o
choose '^Open a terrain$' "$SCRATCH/map.raw"
says 'roam .*map.raw$' || fail "Ctrl+O does not open a height map: $(title)"
title | grep -q 'no culling' && fail "a map from the menu is drawn without culling"
shot map
moved empty map || fail "the opened map is not seen"
xdotool key ctrl+t
choose '^Open a texture$' "$SCRATCH/colours.ppm"
shot textured
moved map textured || fail "the texture is not seen"

# A bad file is told in one message, and the scene stays.
xdotool key ctrl+o
choose '^Open a terrain$' "$SCRATCH/bad.png"
find_dialog '^SoTerrainTest$'
xdotool key Return
sleep 0.5
xdotool windowfocus "$window"
[ "$(grep -c 'bad.png' "$SCRATCH/err")" = 1 ] || { fail "not one message about a bad file"; cat "$SCRATCH/err"; }
says 'roam .*map.raw$' || fail "a bad file takes the scene: $(title)"

xdotool key ctrl+o
choose '^Open a terrain$' "$SCRATCH/scene.iv"
says 'SoGeoMipmapTerrain .*of 3.00 px.*scene.iv$' || fail "a scene is not opened: $(title)"

# File > Open recent: the map before the scene, with its texture.
xdotool key alt+f
sleep 0.3
xdotool key Down key Right
sleep 0.3
xdotool key Down key Return
says 'roam .*map.raw$' || fail "the recent file is not opened: $(title)"
shot recent
moved textured recent && fail "a recent file comes without its texture"

xdotool key F1
find_dialog '^Keys of SoTerrainTest$'
xdotool key Escape
sleep 0.3
kill -0 $program || fail "Esc in a dialog ends the program"
close_window
grep -q 'other' "$SCRATCH/config/SoTerrain/SoTerrainTest.conf" && fail "a file that was not opened is remembered"
grep -q 'scene.iv' "$SCRATCH/config/SoTerrain/SoTerrainTest.conf" || fail "a file that was opened is not remembered"

# Number keys exchange the algorithm; the camera and the settings stay: the picture hardly changes.
open_window -h "$SCRATCH/map.raw" -t "$SCRATCH/colours.ppm" -c -e 0.5 --no-settings
press w
xdotool key plus
says 'of 0.62 px' || fail "no pixel error of 0.62: $(title)"
shot roam
press Tab
shot home
same roam home && fail "two views pass for the same"
press w
xdotool key plus key minus
shot roam
number=0
for name in bruteforce chunkedlod clipmap geomipmapping roam indexedfaceset quadmesh roam; do
    number=$((number + 1))
    [ $number = 8 ] && number=5
    xdotool key $number
    says "^SoTerrainTest: $name " || fail "key $number does not show $name: $(title)"
    shot $name
    same roam $name || fail "another picture with $name"
done
says 'of 0.62 px.*map.raw' || fail "the pixel error is lost on the way: $(title)"
title | grep -q culling && fail "culling is lost on the way"
close_window
open_window --scene "$SCRATCH/scene.iv" --no-settings
xdotool key 5
says 'SoROAMTerrain .*of 3.00 px' || fail "the node of a scene is not exchanged: $(title)"
xdotool key 7
sleep 0.5
title | grep -q SoROAMTerrain || fail "a scene without coordinates gets Coin's shape: $(title)"
close_window

# The settings act at once, and follow what keys change.
open_window -h "$SCRATCH/map.raw" -a clipmap --no-settings
xdotool key ctrl+comma
find_dialog '^Settings of SoTerrainTest$'
xdotool key alt+p ctrl+a type 7.5
xdotool key Return
says 'of 7.50 px' || fail "the dialog sets no pixel error: $(title)"
before=$(title)
xdotool key alt+m Home Down key Tab
for _ in $(seq 30); do [ "$(title)" != "$before" ] && break; sleep 0.1; done
[ "$(title)" != "$before" ] || fail "the dialog sets no clipmap size: $(title)"
xdotool key alt+a key End
says '^SoTerrainTest: quadmesh' || fail "the dialog does not exchange the algorithm: $(title)"
xdotool key alt+a key Home
says '^SoTerrainTest: bruteforce .*of 7.50 px' || fail "the dialog does not exchange the algorithm back: $(title)"
xdotool key Escape
sleep 0.3
close_window

# Pictures have the window's pixels, and no text; none takes the place of another.
program_path=$(realpath "$TEST")
TEST=$program_path
mkdir "$SCRATCH/pictures"
cd "$SCRATCH/pictures" || exit 99
open_window -h "$SCRATCH/map.raw" -f --no-settings
says 'px'
shot screen
xdotool key F12
says 'saved soterrain-0001' || fail "F12 saves no picture: $(title)"
xdotool key F12
says 'saved soterrain-0002' || fail "F12 saves no second picture: $(title)"
xdotool key ctrl+s
find_dialog '^Save the picture$'
xdotool key ctrl+a
xdotool type --delay 5 "$SCRATCH/pictures/mine.ppm"
sleep 0.3
xdotool key Return
sleep 0.5
xdotool windowfocus "$window"
says 'saved mine.ppm' || fail "Ctrl+S saves no picture: $(title)"
head -c 15 mine.ppm | tr '\n' ' ' | grep -q '^P6 1100 800 255' || fail "a picture of another size: $(head -c 15 mine.ppm)"
[ "$(find . -name 'soterrain-*' | wc -l)" = 2 ] || fail "other pictures than two: $(ls)"
tail -c 2640000 mine.ppm >"$SCRATCH/mine.ppm"
tail -c 2640000 "$SCRATCH/screen.ppm" >"$SCRATCH/seen.ppm"
same seen mine || fail "the picture is not what is seen"
[ "$(tail -c 200000 mine.ppm | od -An -v -t u1 -w3 | grep -c '255 255 255')" = 0 ] || fail "there is text in the picture"
[ "$(tail -c 200000 "$SCRATCH/screen.ppm" | od -An -v -t u1 -w3 | grep -c '255 255 255')" -gt 50 ] || fail "there is no text on the screen"
close_window
cd - >/dev/null || exit 99

# What was set is set the next time, unless files are named.
open_window
xdotool key ctrl+o
choose '^Open a terrain$' "$SCRATCH/map.raw"
says 'of 2.00 px' || fail "another pixel error than 2 at first: $(title)"
xdotool key plus
says 'of 2.50 px'
close_window
open_window
xdotool key ctrl+o
choose '^Open a terrain$' "$SCRATCH/map.raw"
says 'of 2.50 px' || fail "the pixel error is forgotten: $(title)"
close_window
open_window -h "$SCRATCH/map.raw"
says 'of 2.00 px' || fail "the command line does not say all: $(title)"
close_window

# A headerless file that is no square is asked about.
open_window -h "$SCRATCH/map.raw" -a bruteforce --no-settings
xdotool key ctrl+o
choose '^Open a terrain$' "$SCRATCH/oblong.raw"
find_dialog '^Size of a headerless file$'
xdotool key Return
sleep 0.3
xdotool windowfocus "$window"
says 'bruteforce .* 12 triangles .*oblong.raw' || fail "a file of 4 x 3 samples gives $(title)"
close_window

# On a display of high density the picture has as many pixels as its screen, and errors are measured in those.
triangles() { title | sed 's/.*fps *\([0-9]*\) triangles.*/\1/'; }
open_window -h "$SCRATCH/map.raw" -e 0.5 -f --no-settings
says 'of 0.50 px'
shot plain
plain=$(triangles)
close_window
QT_SCALE_FACTOR=2 open_window -h "$SCRATCH/map.raw" -e 0.5 -f --no-settings
says 'of 0.50 px'
shot dense
[ "$(triangles)" = "$plain" ] || fail "a dense display has $(triangles) triangles instead of $plain"
truncate -s 2300000 "$SCRATCH/plain.ppm" "$SCRATCH/dense.ppm"  # without the text at the bottom
same plain dense || fail "a dense display shows another picture"
close_window

# Files that are dropped on the window: a height map, then a picture, which becomes its texture.
# drop FILE: drags it from a window of its own, at the right edge of the screen.
drop() {
    "$SCRATCH/drag" "$1" 2>/dev/null &
    local source=$!
    for _ in $(seq 50); do xdotool search --onlyvisible --name '^drag source$' >/dev/null 2>&1 && break; sleep 0.1; done
    sleep 0.5
    xdotool mousemove 1060 40 mousedown 1
    local place
    for place in "1050 60" "800 300" "500 400" "505 405"; do
        sleep 0.3
        # shellcheck disable=SC2086
        xdotool mousemove $place
    done
    sleep 0.5
    xdotool mouseup 1
    sleep 1
    kill $source
    wait $source 2>/dev/null
}
# shellcheck disable=SC2046
if ${CXX:-g++} -fPIC -o "$SCRATCH/drag" "$SOURCE/tests/apps/drag.cpp" $(pkg-config --cflags --libs Qt5Widgets) 2>/dev/null; then
    open_window -h "$SCRATCH/map.raw" -c --no-settings
    cp "$SCRATCH/map.raw" "$SCRATCH/dropped.raw"
    drop "$SCRATCH/dropped.raw"
    says 'dropped.raw$' || fail "a dropped height map is not shown: $(title)"
    shot plain
    drop "$SCRATCH/colours.ppm"
    shot coloured
    says 'dropped.raw$' || fail "a dropped picture takes the terrain: $(title)"
    same plain coloured && fail "a dropped picture is not the texture"
    xdotool windowfocus "$window"
    close_window
else
    echo "nothing is dropped: no compiler for Qt programs"
fi

# A run that is measured remembers nothing, nor does one without settings.
cp "$SCRATCH/config/SoTerrain/SoTerrainTest.conf" "$SCRATCH/before"
expect 0 timeout 60 "$TEST" -h "$SCRATCH/other map.raw" --frames 3 --stats
open_window -h "$SCRATCH/other map.raw" --no-settings
close_window
cmp "$SCRATCH/config/SoTerrain/SoTerrainTest.conf" "$SCRATCH/before" || fail "a run without settings changes them"
finish
