# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/fleet.md. They need nats-server and an idle machine."""
import re

import common

ROBOTS = (1, 8, 16, 30)


def nats():
    """What a stream costs natssink, natssrc and the server."""
    body = []
    for streams, seconds, kept in ((1, 10, ()), (20, 30, ()), (20, 30, ("jetstream",))):
        text = common.run(common.program("nats-bench"), streams, seconds, *kept)
        latency = re.search(r"received (\d+) of (\d+); latency p50 ([\d.]+) ms, p99 ([\d.]+) ms, most ([\d.]+) ms", text)
        cost = dict(re.findall(r"^(\w+) +([\d.]+) % of a core", text, re.M))
        memory = re.search(r"each stream, (\d+) MB", text)[1]
        body.append([
            streams, "to disk" if kept else "–", f"{latency[1]} of {latency[2]}", *(f"{latency[i]} ms" for i in (3, 4, 5)),
            *(f"{cost[name]} %" for name in ("natssink", "natssrc", "server")), f"{memory} MB",
        ])
    head = ["streams", "JetStream", "arrived", "latency p50", "p99", "most", "`natssink`", "`natssrc`", "server", "server's memory"]
    return common.table(head, body)


def edge():
    """What a robot costs lidar-edge."""
    body = []
    for robots in ROBOTS:
        text = common.run(common.ROOT / "tests/elements/nats/edge_load.sh", robots, 20)
        core, slice_us = re.search(r"([\d.]+) % of a core for each robot, (\d+) us", text).groups()
        listening, receiving = re.search(r"memory ([\d.]+) MB listening, ([\d.]+) MB", text).groups()
        dropped, lost = re.search(r"dropped (\d+), lost (\d+)", text).groups()
        body.append([robots, f"{core} %", f"{slice_us} µs", f"{listening} MB", f"{receiving} MB", int(dropped) + int(lost)])
    head = ["robots", "of a core for each robot", "for each slice", "memory, listening", "receiving", "dropped or lost"]
    return common.table(head, body)


TABLES = {"nats": nats, "edge": edge}
