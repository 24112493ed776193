# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/two-links.md. Each row is three runs in real time: an idle machine, as root."""
import common


def drives():
    """Two generated drives, alone and together, beside a sender that knew them."""
    return common.as_printed(
        common.run("chrt", "-r", 10, common.ROOT / "tests/benchmarks/two_links.py", "--build", common.build)
    )


TABLES = {"drives": drives}
