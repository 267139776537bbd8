#!/bin/bash
# The benchmark measures every node, says which it could not, and writes what it measured.
. "$(dirname "$0")/common.sh"
BENCH=$BUILD/soterrain-bench
make_raw "$SCRATCH/map.raw"
expect 2 "$BENCH"
expect 2 "$BENCH" --map m --frames 0
expect 2 "$BENCH" --map m --pixel-error nan
expect 2 "$BENCH" --unknown
expect 0 "$BENCH" --help
expect 0 "$BENCH" --map "$SCRATCH/map.raw" --frames 4 --error-every 2 --json "$SCRATCH/b.json"
grep -q 'offscreen rendering' "$SCRATCH/err" && skip "no EGL with desktop OpenGL"
for node in SoIndexedFaceSet SoQuadMesh SoBruteForceTerrain SoROAMTerrain SoChunkedLoDTerrain SoGeoMipmapTerrain SoGeometryClipmapTerrain; do
    grep -q "^$node .*[0-9]" "$SCRATCH/out" || fail "no row for $node"
    grep -q "\"class\": \"$node\"" "$SCRATCH/b.json" || fail "no JSON for $node"
done
# 64 x 64 cells of two triangles, for each shape at full resolution.
for node in SoIndexedFaceSet SoQuadMesh SoBruteForceTerrain; do
    grep -q "^$node .* 8192 " "$SCRATCH/out" || fail "$node does not draw 8192 triangles"
done
# Tiles that are still being built spoil no error; column 9 is the largest.
awk '/^SoChunkedLoDTerrain .*[0-9]/ { found = 1; if (!($9 <= 2.0)) exit 1 } END { exit !found }' "$SCRATCH/out" ||
    fail "SoChunkedLoDTerrain exceeds 2 pixels: $(cat "$SCRATCH/out")"
# A flight of one's own, in the coordinates of a map that says how large it is: what is seen of it is measured, nothing is an error.
cat >"$SCRATCH/flight.csv" <<'FLIGHT'
time_ms,x,y,z,qx,qy,qz,qw
0,0,0,60,0.6,0,0,0.8
1000,300,100,60,0.6,0,0,0.8
FLIGHT
expect 0 "$BENCH" --map "$SCRATCH/map.raw" --spacing 10,20 --height-scale 0.2 --flight "$SCRATCH/flight.csv" --frames 3 --nodes SoROAMTerrain,SoBruteForceTerrain
awk '/^So/ { ++found; if (!($9 <= 2.0)) exit 1 } END { exit found != 2 }' "$SCRATCH/out" || fail "errors of a flight of one's own: $(cat "$SCRATCH/out")"
sed -i 's/,60,/,-60,/; s/0.6,0,0,0.8/0,0,0,1/' "$SCRATCH/flight.csv"
expect 1 "$BENCH" --map "$SCRATCH/map.raw" --flight "$SCRATCH/flight.csv" --frames 3 --nodes SoROAMTerrain
grep -q 'expected a flight that sees the map' "$SCRATCH/err" || fail "no message about a flight that sees nothing"
# Fields are those of the node: a smaller clipmap has fewer triangles.
triangles() { awk '/^So/ { print $6 }' "$SCRATCH/out"; }
expect 0 "$BENCH" --map "$SCRATCH/map.raw" --frames 1 --nodes SoGeometryClipmapTerrain --fields "clipmapSize 63"
large=$(triangles)
expect 0 "$BENCH" --map "$SCRATCH/map.raw" --frames 1 --nodes SoGeometryClipmapTerrain --fields "clipmapSize 15"
[ "$(triangles)" -lt "$large" ] || fail "--fields has no effect"
expect 1 "$BENCH" --map "$SCRATCH/map.raw" --frames 1 --nodes SoROAMTerrain --fields "clipmapSize 15"
grep -q 'expected fields of this class' "$SCRATCH/err" || fail "no message about a field that is none"
expect 1 "$BENCH" --map "$SCRATCH/map.raw" --frames 1 --nodes SoNoSuchNode
grep -q 'SoNoSuchNode' "$SCRATCH/err" || fail "the unknown node is not named"
expect 1 "$BENCH" --map "$SCRATCH/none.raw" --frames 1 --nodes SoQuadMesh
finish
