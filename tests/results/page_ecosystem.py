# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/ecosystem.md, as tests/benchmarks/ecosystem.sh prints them."""
import common


def part(name):
    text = common.run(common.ROOT / "tests/benchmarks/ecosystem.sh", "--build", common.build, "--only", name)
    return "\n".join(line for line in text.splitlines() if not line.startswith("#")).strip()


TABLES = {"ros2": lambda: part("ros2"), "web": lambda: part("web")}
