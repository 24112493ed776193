# SPDX-License-Identifier: LGPL-2.1-or-later
# shellcheck shell=bash disable=SC2154
# Sourced by the scripts that work in clean roots of Debian's releases. The roots are made from
# $mirror, for $architectures.

# make_root DIR RELEASE PACKAGE...: makes a minimal root of the release with these packages and an
# empty /src. The signatures of the mirror are checked, but not its dates, because the mirror may be
# some weeks old.
make_root() {
  local dir=$1 release=$2
  shift 2
  mmdebstrap --quiet --variant=minbase ${architectures:+--architectures="$architectures"} --dpkgopt=force-unsafe-io \
    --aptopt='Acquire::Check-Valid-Until "false"' \
    --include="$(IFS=,; echo "$*")" "$release" "$dir" "$mirror"
  mkdir -p "$dir/dev/shm" "$dir/src"
  cp /etc/resolv.conf "$dir/etc/resolv.conf"
  enter_root "$dir"
  inside "$dir" 'apt-get -q update >/dev/null'
}

enter_root() {
  mount -t proc proc "$1/proc"
  mount -t tmpfs tmpfs "$1/dev/shm"
}

leave_root() {
  umount "$1/dev/shm" "$1/proc" 2>/dev/null || true
}

# inside DIR COMMANDS: runs the commands in the root. The shell ends at the first command that
# fails.
inside() {
  chroot "$1" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-}" sh -euc "$2"
}

# inside_alone DIR COMMANDS: does the same as inside, in a network namespace that has only the
# loopback interface.
inside_alone() {
  local dir=$1 commands=$2
  export -f inside
  unshare --net bash -euc 'ip link set lo up; inside "$@"' - "$dir" "$commands"
}
