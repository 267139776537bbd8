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
expect 1 "$BENCH" --map "$SCRATCH/map.raw" --frames 1 --nodes SoNoSuchNode
grep -q 'SoNoSuchNode' "$SCRATCH/err" || fail "the unknown node is not named"
expect 1 "$BENCH" --map "$SCRATCH/none.raw" --frames 1 --nodes SoQuadMesh
finish
