#!/bin/bash
# Every file that belongs to the project stands in Makefile.am, so it is built and distributed; and so is every file that a document of
# the archive links.
cd "${srcdir-$(dirname "$0")/..}" || exit 1
listed=$(grep -oE '[A-Za-z0-9_./-]+' Makefile.am | sort -u)
failed=0
while read -r file; do
    grep -qxF "$file" <<<"$listed" || { echo "$file is not in Makefile.am"; failed=1; }
done < <(find lib nodes apps tests data docs examples man cmake debian -type f ! -name '.*' ! -name '*~' ! -name '*.o' ! -name '*.lo' ! -name '*.log' ! -name '*.trs' ! -name 'test_[a-z]*' ! -name 'fuzz_[a-z]*' \
    ! -path 'docs/html/*' ! -path 'docs/xml/*' ! -name Doxyfile ! -path 'examples/*/build/*' ! -path '*/__pycache__/*' ! -path 'tests/pictures/*' ! -path 'cmake/*.cmake' ! -path 'debian/tmp/*' ! -path 'debian/.*' ! -path 'debian/*soterrain*/*' \
    ! -name '*.substvars' ! -name '*debhelper*' ! -name files | sort)
for document in README.md ARCHITECTURE.md CONTRIBUTING.md CHANGELOG.md data/README.md; do
    while read -r link; do
        [[ $document != */* ]] || link=${document%/*}/$link
        [ -d "$link" ] || { [ -f "$link" ] && grep -qxF "$link" <<<"$listed"; } || { echo "$document links $link, which is not in the archive"; failed=1; }
    done < <(grep -oE '\]\([^)#]+' "$document" | sed 's/^](//' | grep -vE '^[a-z]+:' | sort -u)
done
exit $failed
