# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/ecosystem.md, as tests/benchmarks/ecosystem.sh and tests/system print them."""
import common


def part(name):
    text = common.run(common.ROOT / "tests/benchmarks/ecosystem.sh", "--build", common.build, "--only", name)
    return "\n".join(line for line in text.splitlines() if not line.startswith("#")).strip()


def viewers():
    return common.run(common.ROOT / "tests/system/viewers/measure.py").strip()


def page(*arguments):
    return common.run("node", common.ROOT / "tests/system/browser/measure_page.mjs", *arguments).strip()


TABLES = {"ros2": lambda: part("ros2"), "web": lambda: part("web"), "page": page, "way": lambda: page("way"), "viewers": viewers}
