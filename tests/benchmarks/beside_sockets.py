#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs scream-bench and another flow through one lidar-link, over real sockets.

Prints the rate and the loss of both flows. A case is KIND_QUEUE_RATE: cubic_fifo_10ms_20M, reno_fifo_5ms_20M,
prague_ramp_20M, prague_step_1ms_20M, cubic_dualpi2_20M, cubic_pi2_20M (PI2 without L4S). cubic, reno and prague are greedy flows
of tcp-flow, udpprague is the L4S team's program (--udp-prague FOLDER, where it was built), gcc a stream of pion's Google
Congestion Control (Debian: golang-go golang-github-pion-interceptor-dev).
"""
import argparse
import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import build_tree  # noqa: E402

CASES = ["cubic_fifo_15ms_8M", "cubic_fifo_5ms_20M", "cubic_fifo_10ms_20M", "cubic_fifo_5ms_50M",
         "cubic_fifo_10ms_50M", "cubic_fifo_20ms_20M", "cubic_fifo_100ms_20M", "cubic_pi2_20M", "prague_ramp_4M",
         "prague_ramp_8M", "prague_ramp_20M", "prague_step_1ms_20M", "prague_step_3ms_20M", "prague_dualpi2_20M"]
RTT_MS = 40
SHORTEST_FIFO = 10 * 1500  # the smallest size of a FIFO [bytes]
PEER_CASES = ["udpprague_ramp_4M", "udpprague_ramp_8M", "udpprague_ramp_20M", "udpprague_step_1ms_20M",
              "udpprague_dualpi2_20M", "gcc_fifo_100ms_8M", "gcc_fifo_100ms_20M", "gcc_dualpi2_20M"]
# The time by which the other flow starts later than the flow of this project [s].
START_S = 1.0
SETTLE_S = 10.0
LINK_PORT, RX_PORT = 45204, 45304


def parse_case(name):
    """Returns the kind of the other flow, options of the link, and the rate [bit/s]."""
    parts = name.split("_")
    kind, rate = parts[0], float(parts[-1].rstrip("M"))
    options = ["--rate", str(rate), "--rtt", str(RTT_MS)]
    if parts[1] == "fifo":
        length = float(parts[2].removesuffix("ms"))
        options += ["--aqm", "none", "--queue-bytes", str(int(max(SHORTEST_FIFO, rate * length * 125)))]
    else:
        options += ["--aqm", parts[1]]
        if parts[1] == "step":
            options += ["--aqm-high", parts[2].removesuffix("ms")]
        # PI2 is used without L4S, as by most AQMs that are deployed.
        if parts[1] == "pi2":
            options.append("--aqm-classic")
    return kind, options, rate * 1e6


def build_gcc_flow(folder):
    program = folder / "gcc_flow"
    offline = {"GO111MODULE": "off", "GOPATH": "/usr/share/gocode", "GOCACHE": str(folder / "cache")}
    subprocess.run(["go", "build", "-o", program, "."], cwd=pathlib.Path(__file__).parent / "gcc_flow",
                   env=os.environ | offline, check=True)
    return program


class OtherFlow:
    """Commands of the other flow's receiver and sender."""

    def __init__(self, build, udp_prague, cases, folder):
        self._tcp_flow = build / "tests/benchmarks/tcp-flow"
        self._udp_prague = udp_prague
        self._gcc_flow = build_gcc_flow(folder) if any(case.startswith("gcc_") for case in cases) else None

    def receiver(self, kind, port):
        if kind == "udpprague":
            return [self._udp_prague / "udp_prague_receiver", "-q", "-a", "127.0.0.1", "-p", port]
        return [self._gcc_flow if kind == "gcc" else self._tcp_flow, "rx", port]

    def sender(self, kind, port):
        if kind == "udpprague":
            return [self._udp_prague / "udp_prague_sender", "-q", "-c", "-a", "127.0.0.1", "-p", port]
        if kind == "gcc":
            return [self._gcc_flow, "tx", f"127.0.0.1:{port}"]
        return [self._tcp_flow, "tx", f"127.0.0.1:{port}", "--kind", kind]


def start(command, log):
    with open(log, "w") as out:
        return subprocess.Popen([str(word) for word in command], stdout=out, stderr=out)


def stop(processes):
    for process in processes:
        process.send_signal(signal.SIGINT)
        time.sleep(0.2)
    for process in processes:
        try:
            process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def run(build, other, name, seconds, folder):
    kind, options, _ = parse_case(name)
    bench, link = build / "src/tools/scream-bench", build / "src/tools/lidar-link"
    receivers = [start([bench, "rx", "--port", RX_PORT], folder / "rx.txt"),
                 start(other.receiver(kind, RX_PORT + 1), folder / "other_rx.txt")]
    command = [link, "--quiet", "--log", folder / "link.csv", "--summary", folder / "link.json"] + options
    for i in range(2):
        command += ["--listen", f"127.0.0.1:{LINK_PORT + i}", "--forward", f"127.0.0.1:{RX_PORT + i}"]
    relay = start(command, folder / "link.txt")
    time.sleep(0.5)
    senders = [start([bench, "tx", "--host", "127.0.0.1", "--port", LINK_PORT, "--ecn", "ect1", "--fps", 50,
                      "--max-bitrate", "100M"], folder / "tx.txt")]
    time.sleep(START_S)
    senders.append(start(other.sender(kind, LINK_PORT + 1), folder / "other_tx.txt"))
    time.sleep(seconds)
    stop(senders + receivers + [relay])
    return measure(folder, seconds)


def measure(folder, seconds):
    """Returns Mbit/s and loss of both flows, ours first."""
    delivered, lost, sent = [0, 0], [0, 0], [0, 0]
    sojourn = []
    with open(folder / "link.csv") as log:
        for row in csv.DictReader(log):
            at, flow = float(row["time_s"]), min(int(row["flow"]), 1)
            if at < SETTLE_S or at > seconds:
                continue
            sent[flow] += 1
            if row["fate"] == "delivered":
                delivered[flow] += int(row["size"])
                sojourn.append(float(row["sojourn_ms"]))
            else:
                lost[flow] += 1
    mbps = [b * 8 / 1e6 / (seconds - SETTLE_S) for b in delivered]
    sojourn.sort()
    return {"ours_mbps": mbps[0], "theirs_mbps": mbps[1],
            "ratio": max(mbps) / max(min(mbps), 1e-3),
            "our_loss": lost[0] / max(sent[0], 1), "their_loss": lost[1] / max(sent[1], 1),
            "queue_p95_ms": sojourn[int(0.95 * len(sojourn))] if sojourn else 0.0}


def row(name, runs):
    def each(text):
        return ", ".join(text(m) for m in runs)

    return " | ".join([
        f"| `{name}`", each(lambda m: f"{m['ours_mbps']:.1f} / {m['theirs_mbps']:.1f}"), each(lambda m: f"{m['ratio']:.1f}"),
        each(lambda m: f"{100 * m['our_loss']:.2f} / {100 * m['their_loss']:.2f}"),
        each(lambda m: f"{m['queue_p95_ms']:.1f}")]) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", help="by default: " + " ".join(CASES) + "; with peers: " + " ".join(PEER_CASES))
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2] / "build")
    parser.add_argument("--udp-prague", type=pathlib.Path, metavar="FOLDER",
                        help="of a built udp_prague_sender and udp_prague_receiver")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--runs", type=int, default=1, help="of each case")
    parser.add_argument("--json", help="write the figures there")
    args = parser.parse_args()
    os.environ.update(build_tree.environment(args.build))
    cases = args.cases or CASES
    if args.udp_prague is None and any(case.startswith("udpprague_") for case in cases):
        parser.error("udpprague needs --udp-prague FOLDER: build https://github.com/L4STeam/udp_prague there")
    results = {}
    programs = tempfile.TemporaryDirectory(prefix="beside-")
    other = OtherFlow(args.build, args.udp_prague, cases, pathlib.Path(programs.name))
    print("| case | ours / other [Mbit/s] | ratio | own / other's loss [%] | queue p95 [ms] |\n|---|---|---|---|---|")
    for name in cases:
        results[name] = []
        for _ in range(args.runs):
            with tempfile.TemporaryDirectory(prefix="beside-") as folder:
                results[name].append(run(args.build, other, name, args.seconds, pathlib.Path(folder)))
        print(row(name, results[name]), flush=True)
    if args.json:
        with open(args.json, "w") as out:
            json.dump(results, out, indent=2)
    return 0


if __name__ == "__main__":
    sys.exit(main())
