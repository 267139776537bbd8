#!/bin/bash
# Usage: triangles.sh BUILD [MAP]      measures triangles against the error on screen on one flight over MAP, or the shipped terrain, into triangles.csv
#        triangles.sh                  draws triangles.svg from it (gnuplot)
set -eu
cd "$(dirname "$0")"

# row NAME OPTION...: mean triangles, and the largest error that was measured
row() {
    local name=$1 stats
    shift
    stats=$("$test" -h "$map" -c -v --offscreen=1024x768 --frames 40 --measure-error 4 --stats "$@")
    python3 -c 'import json, sys
stats = json.loads(sys.argv[2])
print(sys.argv[1], stats["measured_error_px"]["max"], stats["triangles"]["mean"], sep=",")' "$name" "$stats"
}

if [ $# -gt 0 ]; then
    test=$(cd "$1" && pwd)/SoTerrainTest
    map=${2-../../data/terrain.png}
    export EGL_PLATFORM=${EGL_PLATFORM-surfaceless} LD_LIBRARY_PATH=$(cd "$1" && pwd)/modules
    {
        echo "node,error_px,triangles"
        for error in 0.5 1 2 4 8; do
            row SoROAMTerrain -a roam -e $error
            row SoChunkedLoDTerrain -a chunkedlod -e $error
            row SoGeoMipmapTerrain -a geomipmapping -e $error
        done
        for size in 511 255 127 63; do row SoGeometryClipmapTerrain -a clipmap -e 0 --clipmap-size $size; done
    } >triangles.csv
fi
gnuplot <<'PLOT'
set terminal svg size 760,420 font "DejaVu Sans,13" background "white"
set output "triangles.svg"
set datafile separator ","
set logscale xy
set xlabel "largest error on screen that was measured, pixels"
set ylabel "triangles, mean of the flight"
set xtics (0.25, 0.5, 1, 2, 4, 8, 16, 32)
set format y "%'.0f"
set grid lc rgb "#dddddd"
set key top right
plot for [node in "SoGeometryClipmapTerrain SoGeoMipmapTerrain SoChunkedLoDTerrain SoROAMTerrain"] \
    "< grep ^".node.", triangles.csv | sort -t, -k2 -g" using 2:3 with linespoints lw 2 pt 7 ps 0.6 title node
PLOT
