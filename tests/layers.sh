#!/bin/bash
# A folder includes only those above it: lib/base, lib/height, lib/lod, lib/gl, nodes, apps; and of other people's headers only those that
# its layer is for. Prints file:line of each violation. `layers.sh FOLDER` checks another tree; without one this tree is checked, and
# then that violations planted in a copy are found.
set -u

violations() {
    cd "$1" || exit 1
    find lib nodes apps -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.glsl' \) 2>/dev/null | sort | xargs -r awk '
        BEGIN {
            split("lib/base lib/height lib/lod lib/gl nodes apps", order, " ")
            for (i in order) rank[order[i]] = i + 0
            glm = "|glm/.*"
            standard = "[a-z_]+"
            allowed["lib/base"] = standard glm
            allowed["lib/lod"] = standard glm
            allowed["lib/height"] = standard glm "|OpenImageIO/.*|(gdal|ogr|cpl)[a-z_]*\\.h|(fcntl|unistd|sys/[a-z]+)\\.h"
            allowed["lib/gl"] = standard glm "|epoxy/e?gl\\.h"
            allowed["nodes"] = standard glm "|Inventor/.*|epoxy/gl\\.h"
            allowed["apps"] = ".*"
            forbidden["lib/lod"] = "iostream|fstream|filesystem"
            forbidden["nodes"] = "Inventor/(Qt|Xt|Win)/.*"
            forbidden["apps"] = "gdal.*|ogr.*|E?GL/.*|(base|height|lod|gl)/.*\\.cpp"
        }
        function complain(what) { printf "%s:%d: %s\n", FILENAME, FNR, what }
        FNR == 1 {
            split(FILENAME, path, "/")
            folder = path[1] == "lib" ? path[1] "/" path[2] : path[1]
            if (!(folder in rank)) complain("no layer is called " folder)
        }
        /TODO|FIXME/ { complain("unfinished: " $0) }
        match($0, /^[ \t]*#[ \t]*include[ \t]*[<"][^>"]*[>"]/) {
            include = substr($0, RSTART, RLENGTH)
            own = include ~ /"/
            sub(/^[^<"]*[<"]/, "", include)
            sub(/[>"]$/, "", include)
            if (include == "config.h") next
            target = ""
            if (include ~ /^SoTerrain\//) target = "nodes"
            else if (include ~ /^(base|height|lod|gl)\//) target = "lib/" substr(include, 1, index(include, "/") - 1)
            if (target != "") {
                if (rank[target] > rank[folder]) complain(folder " includes " include " of the layer " target)
            } else if (own && include ~ /\.\.|^(lib|nodes|apps|tests)\//) {
                complain("include " include " from lib or nodes, not by a relative path")
            } else if (!own && (include !~ "^(" allowed[folder] ")$" || ((folder in forbidden) && include ~ "^(" forbidden[folder] ")$"))) {
                complain(folder " must not include <" include ">")
            } else if (own && include ~ /\// ) {
                complain(folder " must not include \"" include "\"")
            }
        }'
}

finds() {
    mkdir -p "$copy/$(dirname "$1")"
    printf '#include <vector>\n%s\n' "$2" >"$copy/$1"
    local found
    found=$(violations "$copy")
    rm "$copy/$1"
    case $found in
        "$1:2: "*) [ "$3" = yes ] && return ;;
        "") [ "$3" = no ] && return ;;
    esac
    echo "layers.sh itself: '$2' in $1, a violation: $3, found: '$found'"
    failed=1
}

failed=0
found=$(violations "${1-${srcdir-$(dirname "$0")/..}}") || failed=1
if [ -n "$found" ]; then
    echo "$found"
    failed=1
fi
[ $# -eq 0 ] || exit $failed

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
finds lib/base/A.h '#include <glm/vec3.hpp>' no
finds lib/base/A.h '#include "height/HeightSource.h"' yes
finds lib/base/A.h '#include <epoxy/gl.h>' yes
finds lib/height/A.cpp '#include <gdal_priv.h>' no
finds lib/height/A.cpp '#include "lod/RoamMesh.h"' yes
finds lib/lod/A.cpp '#include "height/HeightMap.h"' no
finds lib/lod/A.cpp '#include "gl/GlObjects.h"' yes
finds lib/lod/A.cpp '#include <Inventor/SbVec3f.h>' yes
finds lib/lod/A.cpp '  # include <OpenImageIO/imageio.h>' yes
finds lib/lod/A.cpp '#include <fstream>' yes
finds lib/gl/A.cpp '#include <epoxy/egl.h>' no
finds lib/gl/A.cpp '#include <GL/gl.h>' yes
finds lib/gl/A.cpp '#include <SoTerrain/SoTerrain.h>' yes
finds nodes/A.cpp '#include "../lib/lod/RoamMesh.h"' yes
finds nodes/A.cpp '#include "lod/RoamMesh.h"' no
finds nodes/A.cpp '#include <Inventor/Qt/SoQt.h>' yes
finds nodes/A.cpp '// TODO: more' yes
finds apps/A.cpp '#include <Inventor/Qt/SoQt.h>' no
finds apps/A.cpp '#include <gdal.h>' yes
exit $failed
