# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/two-links.md. A row of drives is three runs in real time: an idle machine, as root."""
import common


def drives():
    """Two generated drives, alone and together, beside a sender that knew them."""
    return common.as_printed(
        common.run("chrt", "-r", 10, common.ROOT / "tests/benchmarks/two_links.py", "--build", common.build)
    )


def simulated(what):
    return common.as_printed(common.run(common.program("bonding-matrix"), what))


TABLES = {
    "drives": drives,
    "pairs": lambda: simulated("drives"),
    "one-bottleneck": lambda: simulated("one-bottleneck"),
}
