#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures the tables of docs/results and writes them, each with commit, date and machine in its head.
set -euo pipefail
exec python3 -B "$(dirname "$0")/results/make.py" "$@"
