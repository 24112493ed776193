# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/ecosystem.md, as tests/benchmarks/ecosystem.sh and the viewers of tests/system print them."""
import common


def part(name):
    text = common.run(common.ROOT / "tests/benchmarks/ecosystem.sh", "--build", common.build, "--only", name)
    return "\n".join(line for line in text.splitlines() if not line.startswith("#")).strip()


def viewers():
    return common.run(common.ROOT / "tests/system/viewers/measure.py").strip()


TABLES = {"ros2": lambda: part("ros2"), "web": lambda: part("web"), "viewers": viewers}
