# SPDX-License-Identifier: LGPL-2.1-or-later
# To be sourced by scripts that run the program `victim`. Builds `victim` and the plugins that it
# needs, and sets `victim_args` to its options. The variable BUILD_DIR may name another build
# folder, build-asan for example.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${BUILD_DIR:-$root/build}
[ -f "$build/build.ninja" ] || meson setup "$build" "$root" >"$build.log" 2>&1
ninja -C "$build" attacked >"$build.log" 2>&1 || { tail -20 "$build.log" >&2; exit 1; }
victim_args=(--victim "$build/tests/system/adversary/victim"
  --sanitizers "$(meson introspect "$build" --buildoptions | jq -r '.[] | select(.name == "b_sanitize") | .value')")
GST_PLUGIN_PATH_1_0=$(find "$build/gst" "$build/ext" -name 'libgst*.so' -printf '%h\n' | sort -u | paste -sd:)
export GST_PLUGIN_PATH_1_0 GST_REGISTRY=$build/victim-registry.bin GST_REGISTRY_FORK=no
