#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the Debian packages in a clean root of a release, then installs them in another and tries them there.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)

usage() {
  cat <<EOF
Usage: packaging/build-deb.sh [--release NAME] [--output DIR] [--mirror URL] [--no-try]

  --release NAME  a release of Debian: bookworm, trixie, sid (default: bookworm)
  --output DIR    where the packages go (default: packages/NAME)
  --mirror URL    where Debian's packages come from (default: http://deb.debian.org/debian)
  --no-try        do not install the packages in a clean root

Needs root, mmdebstrap, and some 4 GB in \$TMPDIR.
EOF
}

release=bookworm
output=
mirror=http://deb.debian.org/debian
try=yes
while [ $# -gt 0 ]; do
  case $1 in
    --release | --output | --mirror)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      declare "${1#--}=$2"
      shift ;;
    --no-try) try=no ;;
    -h | --help) usage; exit 0 ;;
    *) echo "Unknown option '$1'." >&2; usage >&2; exit 2 ;;
  esac
  shift
done
output=${output:-$top/packages/$release}
[ "$(id -u)" = 0 ] || { echo "packaging/build-deb.sh makes roots, so it needs root." >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "Install mmdebstrap first." >&2; exit 1; }

work=$(mktemp -d "${TMPDIR:-/tmp}/build-deb.XXXXXX")
clean() {
  for root in "$work"/*/; do
    umount "$root/proc" 2>/dev/null || true
  done
  rm -rf --one-file-system "$work"
}
trap clean EXIT

# make_root DIR PACKAGE...: a minimal root of the release with these packages.
make_root() {
  local dir=$1
  shift
  mmdebstrap --quiet --variant=minbase --include="$(IFS=,; echo "$*")" "$release" "$dir" "$mirror"
  mount -t proc proc "$dir/proc"
  cp /etc/resolv.conf "$dir/etc/resolv.conf"
  inside "$dir" 'apt-get -q update >/dev/null'
}
inside() { chroot "$1" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -euc "$2"; }

started=$SECONDS
echo "== a root of $release to build in"
make_root "$work/build" build-essential lintian
mkdir -p "$work/build/src"
git -C "$top" archive --prefix=gst-lidar/ HEAD | tar -x -C "$work/build/src"
echo "== packages to build with ($((SECONDS - started)) s)"
inside "$work/build" 'cd /src/gst-lidar && apt-get -q -y --no-install-recommends build-dep ./ >/dev/null'
echo "== building ($((SECONDS - started)) s)"
inside "$work/build" 'cd /src/gst-lidar && dpkg-buildpackage -us -uc -b' >"$work/build.log" 2>&1 ||
  { tail -40 "$work/build.log"; exit 1; }
echo "== lintian ($((SECONDS - started)) s)"
inside "$work/build" 'cd /src && lintian --allow-root --fail-on error,warning *.changes'
mkdir -p "$output"
cp "$work/build/src/"*.deb "$output"
ls -l --block-size=K "$output"/*.deb | awk '{print $5, $NF}'

if [ "$try" = yes ]; then
  echo "== a clean root of $release to install in ($((SECONDS - started)) s)"
  make_root "$work/try" ca-certificates
  mkdir -p "$work/try/src/tests"
  cp "$output"/*.deb "$work/try/src"
  cp "$top"/debian/tests/* "$work/try/src/tests"
  install_started=$SECONDS
  inside "$work/try" 'cd /src && apt-get -q -y --no-install-recommends install ./*.deb gstreamer1.0-tools g++ pkg-config >/dev/null'
  for name in inspect pipeline development; do
    inside "$work/try" "/src/tests/$name" && echo "ok $name"
  done
  inside "$work/try" 'cd /tmp && gst-launch-1.0 -q lidartestsrc model=os1-128 num-buffers=24 ! pointcloudview ! pngenc snapshot=false ! multifilesink location=view.png && test -s view.png'
  echo "ok picture: $((SECONDS - install_started)) s from the first apt-get to a picture"
fi
echo "== done ($((SECONDS - started)) s): $output"
