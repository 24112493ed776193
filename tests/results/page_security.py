# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/security.md that a single command measures."""
import itertools
import json
import re

import common


def srtp():
    """CPU time on top of a stream without SRTP."""
    text = common.run("chrt", "-r", 10, common.ROOT / "tests/benchmarks/srtp_overhead.py", common.build, 8)
    body = []
    for line in re.findall(r"^ *[\w-]+: .*bytes a packet$", text, re.M):
        name, sender_us, receiver_us, size = re.match(
            r" *([\w-]+): .* ms; +([\d.-]+) and +([\d.-]+) us and (\d+)", line
        ).groups()
        body.append([f"`{name}`", size, sender_us, receiver_us])
    head = ["suite", "bytes a packet", "sender, µs a packet", "receiver, µs a packet"]
    return text.splitlines()[0].capitalize() + "\n\n" + common.table(head, body)


def robot():
    """What a robot whose slices take turns between two formats costs lidar-edge."""
    text = common.run(common.ROOT / "tests/system/adversary/hostile_robot.py", common.build, "--seconds", 600)
    without, beside = (json.loads(line) for line in text.splitlines())
    rows = [
        ["sent by that robot", f"{without['sent_mb']} MB", f"{beside['sent_mb']} MB"],
        ["most memory of lidar-edge", f"{without['memory_mb']} MB", f"{beside['memory_mb']} MB"],
        ["slices of the 19 others: received", f"{without['received']:.0f}", f"{beside['received']:.0f}"],
        ["slices of the 19 others: lost", f"{without['lost']:.0f}", f"{beside['lost']:.0f}"],
        ["packets of theirs: lost", f"{without['packets_lost']:.0f}", f"{beside['packets_lost']:.0f}"],
        ["slices of that robot: dropped, counted", "0", f"{beside['dropped']:.0f}"],
        ["time to stop", f"{without['stop_s']} s", f"{beside['stop_s']} s"],
    ]
    return common.table(["", "without it", "beside it"], rows)


def script(name, *arguments):
    """Returns the lines of JSON that a script of the adversary prints. It ends with 1 if a goal is missed, which its
    figures show."""
    text = common.run(common.ROOT / "tests/system/adversary" / name, common.build, *arguments, check=False)
    return [json.loads(line) for line in text.splitlines()]


def growth():
    """Costs of many connections, topics, robots, sensors and formats, and of a recording with compression bombs."""
    body = []
    for kind, runs in itertools.groupby(script("growth.py"), key=lambda run: run["kind"]):
        runs = list(runs)
        name = kind if len(runs) > 1 else f"{runs[0]['count']} {kind}"
        body.append([name, " / ".join(f"{run['cpu_s']:.2f}" for run in runs), max(run["memory_mb"] for run in runs),
                     f"{runs[-1]['told']:.0f}", max(run["stop_s"] for run in runs)])
    head = ["of a stranger", "processor time of 1,000 / 8,000 / 65,000 [s]", "most memory [MB]", "told", "longest stop [s]"]
    return common.table(head, body)


def decoding():
    """What a byte costs each decoder at worst, and a stream of such bytes."""
    text = common.run(common.program("decode-cost"), 20)
    body = [re.match(r"(.*): ([\d.]+) us a byte, at worst ([\d.]+), a slice of (\d+) bytes in ([\d.]+) ms", line).groups()
            for line in text.splitlines()]
    free, bounded = script("decode_load.py")
    return common.table(["coder", "dearest as coded [us a byte]", "dearest found [us a byte]", "that slice [bytes]", "[ms]"], body) + (
        f"\n\nA robot that sends the mixing coder's dearest bytes at {free['sent_mbps']:.0f} Mbit/s takes "
        f"{free['processor']:.2f} of a processor at `lidardec`, {bounded['processor']:.2f} with "
        f"`max-decode-load={bounded['load']}`, the socket included: {bounded['over']:.0f} slices are dropped and counted.")


TABLES = {"robot": robot, "growth": growth, "decoding": decoding, "srtp": srtp}
