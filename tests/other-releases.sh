#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds and tests the committed tree in a root file system of another Debian release, or for arm64
# with qemu. The last line of the output has the counts.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)

usage() {
  cat <<EOF
Usage: tests/other-releases.sh (NAME | arm64) [options]

  NAME            a release of Debian: bookworm, trixie, forky, sid
  arm64           Debian 12: a cross build, its tests run by qemu-user
  --suites LIST   suites to run (default: "core elements pipelines"; arm64: "core")
  --output DIR    logs, and the root, which the next run uses again (default: build-releases/NAME)
  --mirror URL    where Debian's packages come from (default: http://deb.debian.org/debian)

Needs root, mmdebstrap, and some 8 GB. Programs that tests start are not run for arm64.
EOF
}

name=
suites=
output=
mirror=http://deb.debian.org/debian
while [ $# -gt 0 ]; do
  case $1 in
    --suites | --output | --mirror)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      declare "${1#--}=$2"
      shift ;;
    -h | --help) usage; exit 0 ;;
    -*) echo "Unknown option '$1'." >&2; usage >&2; exit 2 ;;
    *) [ -z "$name" ] || { usage >&2; exit 2; }; name=$1 ;;
  esac
  shift
done
[ -n "$name" ] || { usage >&2; exit 2; }
[ "$(id -u)" = 0 ] || { echo "tests/other-releases.sh makes roots, so it needs root." >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "Install mmdebstrap first." >&2; exit 1; }
output=${output:-$top/build-releases/$name}
mkdir -p "$output"
output=$(cd "$output" && pwd)

# These packages are needed only for the suite lint, which does not run here. Its rules check the
# text of the tree, which is the same in every release.
only_lint='clang-format|clang-tidy|libgirepository1.0-dev'
mapfile -t packages < <(sed 's/#.*//; /^[[:space:]]*$/d' "$top/tests/packages.txt" | grep -vxE "$only_lint")
if [ "$name" = arm64 ]; then
  release=bookworm architecture=arm64 configure=(--cross-file /src/arm64.ini -Dtools=enabled)
  run=(--no-suite programs --timeout-multiplier 20)
  suites=${suites:-core}
else
  release=$name architecture=$(dpkg --print-architecture) configure=()
  run=(--timeout-multiplier 4)
  suites=${suites:-core elements pipelines}
fi

root=$output/root
# shellcheck source=packaging/roots.sh
. "$top/packaging/roots.sh"
trap 'leave_root "$root"' EXIT

say() { echo "== $* ($SECONDS s)"; }

# Installs the named packages that exist in the release, and prints the names of the others.
install_packages() {
  inside "$root" "
    there= missing=
    for package in $*; do
      if apt-cache show \"\$package\" >/dev/null 2>&1; then there=\"\$there \$package\"; else missing=\"\$missing \$package\"; fi
    done
    [ -z \"\$missing\" ] || echo \"not in $release:\$missing\"
    apt-get -q -y --no-install-recommends install \$there" >"$output/install.log" 2>&1 || { tail -20 "$output/install.log"; return 1; }
  grep '^not in' "$output/install.log" || true
}

# Installs the packages for a cross build: tools for this machine, and libraries for arm64.
# foxglovesink and ouster-replay are not built.
install_for_arm64() {
  local package foreign=()
  for package in "${packages[@]}"; do
    case $package in
      # libsoup needs gobject-introspection of arm64, which needs the Python of arm64.
      libsoup-3.0-dev) ;;
      nlohmann-json3-dev | libcli11-dev | libeigen3-dev | robin-map-dev) foreign+=("$package") ;;
      lib*-dev | *-dev | gstreamer1.0-plugins-*) foreign+=("$package:arm64") ;;
    esac
  done
  install_packages crossbuild-essential-arm64 qemu-user-static ccache git jq meson ninja-build pkg-config python3 "${foreign[@]}"
}

# Writes the cross file of meson. It uses the key pkgconfig, because version 1.0 of meson does not
# know the newer name pkg-config.
write_cross_file() {
  cat >"$root/src/arm64.ini" <<EOF
[binaries]
c = ['ccache', 'aarch64-linux-gnu-gcc']
cpp = ['ccache', 'aarch64-linux-gnu-g++']
ar = 'aarch64-linux-gnu-ar'
strip = 'aarch64-linux-gnu-strip'
pkgconfig = 'pkg-config'
exe_wrapper = 'qemu-aarch64-static'

[properties]
pkg_config_libdir = '/usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig'

[host_machine]
system = 'linux'
cpu_family = 'aarch64'
cpu = 'aarch64'
endian = 'little'
EOF
}

make_ready() {
  if [ -f "$root/src/ready" ] && cmp -s "$root/src/ready" "$top/tests/packages.txt"; then
    enter_root "$root"
    return
  fi
  say "a root of $release"
  rm -rf --one-file-system "$root"
  if [ "$name" = arm64 ]; then architectures=amd64,arm64; fi
  make_root "$root" "$release" build-essential ca-certificates
  say "packages to build and test with"
  if [ "$name" = arm64 ]; then install_for_arm64; else install_packages "${packages[@]}"; fi
  cp "$top/tests/packages.txt" "$root/src/ready"
}

# Builds the tree with the options of tests/run.sh, except that warnings are not errors. Newer
# compilers have new warnings, so warnings are only counted.
build_tree() {
  [ "$name" != arm64 ] || write_cross_file
  rm -rf "$root/src/gst-lidar"
  git -C "$top" archive --prefix=gst-lidar/ HEAD | tar -x -C "$root/src"
  inside "$root" "cd /src/gst-lidar
    [ -f /src/build/build.ninja ] || meson setup /src/build -Dcpp_args=-g1 --unity on -Dunity_size=40 -Dbenchmarks=disabled ${configure[*]}
    ninja -C /src/build" >"$output/build.log" 2>&1
}

# test_suite NAME: runs a suite. Prints "NAME passed/all", and the names of the tests that failed.
test_suite() {
  local suite=$1 log
  rm -f "$root/src/build/meson-logs/testlog.json"
  inside_alone "$root" "meson test -C /src/build --no-rebuild --suite $suite --print-errorlogs ${run[*]}" >"$output/$suite.log" 2>&1 || true
  log=$root/src/build/meson-logs/testlog.json
  [ -f "$log" ] || { echo ", $suite did not run"; return; }
  jq -s -r --arg suite "$suite" 'map(select(.result != "SKIP")) as $ran
    | [$ran[] | select(.result != "OK" and .result != "EXPECTEDFAIL") | .name | sub(".*/ "; "")] as $bad
    | ", \($suite) \(($ran | length) - ($bad | length))/\($ran | length)" + if $bad == [] then "" else " (\($bad | join(" ")))" end' "$log"
}

make_ready
version() { inside "$root" "dpkg-query -W -f '\${Version}' $1" | sed 's/^[0-9]*://; s/[-+].*//'; }
if [ "$name" = arm64 ]; then compiler=g++-12-aarch64-linux-gnu; else compiler=g++-$(inside "$root" 'g++ -dumpversion'); fi
line="$name: $release $architecture, $compiler $(version "$compiler"), GStreamer $(version "libgstreamer1.0-dev:$architecture")"
say "building"
if ! build_tree; then
  grep -E -A12 'FAILED|error:|ERROR' "$output/build.log" | head -60
  echo "$line: build failed"
  exit 1
fi
line+=": build ok, $(grep -c 'warning:' "$output/build.log" || true) warnings"
for suite in $suites; do
  say "$suite"
  line+=$(test_suite "$suite")
done
echo "$line"
! grep -qE '\(|did not run' <<<"${line#*build ok}"
