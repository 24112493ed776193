# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/rmcat.md: the test cases of RFC 8867 and RFC 8869 in simulated time."""
import common
import controller

COLUMNS = {
    "utilisation [%]": ("util %", 0),
    "media [Mbit/s]": ("Mbit/s a flow", 2),
    "queue p95 [ms]": ("queue p95 [ms]", 0),
    "frame p95 [ms]": ("frame p95 [ms]", 0),
    "own loss [%]": ("loss %", 2),
    "frames dropped [%]": ("dropped %", 1),
    "Jain's index": ("Jain", 2),
    "others [Mbit/s]": ("others' Mbit/s", 2),
}


def rmcat():
    """Figures of ours / of the draft alone; a missed goal of ours is bold."""
    body = []
    ours, draft = (controller.figures("--group", "rfc", *more) for more in ([], ["--draft"]))
    for case, own in ours.items():
        row = [f"`{case}`"]
        for figure, (_, digits) in COLUMNS.items():
            cells = [controller.cell(own, [figure], digits), controller.cell(draft[case], [figure], digits, False)]
            row.append("–" if figure not in own else "/".join(cells))
        body.append(row)
    return common.table(["case", *(head for head, _ in COLUMNS.values())], body)


TABLES = {"rmcat": rmcat}
