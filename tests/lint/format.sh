#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Every C++ file is as clang-format leaves it.
set -euo pipefail
cd "$1"
find src gst ext tests docs/examples -name '*.cpp' -o -name '*.h' | xargs "$2" --dry-run -Werror
