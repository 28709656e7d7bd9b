#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# What a release consists of, in one folder, from what is committed: wheels, sources, page, site, Debian packages, list of parts, checksums.
# Each file is installed or opened in a place that has nothing of this checkout.  Usage: tools/release.sh FOLDER [PYTHON-VERSION...]
set -eu
cd "$(dirname "$0")/.."
root=$PWD
mkdir -p "${1:?usage: tools/release.sh FOLDER [PYTHON-VERSION...]}"
out=$(cd "$1" && pwd)
shift
version=$(sed -n 's/#define NT_VERSION "\(.*\)"/\1/p' libnanotouch/include/nanotouch/version.h)
say() { echo "-- $*" >&2; }
stop() { echo "no release: $*" >&2 && exit 1; }

# --- what must be true before ----------------------------------------------------------------------------------------
[ -z "$(git status --porcelain)" ] || stop "there are changes that are not committed"
grep -q "^## $version" CHANGELOG.md || stop "CHANGELOG.md has no section for $version"
[ "$(wc -l <CHANGELOG.md)" -le 60 ] || stop "CHANGELOG.md has more than 60 lines: move what is old to docs/evidence/history.md"
grep -q "version: \"$version\"" packaging/conda/recipe.yaml || stop "packaging/conda/recipe.yaml has another version than $version"
tag=$(git tag --list "v$version")
[ -z "$tag" ] || [ "$(git rev-list -n 1 "v$version")" = "$(git rev-parse HEAD)" ] || stop "v$version is another commit"
rm -f "$out"/*

# --- the files -------------------------------------------------------------------------------------------------------
work=$root/build/release-work
rm -rf "$work"
mkdir -p "$work"
git clone -q --no-hardlinks "$root" "$work/source"
cd "$work/source"
mkdir -p "$root/build/deps" build
ln -s "$root/build/deps" build/deps # a Ceres that was built by the same recipe serves again

say "the page"
tools/setup.sh page
.venv/bin/python apps/page/build.py build/page/nanotouch-touch.html
mkdir -p apps/nanotouch_app/browser
cp build/page/nanotouch-touch.html apps/nanotouch_app/browser/
cp build/page/nanotouch-touch.html "$out/nanotouch-touch-$version.html"

say "wheels"
tools/setup.sh wheels
tools/wheels.sh "$work/wheels" "$@"
cp "$work"/wheels/*.whl "$out"

say "sources"
python3 -m venv "$work/build"
"$work/build/bin/pip" install -q build
"$work/build/bin/python" -m build -q --sdist --outdir "$out" .

say "Debian packages"
if command -v dh >/dev/null; then tools/deb.sh "$out" >/dev/null; else say "left out: no debhelper"; fi

say "the site"
NANOTOUCH_WHEEL=$(ls "$out"/nanotouch-*-cp"$(.venv/bin/python -c 'import sys; print("%d%d" % sys.version_info[:2])')"-*.whl 2>/dev/null) make -s docs
tar -C build/docs -czf "$out/nanotouch-site-$version.tar.gz" --exclude=.doctrees .

say "list of parts and checksums"
python3 tools/sbom.py tools/lock/demo.txt >"$out/nanotouch-$version.cdx.json"
cd "$out"
sha256sum -- * >"$work/SHA256SUMS"
mv "$work/SHA256SUMS" .

# --- tried -----------------------------------------------------------------------------------------------------------
say "the sources, built and looked at in a bare environment"
python3 -m venv "$work/bare"
"$work/bare/bin/pip" install -q "$out/nanotouch-$version.tar.gz[record,app]"
(cd "$work" && bare/bin/python -m nanotouch --version && bare/bin/nanotouch touch --out "$work/touched" >/dev/null)
say "the sums"
sha256sum -c --quiet SHA256SUMS
cd "$work/source"
if [ "$(id -u)" = 0 ] && command -v mmdebstrap >/dev/null; then
  for suite in bookworm trixie; do
    say "a bare $suite"
    mmdebstrap -q --variant=minbase $suite "$work/$suite"
    tools/try_release.sh "$out" "$work/$suite"
  done
else
  say "left out: bare roots (tools/try_release.sh), which need root and mmdebstrap"
fi
ls -l "$out"
