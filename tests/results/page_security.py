# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/security.md that a single command measures."""
import json
import re

import common


def srtp():
    """CPU time on top of a stream without SRTP."""
    text = common.run("chrt", "-r", 10, common.ROOT / "tests/benchmarks/srtp_overhead.py", common.build, 8)
    body = []
    for line in re.findall(r"^ *[\w-]+: .*bytes a packet$", text, re.M):
        name, sender, receiver, sender_us, receiver_us, size = re.match(
            r" *([\w-]+): ([+-][\d.]+) and ([+-][\d.]+) ms; +([\d.-]+) and +([\d.-]+) us and (\d+)", line
        ).groups()
        body.append([f"`{name}`", size, sender, receiver, sender_us, receiver_us])
    head = ["suite", "bytes a packet", "sender, ms a second", "receiver, ms a second", "sender, µs a packet", "receiver, µs a packet"]
    return text.splitlines()[0].capitalize() + "\n\n" + common.table(head, body)


def robot():
    """lidar-edge beside a robot whose slices take turns between two formats."""
    text = common.run(common.ROOT / "tests/system/adversary/hostile_robot.py", common.build, "--seconds", 600)
    without, beside = (json.loads(line) for line in text.splitlines())
    rows = [
        ["sent by that robot", f"{without['sent_mb']} MB", f"{beside['sent_mb']} MB"],
        ["most memory of lidar-edge", f"{without['memory_mb']} MB", f"{beside['memory_mb']} MB"],
        ["slices of the 19 others: received", f"{without['received']:.0f}", f"{beside['received']:.0f}"],
        ["slices of the 19 others: lost", f"{without['lost']:.0f}", f"{beside['lost']:.0f}"],
        ["slices of that robot: dropped, counted", "0", f"{beside['dropped']:.0f}"],
        ["time to stop", f"{without['stop_s']} s", f"{beside['stop_s']} s"],
    ]
    return common.table(["", "without it", "beside it"], rows)


TABLES = {"robot": robot, "srtp": srtp}
