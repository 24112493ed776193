# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/security.md that a single command measures."""
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


TABLES = {"srtp": srtp}
