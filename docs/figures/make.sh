#!/bin/bash
# Usage: make.sh [FOLDER]      draws the figures of algorithms.md into FOLDER, or beside itself; triangles.sh measures before it draws
set -eu
cd "$(dirname "$0")"
for figures in bisection errors tiles clipmap; do
    PYTHONDONTWRITEBYTECODE=1 python3 "$figures.py" "${1-.}"
done
