#include "Options.h"

namespace app {

namespace {

const char* const optionHelp = R"(
Terrain
  FILE                      a scene if its name ends in .iv, else a height map
  -h, --heightmap FILE      height map: an image, a raster or a headerless .raw file
      --scene FILE.iv       show this scene file instead; its first terrain node is the one that is measured
  -t, --texture FILE        texture of the terrain
  -a, --algorithm NAME      what draws it, roam by default:
)";

const char* const moreHelp = R"(
      --spacing X[,Y]       distance between samples. Without it, and without a spacing in the file, the terrain
                            spans one unit in x and y
      --height-scale S      factor on the heights. Without it, 0..255 of an 8-bit map (0..65535 of a 16-bit map, lowest
                            to highest of a map with fractions) becomes 0..0.051; 1 with --spacing or a file's own spacing
      --channel N           channel of an image or raster that holds the heights, from 0; needed when there are three or more
      --raw-size WxH        columns and rows of a .raw file; without it, it is a square
      --raw-type TYPE       samples of a .raw file: uint8 (default), uint16le, uint16be

Level of detail
  -e, --pixel-error PX      greatest error on screen, in pixels (2)
  -r, --triangle-count N    most triangles; 0: no limit (roam)
  -g, --tile-size N         cells along the side of a tile (tiled algorithms)
      --clipmap-size N      vertices along the side of a level: 15, 31, ... 1023, 0: as the pixel error needs (clipmap)
      --levels N            levels, 0: as many as cover the map (clipmap)
      --detail N            levels of synthesised detail, finer than the map (clipmap)
  -c, --culling             switch frustum culling on. Without it a height map is drawn without culling; a scene file
                            keeps what it says

Pictures of the mesh
      --debug-view NAME     none, tiles (a colour of each), levels (yellow: full detail, ... violet: coarse), errors (blue: none,
                            ... red: the pixel error, magenta: more) or loading (orange: finer tiles are on their way)
      --overlay             the edges of the triangles over the terrain, or over one of these
      --meters              graphs of times, triangles, frames in a second and memory over the picture
      --freeze-at MS        keep the mesh from this time of the animation on, and draw the view that it was chosen for

Animation
  -v, --animate             play the animation: a circle over the terrain, or --flight. In a window it starts again at its
                            end, unless --frames, -p, --stats, --record or --measure-error wants an end: then the program ends too
      --flight FILE         fly along this CSV file: time_ms,x,y,z,qx,qy,qz,qw; linear between positions, spherical between
                            orientations. Implies -v. Without -s every frame has all of its tiles and, on every run, the
                            same triangles
      --record FILE         write the camera of every frame in the same format, in place of what FILE held
      --repeat N            fly N times, after once without measuring: -p, --stats and --summary give means
  -A, --animation-time MS   length of the animation (10000, or that of the flight, which is stretched to fit)
  -F, --frame-time MS       duration of a frame (40)
      --frames N            number of frames; without -F the whole animation is spread over them
  -s, --synchronize         the animation lasts exactly -A: frames that are late are skipped. Without it every frame is drawn

Output
  -p, --profile FILE        a CSV row for every frame: frame,time_ms,frame_ms,select_ms,upload_ms,draw_ms,triangles,
                            patches,error_px,resident_bytes; with --repeat means and frame_ms_min,frame_ms_max,cpu_ms
      --stats               a JSON object on standard output at the end
      --summary FILE        the same into a file whose name ends in .json, or a line of figures under one of names (CSV)
      --measure-error K     every K frames measure the error on screen of every sample in view
      --offscreen[=WxH]     no window and no display (1024x768). One frame, unless -v, --flight or --frames asks for more. Without
                            -p, --stats, --measure-error and --output it prints one line of figures
      --output NAME         write the frames of --offscreen: frame-%04d.png. They wait for tiles, and so do those of --measure-error

Height tools (by the full data, whatever is on screen; also in the picture)
      --pick X,Y            position, height, slope and where the ground falls to, on standard output. Again for more
      --profile-line X,Y,X,Y[,...]
                            lengths, climb, descent and steepest slope of this line over the ground
      --line-out FILE       write its profile as CSV: distance,x,y,height (and east,north of a georeferenced map)
      --marker X,Y[,NAME]   place a marker on the ground. Again for more

Window and program
  -f, --full-screen         start with a full screen
      --no-settings         neither use nor keep what the window remembers: its place, recent files, settings. A run that is measured
                            (--frames, -p, --stats, --record, --measure-error) never does
      --help, --version

Keys (the window's menus offer the same, and more)
  W S forward, back   A D left, right   Q E up, down   arrows turn   PgUp PgDn roll   mouse drag looks around   wheel: speed
  Keypad + -  pixel error         F  frustum culling      L  wireframe         Space  constant height over the ground
  Enter  detail on or off         Tab  camera home        R  record, stop      P  play the record, stop
  Shift+P  play it five times, and write means
  ] [  one level finer, coarser (clipmap)                 0  as many levels as the view needs (clipmap)
  G  graphs of what frames take
  F5 terrain   F6 tiles   F7 levels of detail   F8 errors   F9 loading   O  edges over it   Z  freeze the mesh, go on
  K  clicks show height and slope (Ctrl+click: always)    M  clicks measure a line
  N  clicks place markers         Ctrl+P  height profile of the line               Del  forget all of these
  Left Alt+Enter, F11  full screen                        Esc  quit             F1  all keys
  1 to 7  another algorithm, in the order of -a's list
  Ctrl+O  open a terrain          Ctrl+T  open a texture                     Ctrl+,  settings
  F12  save the picture to soterrain-0001.png, or the next free number              Ctrl+S  to a file of your choice

Without -h and --scene the window shows the installed terrain, or waits for a file: File > Open, or one that is dropped on it.
It then begins with the settings that it was left with, for what the command line does not say.

R writes soterrain-flight.csv; P replays the latest record, or else --flight, and writes its profile, as -p does, to
soterrain-replay.csv; Shift+P replays it five times, after once without measuring, and writes soterrain-benchmark.csv,
soterrain-benchmark-summary.csv and soterrain-benchmark.json. None takes the place of a file: the next is soterrain-flight-2.csv.

Files of -h, -t and --scene that are not where they are named are looked for among the installed ones: -h terrain.png,
-t terrain_texture.jpg, --scene terrain.iv.

Exit status: 0, 1 when data can't be read, drawn or written, 2 for a wrong command line.
)";

}  // namespace

std::string help() {
    std::string text = usage() + optionHelp;
    for (const Algorithm& algorithm : algorithms()) {
        std::string name(algorithm.name);
        name.resize(16, ' ');
        text += "                              " + name + std::string(algorithm.help) + "\n";
    }
    text.erase(text.size() - 1);
    return text + moreHelp;
}

}  // namespace app
