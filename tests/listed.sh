#!/bin/bash
# Every file that belongs to the project stands in Makefile.am, so it is built and distributed.
cd "${srcdir-$(dirname "$0")/..}" || exit 1
listed=$(grep -oE '[A-Za-z0-9_./-]+' Makefile.am | sort -u)
failed=0
while read -r file; do
    grep -qxF "$file" <<<"$listed" || { echo "$file is not in Makefile.am"; failed=1; }
done < <(find lib nodes apps tests data -type f ! -name '.*' ! -name '*~' ! -name '*.o' ! -name '*.lo' ! -name '*.log' ! -name '*.trs' ! -name 'test_[a-z]*' | sort)
exit $failed
