#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures the tables of docs/results, and writes them to these pages. The head of each table names
# the commit, the date and the machine.
set -euo pipefail
exec python3 -B "$(dirname "$0")/results/make.py" "$@"
