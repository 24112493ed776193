#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the Debian packages in a clean root of a release. Then installs and tests them in another
# clean root.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)

usage() {
  cat <<EOF
Usage: packaging/build-deb.sh [--release NAME] [--output DIR] [--mirror URL] [--no-try] [--try-only]

  --release NAME  a release of Debian: bookworm, trixie, sid (default: bookworm)
  --output DIR    where packages and logs go (default: packages/NAME)
  --mirror URL    where Debian's packages come from (default: http://deb.debian.org/debian)
  --no-try        do not install the packages in a clean root
  --try-only      try the packages that are in the output folder

Needs root, mmdebstrap, and some 4 GB in \$TMPDIR.
EOF
}

release=bookworm
output=
mirror=http://deb.debian.org/debian
build=yes
try=yes
while [ $# -gt 0 ]; do
  case $1 in
    --release | --output | --mirror)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      declare "${1#--}=$2"
      shift ;;
    --no-try) try=no ;;
    --try-only) build=no ;;
    -h | --help) usage; exit 0 ;;
    *) echo "Unknown option '$1'." >&2; usage >&2; exit 2 ;;
  esac
  shift
done
[ "$(id -u)" = 0 ] || { echo "packaging/build-deb.sh makes roots, so it needs root." >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "Install mmdebstrap first." >&2; exit 1; }
output=${output:-$top/packages/$release}
mkdir -p "$output"

work=$(mktemp -d "${TMPDIR:-/tmp}/build-deb.XXXXXX")
# shellcheck source=packaging/roots.sh
. "$top/packaging/roots.sh"
remove_roots() {
  local root
  for root in "$work"/*/; do leave_root "$root"; done
  rm -rf --one-file-system "$work"
}
trap remove_roots EXIT

say() { echo "== $* ($SECONDS s)"; }

# Builds the packages. Fails if lintian reports an error or a warning.
build_packages() {
  local root=$work/build
  say "a root of $release to build in"
  make_root "$root" "$release" build-essential lintian
  git -C "$top" archive --prefix=gst-lidar/ HEAD | tar -x -C "$root/src"
  say "packages to build with"
  inside "$root" 'cd /src/gst-lidar && apt-get -q -y --no-install-recommends build-dep ./ >/dev/null'
  say "building"
  inside "$root" 'cd /src/gst-lidar && dpkg-buildpackage -us -uc -b' >"$output/build.log" 2>&1 ||
    { tail -40 "$output/build.log"; return 1; }
  rm -f "$output"/*.deb
  cp "$root/src/"*.deb "$output"
  list_packages
  say "lintian"
  inside "$root" 'cd /src && lintian --allow-root --fail-on error,warning *.changes' >"$output/lintian.log" 2>&1 ||
    { cat "$output/lintian.log"; return 1; }
  echo "ok lintian: $(grep -cE '^[EW]:' "$output/lintian.log" || true) errors and warnings"
}

# Prints each package, its size, and its size when installed.
list_packages() {
  local package
  for package in "$output"/*.deb; do
    dpkg-deb -W --showformat "\${Package} \${Version} $(stat -c %s "$package") B, installed \${Installed-Size} KiB\n" "$package"
  done
}

# Installs the packages in a clean root, and tests them. The tests run without the host's network,
# so that all ports are free.
try_packages() {
  local root=$work/try began name
  say "a clean root of $release to install in"
  make_root "$root" "$release" ca-certificates
  cp "$output"/*.deb "$root/src"
  git -C "$top" archive --prefix=gst-lidar/ HEAD README.md debian/tests tests/data tests/pipelines | tar -x -C "$root/src"
  local install='apt-get -q -y --no-install-recommends install'
  inside "$root" "cd /src && $install --download-only ./*.deb gstreamer1.0-tools >/dev/null"
  rm "$root/etc/dpkg/dpkg.cfg.d/99mmdebstrap" # users have no such file
  began=$SECONDS
  inside "$root" "cd /src && $install ./*.deb gstreamer1.0-tools >/dev/null"
  inside_alone "$root" 'cd /tmp && gst-launch-1.0 -q lidartestsrc model=os1-128 num-buffers=24 ! pointcloudview ! pngenc snapshot=false ! multifilesink location=view.png && test -s view.png'
  echo "ok picture: $((SECONDS - began)) s from apt-get install to a picture, with $(inside "$root" 'dpkg -l | grep -c ^ii') packages"
  inside "$root" "$install g++ pkgconf gstreamer1.0-plugins-bad python3 >/dev/null"
  for name in inspect pipeline development; do
    inside_alone "$root" "/src/gst-lidar/debian/tests/$name"
    echo "ok $name"
  done
  inside_alone "$root" 'cd /src/gst-lidar && tests/pipelines/doc_pipelines.py . README.md'
  echo "ok the pipelines of the README"
}

[ "$build" = no ] || build_packages
[ "$try" = no ] || try_packages
say "done: $output"
