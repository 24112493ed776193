# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/two-links.md. A row of drives is three runs in real time, which need an idle machine and root."""
import statistics

import common


def drives():
    """Two generated drives, alone and together, compared with a sender that knew them."""
    return common.as_printed(
        common.run("chrt", "-r", 10, common.ROOT / "tests/benchmarks/two_links.py", "--build", common.build)
    )


def simulated(what):
    return common.as_printed(common.run(common.program("bonding-matrix"), what))


def cells_of(text):
    """Returns the rows of the printed table, without its head."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def pairs_of(text):
    """Mean and worst of the pairs of drives; each encoder has a row."""
    rows = cells_of(text)
    body = []
    for encoder in dict.fromkeys(row[1] for row in rows):
        own = [row for row in rows if row[1] == encoder]
        percent = [[float(row[i]) for row in own] for i in (3, 4, 5)]
        delays = [list(zip(*(map(int, row[i].split(",")) for row in own))) for i in (6, 7)]
        body.append([
            encoder, f"{statistics.mean(float(row[2]) for row in own):.2f}",
            *(f"{statistics.mean(of):.2f}, {min(of):.2f}" for of in percent),
            *(f"{statistics.mean(of):.0f}, {max(of)}" for both in delays for of in both),
            f"{statistics.mean(float(row[8]) for row in own):.0f}",
        ])
    head = [
        "encoder", "Mbit/s", "in time [%]", "bound [%]", "late bound [%]", "p95 [ms]", "bound's", "p99 [ms]", "bound's",
        "sent twice [%]",
    ]
    return common.table(head, body)


TABLES = {
    "drives": drives,
    "pairs": lambda: pairs_of(simulated("drives")),
    "one-bottleneck": lambda: simulated("one-bottleneck"),
}
