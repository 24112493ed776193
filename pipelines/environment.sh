# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by the scripts here: the plugins of the build tree first, with a registry of their own.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${BUILD_DIR:-$root/build}
if [ ! -f "$build/build.ninja" ]; then
  echo "There is no build in $build: run 'meson setup build && ninja -C build' first, or set BUILD_DIR." >&2
  exit 1
fi
plugins=$(find "$build/gst" "$build/ext" -name 'libgst*.so' -printf '%h\n' | sort -u | paste -sd:)
export GST_PLUGIN_PATH_1_0=$plugins${GST_PLUGIN_PATH_1_0:+:$GST_PLUGIN_PATH_1_0}
export GST_REGISTRY=$build/pipelines-registry.bin

# need PACKAGES ELEMENT...: ends the script if an element is missing.
need() {
  local packages=$1 element
  shift
  for element in "$@"; do
    gst-inspect-1.0 "$element" >/dev/null 2>&1 && continue
    echo "The element $element is missing${packages:+: install $packages}." >&2
    exit 1
  done
}

# launch PIPELINE...: replaces this process by gst-launch-1.0. Shows its warnings, which -q would hide, but not its progress.
launch() { exec gst-launch-1.0 "$@" > >(grep --line-buffered '^WARNING' >&2); }
