#!/bin/bash
# Python's pivy draws scenes with our nodes from modules/, and their stand-ins without.
set -u
. "$SOTERRAIN_SRCDIR/tests/clients/common.sh"
if [ "${SOTERRAIN_SANITIZERS:-no}" != no ]; then
    echo "skipped: python is not built with sanitizers"
    exit 77
fi
# Debian's pivy belongs to Debian's python.
python=/usr/bin/python3
[ -x $python ] || python=$(command -v python3) || { echo "skipped: no python3"; exit 77; }
draws pivy "$python" "$clients/render.py"
LD_LIBRARY_PATH=$modules "$python" "$clients/fields.py" || failed=1
exit $failed
