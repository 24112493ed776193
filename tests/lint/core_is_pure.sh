#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The core has no framework, clock, socket or codec; siblings in src/ do not include each other.
set -uo pipefail
cd "$1" || exit 1
status=0

if grep -rnE '#include <(gst|glib|gio|draco|sys/socket)|steady_clock|system_clock' src \
  --include='*.cpp' --include='*.h' --exclude-dir=tools; then
  echo "src/ (src/tools excepted) must not use the above." >&2
  status=1
fi
if grep -rln '#include <draco/' gst ext src tests --include='*.cpp' --include='*.h' |
  grep -vE '^(ext/draco|tests)/'; then
  echo "Only ext/draco may include Draco's headers." >&2
  status=1
fi
for folder in ouster rate rtp scream link synth; do
  others="ouster|rate|rtp|scream|link|synth"
  case $folder in ouster | rate | rtp | synth) ;; *) others="$others|cloud" ;; esac
  if grep -rnE "#include \"src/($others)/" "src/$folder" | grep -v "#include \"src/$folder/"; then
    echo "src/$folder must not include its siblings." >&2
    status=1
  fi
done
exit $status
