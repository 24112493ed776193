# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of `tests/benchmarks/controller.sh`, for the pages that show them."""
import functools
import re

import common

ROW = re.compile(r"^(\S+) +(.+?) +(-?[\d.]+)( +[<>] *-?[\d.]+ (?:met|MISSED))?$", re.M)


@functools.lru_cache
def figures(*options):
    """Returns {case: {name of a figure: (value, whether it misses a goal)}}."""
    found = {}
    text = common.run(common.ROOT / "tests/benchmarks/controller.sh", common.build, "--figures", *options)
    for case, figure, value, goal in ROW.findall(text):
        found.setdefault(case, {})[figure] = (float(value), goal.endswith("MISSED"))
    return found


def cell(of, names, digits, bold=True):
    """Returns figures of a case with slashes between. With `bold`, figures that miss a goal are bold."""
    cells = []
    for name in names:
        if name not in of:
            return "–"
        value, missed = of[name]
        text = f"{value:.{digits}f}"
        cells.append(f"**{text}**" if missed and bold else text)
    return "/".join(cells)
