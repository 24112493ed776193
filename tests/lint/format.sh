#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Checks that clang-format would change no C++ file.
set -euo pipefail
cd "$1"
find src gst ext tests docs/examples -name '*.cpp' -o -name '*.h' | xargs "$2" --dry-run -Werror
