# What the tests of windows share, after common.sh: a display of their own, windows, keys and pictures of them. SCREEN may ask for a size.
for tool in Xvfb xdotool import convert; do command -v $tool >/dev/null || skip "$tool is missing"; done
unset WAYLAND_DISPLAY QT_QPA_PLATFORM EGL_PLATFORM
export XDG_RUNTIME_DIR=$SCRATCH XDG_CONFIG_HOME=$SCRATCH/config
chmod 700 "$SCRATCH"

Xvfb -displayfd 3 -screen 0 "${SCREEN:-1100x800}x24" -nolisten tcp 3>"$SCRATCH/display" >/dev/null 2>&1 &
server=$!
program=
trap 'kill $program $server 2>/dev/null; wait $program $server 2>/dev/null; rm -rf "$SCRATCH"' EXIT
for _ in $(seq 100); do [ -s "$SCRATCH/display" ] && break; sleep 0.1; done
[ -s "$SCRATCH/display" ] || skip "Xvfb does not start"
DISPLAY=:$(cat "$SCRATCH/display")
export DISPLAY

# find_window TITLE: waits for $program's window, gives it the focus and leaves its id in $window, empty when it does not come.
find_window() {
    window=
    for _ in $(seq 100); do
        window=$(xdotool search --onlyvisible --name "$1" 2>/dev/null | tail -1)
        [ -n "$window" ] && break
        kill -0 $program 2>/dev/null || return
        sleep 0.1
    done
    [ -z "$window" ] || xdotool windowfocus "$window" mousemove 500 400
}

# open_window ARGUMENT...: starts SoTerrainTest as $program and waits for its window and for its first text.
open_window() {
    "$TEST" "$@" >"$SCRATCH/out" 2>"$SCRATCH/err" &
    program=$!
    find_window '^SoTerrainTest: '
    [ -n "$window" ] && return
    grep -q 'without SoQt' "$SCRATCH/err" && skip "this build has no SoQt"
    cat "$SCRATCH/err"
    fail "no window: $*"
    finish
}

# close_window: Esc, and a good exit status.
close_window() {
    local status=0
    xdotool windowfocus "$window" key Escape
    for _ in $(seq 50); do kill -0 $program 2>/dev/null || break; sleep 0.1; done
    kill -0 $program 2>/dev/null && { fail "Esc does not quit"; kill $program; }
    wait $program || status=$?
    program=
    [ $status = 0 ] || fail "exit status $status after Esc"
}

# find_dialog TITLE: waits for another window of the program and gives it the focus; its id is in $dialog.
find_dialog() {
    dialog=
    for _ in $(seq 50); do
        dialog=$(xdotool search --onlyvisible --name "$1" 2>/dev/null | tail -1)
        [ -n "$dialog" ] && break
        sleep 0.1
    done
    if [ -n "$dialog" ]; then
        xdotool windowfocus "$dialog"
        sleep 0.3
    else
        fail "no dialog named $1"
    fi
}

title() { xdotool getwindowname "$window"; }

# says PATTERN: the title matches it within 10 seconds.
says() {
    for _ in $(seq 100); do
        title | grep -q -e "$1" && return
        sleep 0.1
    done
    return 1
}

shot() {
    sleep 1
    import -silent -window root "$SCRATCH/$1.png"
    convert "$SCRATCH/$1.png" -depth 8 "$SCRATCH/$1.ppm"
}

# moved A B: the two screens differ by more than the status line
moved() {
    [ "$(cmp -l "$SCRATCH/$1.ppm" "$SCRATCH/$2.ppm" | wc -l)" -gt 20000 ]
}

# same A B: few values of the two screens differ by much
same() {
    [ "$(cmp -l "$SCRATCH/$1.ppm" "$SCRATCH/$2.ppm" |
        awk '{ a = int($2 / 100) * 64 + int($2 / 10) % 10 * 8 + $2 % 10; b = int($3 / 100) * 64 + int($3 / 10) % 10 * 8 + $3 % 10
               if (a - b > 40 || b - a > 40) ++n } END { print n + 0 }')" -lt 20000 ]
}

press() {
    xdotool keydown "$1"
    sleep 0.5
    xdotool keyup "$1"
}
