#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The way of a stranger: in a bare Debian or Ubuntu, from the files of a release to a touch, a fit, a test of an own backend, and
# a program in C against the Debian package; on this machine to the page in Chromium. Each step with its seconds, all and of
# the processor.  Usage, as root: tools/try_release.sh FOLDER ROOT
#   mmdebstrap --variant=minbase bookworm ROOT      # a bare root; it is changed
set -eu
cd "$(dirname "$0")/.."
usage="usage: tools/try_release.sh FOLDER ROOT"
files=${1:?$usage} root=${2:?$usage}
rm -rf "$root/release"
mkdir "$root/release"
cp "$files"/* docs/examples/testing/test_own_backend.py apps/c/05_plan.c "$root/release/"
for file in /etc/resolv.conf /etc/hosts /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do # how this machine reaches the net
  [ ! -f "$file" ] || { mkdir -p "$root${file%/*}" && cp "$file" "$root$file"; }
done
cp "$root/etc/ssl/certs/ca-certificates.crt" "$root/release/" 2>/dev/null || true

cat >"$root/release/way.sh" <<'WAY'
set -eu
cd /root
export HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive PIP_DISABLE_PIP_VERSION_CHECK=1
now() { cut -d ' ' -f 1 /proc/uptime; }
used() { awk '{ print ($16 + $17) / 100 }' /proc/$$/stat; } # by children that have ended
step() { # step WHAT COMMAND...
  what=$1 began=$(now) before=$(used)
  shift
  "$@" >log 2>&1 || { cat log; echo "failed: $what" && exit 1; }
  echo "$what $began $(now) $before $(used)" | awk '{ n = NF; printf "%7.1f s %7.1f s  ", $(n - 2) - $(n - 3), $n - $(n - 1)
    for (i = 1; i <= n - 4; ++i) printf "%s ", $i; print "" }'
}
. /etc/os-release
echo "$PRETTY_NAME"
echo "     wall processor"
apt_get() { apt-get -qq install -y --no-install-recommends "$@"; }
step "apt-get update" apt-get -qq update
step "apt-get install python3-venv" apt_get python3-venv
cp /release/ca-certificates.crt /etc/ssl/certs/ 2>/dev/null || true # which Debian's package of this name has replaced
tag=$(python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
step "python3 -m venv" python3 -m venv v
file=$(ls /release/*-"$tag"-*linux*.whl 2>/dev/null || true)
if [ -z "$file" ]; then
  file=$(ls /release/nanotouch-[0-9]*[0-9].tar.gz)
  step "apt-get install build-essential python3-dev libceres-dev: no wheel of $tag" apt_get build-essential python3-dev libceres-dev
fi
step "pip install ./${file##*/}[record,app]" v/bin/pip install -q "$file[record,app]"
step "nanotouch --version" v/bin/nanotouch --version
step "nanotouch doctor" v/bin/nanotouch doctor
step "nanotouch touch --out first" v/bin/nanotouch touch --out first
cat log
step "pip install pytest" v/bin/pip install -q pytest
step "pytest test_own_backend.py" v/bin/python -m pytest -q -p no:cacheprovider /release/test_own_backend.py
tail -1 log
if ls /release/libnanotouch-dev_*.deb >/dev/null 2>&1; then
  step "apt-get install the Debian packages, gcc, pkgconf" apt_get $(ls /release/libnanotouch*.deb | grep -v dbgsym) gcc libc6-dev pkgconf
  step "cc 05_plan.c" sh -c 'cc -std=c11 /release/05_plan.c -o plan $(pkg-config --cflags --libs nanotouch)'
  step "the program" ./plan
  head -3 log
fi
WAY
export root
unshare -m sh -c 'mount -t proc proc "$root/proc" && exec chroot "$root" sh /release/way.sh'

if command -v node >/dev/null && [ -d build/page/npm ]; then
  echo "the page in Chromium, offline: $(node tests/page/opened.mjs "$files"/nanotouch-touch-*.html)"
else
  echo "the page was not opened: no node, or make page has not run"
fi
