# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by the scripts in this folder. Makes GStreamer load the plugins of the build tree in
# preference to installed ones, and use a separate registry for them.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${BUILD_DIR:-$root/build}
if [ ! -f "$build/build.ninja" ]; then
  echo "There is no build in $build: run 'meson setup build && ninja -C build' first, or set BUILD_DIR." >&2
  exit 1
fi
plugins=$(find "$build/gst" "$build/ext" -name 'libgst*.so' -printf '%h\n' | sort -u | paste -sd:)
export GST_PLUGIN_PATH_1_0=$plugins${GST_PLUGIN_PATH_1_0:+:$GST_PLUGIN_PATH_1_0}
export GST_REGISTRY=$build/pipelines-registry.bin

# need PACKAGES ELEMENT...: ends the script if an element is missing. The message names the packages
# to install.
need() {
  local packages=$1 element
  shift
  for element in "$@"; do
    gst-inspect-1.0 "$element" >/dev/null 2>&1 && continue
    echo "The element $element is missing${packages:+: install $packages}." >&2
    exit 1
  done
}

# listening PORT PID: waits until a process has opened the UDP port. Fails if the process PID ends
# before that.
listening() {
  until grep -qsE "^ *[0-9]+: [0-9A-F]+:$(printf %04X "$1") " /proc/net/udp /proc/net/udp6; do
    kill -0 "$2" 2>/dev/null || return 1
    sleep 0.1
  done
}
# until_ended PID...: waits until these child processes of the shell have ended. Terminates them after
# half a minute.
until_ended() {
  local i
  for ((i = 0; i < 300; ++i)); do
    kill -0 "$@" 2>/dev/null || break
    sleep 0.1
  done
  kill "$@" 2>/dev/null || true
  wait "$@" 2>/dev/null || true
}
# playing LOG PID: waits until the statistics in LOG report feedback, or the process PID has ended,
# but not longer than a minute.
playing() {
  local i
  for ((i = 0; i < 600; ++i)); do
    ! grep -q 'feedback-accepted=(guint64)[1-9]' "$1" && kill -0 "$2" 2>/dev/null || return 0
    sleep 0.1
  done
}

# launch PIPELINE...: replaces this process by gst-launch-1.0. Shows its warnings, which -q would
# hide, but not its progress.
launch() { exec gst-launch-1.0 "$@" > >(grep --line-buffered '^WARNING' >&2); }
