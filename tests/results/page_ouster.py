# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/ouster.md: those that tests/benchmarks/ouster_src.py prints."""
import common

BENCHMARK = common.ROOT / "tests/benchmarks/ouster_src.py"


def load():
    usual = common.run(BENCHMARK, "load", "--tool", common.program("ouster-replay"), "--seconds", 8, "--speeds", 1, 2)
    most = common.run(BENCHMARK, "load", "--tool", common.program("ouster-replay"), "--seconds", 6, "--speeds", 8, 12, "--modes", "2048x10")
    return common.as_printed(usual) + "\n" + "\n".join(common.as_printed(most).splitlines()[2:])


def recovery():
    return common.as_printed(common.run(BENCHMARK, "recovery", "--tool", common.program("ouster-replay")))


TABLES = {"load": load, "recovery": recovery}
