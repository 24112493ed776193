#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs every rule of this folder over the tree, without a build. Git hooks can call this script.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
failed=0
for rule in dependencies.py packaging.py pages.py paths.py reference.py versions.py links.sh widths.sh; do
  "$here/$rule" "$root" || failed=1
done
"$here/words.py" || failed=1
exit $failed
