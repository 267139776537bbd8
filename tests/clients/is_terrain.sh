#!/bin/bash
# is_terrain.sh PICTURE: whether a picture of the shipped terrain shows ground in greens or earth and, where it is textured, snow; not
# one flat colour. Prints what it found. Reads a PPM by itself and other formats with ImageMagick.
set -u
picture=$1
[ -s "$picture" ] || { echo "$picture: expected a picture of the terrain, found none"; exit 1; }
case $picture in
    *.ppm) cat "$picture" ;;
    *) convert "$picture" -depth 8 ppm:- ;;
esac | /usr/bin/python3 -c '
import re, sys
data = sys.stdin.buffer.read()
header = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", data)
pixels = data[header.end():]
colours = set()
green = count = 0
for r, g, b in zip(pixels[0::3], pixels[1::3], pixels[2::3]):
    count += 1
    green += g >= r and g > b + 12
    colours.add((r >> 3, g >> 3, b >> 3))
print(f"{sys.argv[1]}: {100 * green // count} % green, {len(colours)} colours")
sys.exit(not (green > count // 10 and len(colours) > 25))
' "$picture"
