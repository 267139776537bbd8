#!/bin/bash
# The site: Doxygen has nothing to complain of, every node has its page with all of its fields, and no link is broken.
. "$(dirname "$0")/apps/common.sh"
export PYTHONDONTWRITEBYTECODE=1 SOTERRAIN_SRCDIR=$SOURCE
command -v python3 >/dev/null || skip "python3 is missing (Debian: python3)"
python3 "$SOURCE/tests/docs_check.py" links "$SOURCE" || fail "links of the Markdown files"

# A broken link, image or heading would be found.
mkdir -p "$SCRATCH/broken/docs"
cp "$SOURCE"/docs/doxygen_filter.py "$SCRATCH/broken/docs"
printf '# A heading\n[fine](#a-heading) [a](no.md) [b](#nowhere) ![c](no.png)\n' >"$SCRATCH/broken/README.md"
[ "$(python3 "$SOURCE/tests/docs_check.py" links "$SCRATCH/broken" | wc -l)" = 3 ] || fail "docs_check.py does not find three broken links"

[ -n "${DOXYGEN-}" ] || { [ "$failures" = 0 ] && skip "doxygen is missing (Debian: doxygen); links of the Markdown files are fine"; finish; }
site=$SCRATCH/site
mkdir "$site"
{
    cat "$BUILD/docs/Doxyfile"
    echo "OUTPUT_DIRECTORY = $site"
    echo "GENERATE_XML = YES"
} >"$SCRATCH/Doxyfile"
expect 0 "$DOXYGEN" "$SCRATCH/Doxyfile"
[ -s "$SCRATCH/err" ] && fail "Doxygen warns: $(cat "$SCRATCH/err")"
python3 "$SOURCE/tests/docs_check.py" site "$site" $NODE_CLASSES || fail "the site"
for class in $NODE_CLASSES; do
    grep -q "nodes/$class.cpp" "$SOURCE/docs/nodes.md" || fail "docs/nodes.md does not show $class"
done
finish
