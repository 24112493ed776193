# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of `tests/benchmarks/controller.sh`, for the pages that show them."""
import functools
import re

import common

ROW = re.compile(r"^(\S+) +(.+?) +(-?[\d.]+)( +[<>] *-?[\d.]+ (?:met|MISSED))?$", re.M)


@functools.lru_cache
def figures(*options):
    """Case to its figures by name; each is its value, and whether it misses a goal."""
    found = {}
    text = common.run(common.ROOT / "tests/benchmarks/controller.sh", common.build, "--figures", *options)
    for case, figure, value, goal in ROW.findall(text):
        found.setdefault(case, {})[figure] = (float(value), goal.endswith("MISSED"))
    return found


def cell(of, names, digits, bold=True):
    """Figures of a case with slashes between. With `bold`, what misses a goal is bold."""
    cells = []
    for name in names:
        if name not in of:
            return "–"
        value, missed = of[name]
        text = f"{value:.{digits}f}"
        cells.append(f"**{text}**" if missed and bold else text)
    return "/".join(cells)
