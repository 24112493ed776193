#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""usage: same_model.py SCRIPT LIDAR_TRAIN CAPTURES COMMITTED [MODES]

The committed rate model is what the script makes, except for the rounding of another machine.
MODES, separated by commas, limit it to these modes, which is faster.
"""
import json
import subprocess
import sys


def numbers(node, path=""):
    if isinstance(node, dict):
        for key, value in node.items():
            yield from numbers(value, f"{path}/{key}")
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from numbers(value, f"{path}/{index}")
    else:
        yield path, node


def main():
    script, train, captures, committed = sys.argv[1:5]
    modes = sys.argv[5:]
    made = json.loads(subprocess.check_output([script, train, captures, *modes]))
    with open(committed, encoding="utf-8") as file:
        kept = json.load(file)
    if modes:
        made = made["adaptive"]["modes"]
        kept = {mode: kept["adaptive"]["modes"].get(mode) for mode in made}
    made, kept = dict(numbers(made)), dict(numbers(kept))
    different = [path for path in made.keys() ^ kept.keys()]
    for path in made.keys() & kept.keys():
        a, b = made[path], kept[path]
        close = a == b if isinstance(a, str) else abs(a - b) <= 0.01 + 0.01 * abs(b)
        if not close:
            different.append(f"{path}: made {a}, committed {b}")
    print("\n".join(different))
    return 1 if different else 0


sys.exit(main())
