#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs clang-tidy over the sources. It uses a build directory of its own, where each source file is
# compiled alone and without precompiled headers. So a missing #include is an error.
# Usage: tests/tidy.sh [BUILD_DIR] [PATH_REGEX]
set -uo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=${1:-$root/build-tidy}
paths=${2:-"$root/(src|gst|ext)/.*\\.cpp"}

command -v run-clang-tidy >/dev/null || { echo "Install the Debian package clang-tidy." >&2; exit 2; }
[ -f "$build/compile_commands.json" ] || meson setup "$build" "$root" -Db_pch=false >/dev/null || exit 2
findings=$(run-clang-tidy -quiet -j"$(nproc)" -p "$build" "$paths" 2>/dev/null | grep -E 'error:|warning:' | sort -u)
[ -z "$findings" ] && { echo "clang-tidy: no finding"; exit 0; }
echo "$findings"
exit 1
