#!/bin/bash
# Usage: debug.sh BUILD      makes debug.jpg beside it, with SoTerrainTest of that build and ImageMagick
set -eu
pictures=$(cd "$(dirname "$0")" && pwd)
data=$pictures/../../data
build=$(cd "$1" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export EGL_PLATFORM=${EGL_PLATFORM-surfaceless} LD_LIBRARY_PATH=$build/modules

# scene NAME NODE OPTION...: draws $scratch/NAME.png, or the frames that the options ask for
scene() {
    cat >"$scratch/$1.iv" <<SCENE
#Inventor V2.1 ascii
Separator {
  PerspectiveCamera { position 150 40 160 orientation 1 -0.18 -0.06 1.25 nearDistance 1 farDistance 3000 heightAngle 0.7 }
  DirectionalLight { direction 0.5 0.5 -1 }
  Material { ambientColor 0.5 0.5 0.5 diffuseColor 1 1 1 }
  Texture2 { filename "$data/terrain_texture.jpg" }
  SoHeightMap { filename "$data/terrain.png" heightScale 0.0011 }
  $2
}
SCENE
    local name=$1
    shift 2
    "$build/SoTerrainTest" --scene "$scratch/$name.iv" --offscreen=480x360 --output "$scratch/$name-%d.png" --frames 1 "$@" >/dev/null
}

cat >"$scratch/away.csv" <<FLIGHT
time_ms,x,y,z,qx,qy,qz,qw
0,150,40,160,0.61252,-0.20232,-0.23966,0.72557
1000,600,-650,900,0.48370,0.00921,0.01666,0.87503
FLIGHT
cat >"$scratch/on.csv" <<FLIGHT
time_ms,x,y,z,qx,qy,qz,qw
0,150,40,100,0.572,-0.103,-0.0343,0.813
1000,190,200,80,0.572,-0.103,-0.0343,0.813
FLIGHT

scene edges "SoROAMTerrain { pixelError 3 }" --overlay
scene tiles "SoChunkedLoDTerrain { }" --debug-view tiles
scene levels "SoGeometryClipmapTerrain { clipmapSize 63 pixelError 0 }" --debug-view levels
scene errors "SoGeoMipmapTerrain { }" --debug-view errors
scene loading "SoGeometryClipmapTerrain { clipmapSize 127 pixelError 0.2 updateBudget 2500 }" --debug-view loading --flight "$scratch/on.csv" --frames 6
scene frozen "SoChunkedLoDTerrain { pixelError 10 morphing FALSE }" --debug-view levels --overlay --flight "$scratch/away.csv" --frames 2 -F 1000 --freeze-at 0
montage "$scratch/edges-0.png" "$scratch/tiles-0.png" "$scratch/levels-0.png" "$scratch/errors-0.png" "$scratch/loading-5.png" "$scratch/frozen-1.png" \
    -tile 3x2 -geometry +2+2 "$scratch/all.png"
convert "$scratch/all.png" -quality 82 "$pictures/debug.jpg"
