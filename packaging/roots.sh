# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by the scripts that work in clean roots of Debian's releases, below $work and from $mirror.

# make_root DIR RELEASE PACKAGE...: a minimal root of the release with these packages and an empty /src.
make_root() {
  local dir=$1 release=$2
  shift 2
  mmdebstrap --quiet --variant=minbase --include="$(IFS=,; echo "$*")" "$release" "$dir" "$mirror"
  mount -t proc proc "$dir/proc"
  mkdir -p "$dir/dev/shm" "$dir/src"
  mount -t tmpfs tmpfs "$dir/dev/shm"
  cp /etc/resolv.conf "$dir/etc/resolv.conf"
  inside "$dir" 'apt-get -q update >/dev/null'
}

# inside DIR COMMANDS: by a shell of the root, which ends where one fails.
inside() {
  chroot "$1" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-}" sh -euc "$2"
}

# The same, with a loopback network of its own and nothing else.
inside_alone() {
  local root=$1 commands=$2
  export -f inside
  unshare --net bash -euc 'ip link set lo up; inside "$@"' - "$root" "$commands"
}

remove_roots() {
  local root
  for root in "$work"/*/; do
    umount "$root/dev/shm" "$root/proc" 2>/dev/null || true
  done
  rm -rf --one-file-system "$work"
}
