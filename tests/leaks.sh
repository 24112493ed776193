#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs each script of pipelines/ and each pipeline that the docs print. Fails if a process has not
# freed all its GStreamer objects when it ends. GStreamer's leaks tracer reports such objects. Takes
# about five minutes, and needs a build.
set -uo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/pipelines/environment.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Scans the plugins here, before the tracer is enabled. A scanner process with the tracer would
# write no leak report, and would be counted as an error.
export GST_REGISTRY_1_0=$work/registry.bin
gst-inspect-1.0 >"$work/plugins" || { echo "FAILED: the plugins cannot be listed"; exit 1; }
export GST_REGISTRY_UPDATE=no GST_TRACERS=leaks GST_DEBUG=GST_TRACER:7,leaks:7 GST_DEBUG_NO_COLOR=1 GST_DEBUG_FILE=$work/log/%p
status=0

# The scripts call gst-inspect-1.0 to check which elements exist. This wrapper runs it without the
# tracer.
mkdir "$work/bin"
printf '#!/bin/sh\nGST_TRACERS= GST_DEBUG= exec %s "$@"\n' "$(command -v gst-inspect-1.0)" >"$work/bin/gst-inspect-1.0"
chmod +x "$work/bin/gst-inspect-1.0"
export PATH=$work/bin:$PATH

# look NAME COMMAND...: runs the command, and prints which objects its processes have not freed.
look() {
  local name=$1 alive processes silent
  shift
  rm -rf "$work/log"
  mkdir "$work/log"
  "$@" >"$work/output" 2>&1 || { cat "$work/output"; echo "FAILED: $name does not run"; status=1; return; }
  processes=$(find "$work/log" -type f -size +0 | wc -l)
  # GStreamer's dtlsdec keeps an agent for generated certificates until the process ends. This
  # object is not a leak.
  alive=$(grep -h 'object-alive, ' "$work"/log/* | sed -nE 's/.*type-name=\(string\)([A-Za-z]+).*/\1/p' | grep -v GstDtlsAgent | sort | uniq -c)
  # A process that was killed has written no report. Empty logs are not counted, because
  # gst-inspect-1.0 writes them.
  silent=$(find "$work/log" -type f -size +0 -exec grep -L 'listed [0-9]* alive objects' {} + | wc -l)
  # In this pipeline a process is refused because it is a stranger. It may be killed before it ends,
  # so it may have no report.
  [ "$name" != secure-dtls ] || silent=$((silent > 1 ? silent - 1 : 0))
  printf '%-18s %3d processes, %d of which ended without looking, objects left: %s\n' "$name" "$processes" "$silent" "${alive:-none}"
  [ -z "$alive" ] && [ "$silent" = 0 ] && [ "$processes" -gt 0 ] || status=1
}

for script in "$root"/pipelines/*.sh; do
  name=$(basename "$script" .sh)
  case $name in
    environment | options) continue ;;
    demo) arguments=(--no-install --no-build --duration 6 --no-plots --output "$work/demo") ;;
    lidar-and-video | rtpbin-video) arguments=(--duration 5) ;;
    webrtc) arguments=(--part 3) ;;
    play)
      "$root/pipelines/record.sh" --format slices --seconds 1 --output "$work/played" >/dev/null 2>&1
      arguments=(--to none "$work/played/rec-%05d.mcap") ;;
    record) arguments=(--scans 3 --output "$work/record") ;;
    view) arguments=(--output "$work/view") ;;
    *) arguments=(3) ;;
  esac
  look "$name" "$script" "${arguments[@]}"
done
look docs "$root/tests/pipelines/doc_pipelines.py" "$root"
exit $status
