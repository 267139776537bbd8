#!/bin/bash
# debian/control builds with what packages.txt lists, which is the one list; the version is the project's.
cd "${srcdir-$(dirname "$0")/..}" || exit 1
failed=0
# debhelper brings these itself, and build-essential is always there.
brought='^(build-essential|autoconf|automake|libtool)$'
diff <(sed 's/#.*//' packages.txt | grep . | grep -vE "$brought" | sort) \
    <(sed -n '/^Build-Depends:/,/^[A-Z]/p' debian/control | grep -oE '^ [a-z0-9.+-]+' | tr -d ' ' | grep -v '^debhelper-compat$' | sort) ||
    { echo "packages.txt (<) and Build-Depends in debian/control (>) differ"; failed=1; }
version=$(sed -n 's/^AC_INIT(\[SoTerrain\], \[\([^]]*\)\].*/\1/p' configure.ac)
head -1 debian/changelog | grep -qF "soterrain ($version-" || { echo "debian/changelog does not begin with version $version"; failed=1; }
grep -qF "## [$version]" CHANGELOG.md || { echo "CHANGELOG.md has nothing about version $version"; failed=1; }
for package in $(sed -n 's/^Package: //p' debian/control); do
    [ -s "debian/$package.install" ] || { echo "debian/$package.install is missing"; failed=1; }
done
exit $failed
