#!/bin/bash
# Usage: nodes.sh BUILD      makes heightmap.png, kit.png and texture.png beside it, with SoTerrainTest of that build and ImageMagick
set -eu
pictures=$(cd "$(dirname "$0")" && pwd)
data=$pictures/../../data
build=$(cd "$1" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export EGL_PLATFORM=${EGL_PLATFORM-surfaceless} LD_LIBRARY_PATH=$build/modules

# scene NAME CAMERA TEXTURE: draws $scratch/NAME.png
scene() {
    cat >"$scratch/$1.iv" <<SCENE
#Inventor V2.1 ascii
Separator {
  PerspectiveCamera { $2 nearDistance 1 farDistance 3000 heightAngle 0.7 }
  DirectionalLight { direction 0.5 0.5 -1 }
  Material { ambientColor 0.5 0.5 0.5 diffuseColor 1 1 1 }
  $3
  SoHeightMap { filename "$data/terrain.png" heightScale 0.0011 }
  SoROAMTerrain { pixelError 0.5 }
}
SCENE
    "$build/SoTerrainTest" --scene "$scratch/$1.iv" --offscreen=480x360 --output "$scratch/$1.png"
}

scene white "position 150 40 160 orientation 1 -0.18 -0.06 1.25" ""
convert "$data/terrain.png" -depth 8 -resize 360x360 "$scratch/grey.png"
convert "$scratch/grey.png" "$scratch/white.png" +append -colors 96 PNG8:"$pictures/heightmap.png"

cat >"$scratch/kit.iv" <<SCENE
#Inventor V2.1 ascii
Separator {
  PerspectiveCamera { position 150 40 160 orientation 1 -0.18 -0.06 1.25 nearDistance 1 farDistance 3000 heightAngle 0.7 }
  DirectionalLight { direction 0.5 0.5 -1 }
  SoTerrainKit {
    algorithm CHUNKED_LOD
    heightMap SoHeightMap { filename "$data/terrain.png" heightScale 0.0011 }
    texture Texture2 { filename "$data/terrain_texture.jpg" }
  }
}
SCENE
"$build/SoTerrainTest" --scene "$scratch/kit.iv" --offscreen=480x360 --output "$scratch/kit.png"
convert "$scratch/kit.png" -colors 96 PNG8:"$pictures/kit.png"

texture="SoTerrainTexture { filename \"$data/terrain_texture.jpg\" clipSize 256 }"
scene above "position 512 512 1500 orientation 1 0 0 0" "$texture"
scene near "position 420 330 60 orientation 1 -0.18 -0.06 1.35" "$texture"
convert "$scratch/above.png" "$scratch/near.png" +append -colors 96 PNG8:"$pictures/texture.png"
