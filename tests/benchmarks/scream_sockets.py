#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the scenarios of docs/results/scream.md over real sockets and prints the table.

Sender and receiver are scream-bench, or the programs of EricssonResearch/scream, as processes of
their own; lidar-link is between them, and its packet log is measured.
"""
import argparse
import contextlib
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import build_tree  # noqa: E402

RAMP = ["--aqm", "ramp"]
STEPS = ["--steps", "12,4,8,3,15,6,10", "--step-time", "8", "--once", "--rtt", "40"] + RAMP
# name: (description, link options, ECN, frames/s, seconds)
SCENARIOS = {
    "frames_20M_rtt25": ("20 Mbit/s, RTT 25, ramp 2-10 ms", ["--rate", "20", "--rtt", "25"] + RAMP, "ect1", 50, 40),
    "frames_8M_rtt40": ("8 Mbit/s, RTT 40, ramp", ["--rate", "8", "--rtt", "40"] + RAMP, "ect1", 50, 40),
    "frames10_8M_rtt40": ("8 Mbit/s at 10 frames/s", ["--rate", "8", "--rtt", "40"] + RAMP, "ect1", 10, 40),
    "frames_8M_fifo100_notect": ("8 Mbit/s, no ECN, FIFO 100 ms", ["--rate", "8", "--rtt", "40", "--queue", "100"], "off", 50, 40),
    "frames_steps_rtt40": ("steps 12,4,8,3,15,6,10 every 8 s, ramp", STEPS, "ect1", 50, 56),
    "frames10_steps_rtt40": ("the steps at 10 frames/s", STEPS, "ect1", 10, 56),
    "frames_20M_loss0.5": ("20 Mbit/s with 0.5 % random loss", ["--rate", "20", "--rtt", "25", "--loss", "0.5"] + RAMP, "ect1", 50, 40),
    "frames_20M_loss1.0": ("20 Mbit/s with 1 % random loss", ["--rate", "20", "--rtt", "25", "--loss", "1"] + RAMP, "ect1", 50, 40),
    "frames_20M_loss2.0": ("20 Mbit/s with 2 % random loss", ["--rate", "20", "--rtt", "25", "--loss", "2"] + RAMP, "ect1", 50, 40),
    "frames_drop_10M_to_3M": ("10 -> 3 Mbit/s at 20 s, ramp",
          ["--steps", "10,3", "--step-time", "20", "--once", "--rtt", "40"] + RAMP, "ect1", 50, 40),
    "frames_20M_two_flows": ("two flows on 20 Mbit/s, ramp", ["--rate", "20", "--rtt", "25"] + RAMP, "ect1", 50, 40),
    "frames_8M_fifo10_notect": ("8 Mbit/s, Not-ECT, FIFO 10 ms", ["--rate", "8", "--rtt", "40", "--queue", "10"], "off", 50, 40),
}
# These scenarios send slices of a LiDAR instead of frames: 80 slices per second, whose sizes vary
# by 10 %.
SLICES_FPS, SLICES_JITTER = 80, 10
for _name in [n for n in SCENARIOS if n.startswith("frames_") and not n.endswith(("loss0.5", "loss2.0"))]:
    _text, _link, _ecn, _, _seconds = SCENARIOS[_name]
    SCENARIOS[_name.replace("frames", "slices")] = (_text + ", slices", _link, _ecn, SLICES_FPS, _seconds)
SETTLE_S = 5.0
LINK_PORT, RX_PORT = 45004, 45104  # the ports of the first flow with --port-offset 0


def percentile(values, p):
    """The nearest-rank percentile of a sorted list."""
    if not values:
        return 0.0
    rank = max(1, -(-len(values) * p // 100))
    return values[int(rank) - 1]


class SenderHost:
    """A network namespace for senders: the reference binds the port that it sends to."""

    NAME, LINK_ADDRESS, ADDRESS = f"scream{os.getpid()}", "10.213.45.1", "10.213.45.2"

    def __enter__(self):
        if os.geteuid() != 0:
            sys.exit("The reference's sender needs a network namespace of its own: run as root.")
        far = self.NAME + "b"
        near = self.NAME + "a"
        for command in (["netns", "add", self.NAME],
                        ["link", "add", near, "type", "veth", "peer", "name", far, "netns", self.NAME],
                        ["addr", "add", self.LINK_ADDRESS + "/24", "dev", near],
                        ["link", "set", near, "up"],
                        ["-n", self.NAME, "addr", "add", self.ADDRESS + "/24", "dev", far],
                        ["-n", self.NAME, "link", "set", far, "up"],
                        ["-n", self.NAME, "link", "set", "lo", "up"]):
            subprocess.run(["ip"] + command, check=True)
        return self

    def __exit__(self, *_):
        subprocess.run(["ip", "netns", "del", self.NAME], check=False)

    def prefix(self):
        return ["ip", "netns", "exec", self.NAME]


class Peers:
    """Command lines of senders and receivers, ours and the reference's."""

    def __init__(self, build, reference, host, port_offset=0):
        self.host = host
        self.link_port, self.rx_port = LINK_PORT + port_offset, RX_PORT + port_offset
        self.address = host.LINK_ADDRESS if host else "127.0.0.1"
        self.bench = str(build / "src/tools/scream-bench")
        self.link = str(build / "src/tools/lidar-link")
        self.reference = reference

    def sender(self, kind, port, ecn, fps, summary):
        prefix = self.host.prefix() if self.host else []
        if kind == "ours":
            return prefix + [self.bench, "tx", "--host", self.address, "--port", str(port), "--ecn", ecn,
                    "--fps", str(fps), "--frame-jitter", str(SLICES_JITTER if fps == SLICES_FPS else 0), "--max-bitrate", "60M", "--summary", summary]
        ect = {"ect1": "1", "ect0": "0", "off": "-1"}[ecn]
        return prefix + [str(self.reference / "scream_bw_test_tx"), "-ect", ect, "-fps", str(fps), "-initrate", "1000",
                "-minrate", "100", "-maxrate", "60000", "-nosummary", self.address,
                str(port)]

    def receiver(self, kind, port, summary, sender):
        if kind == "ours":
            num_reports = "ericsson" if sender == "reference" else "count"
            return [self.bench, "rx", "--port", str(port), "--num-reports", num_reports, "--summary", summary]
        return [str(self.reference / "scream_bw_test_rx"), str(port)]


class Run:
    """One scenario with one pair of peers: starts the processes and measures the link's log."""

    def __init__(self, peers, name, senders, receiver, seconds, folder):
        self.peers, self.name, self.senders, self.receiver = peers, name, senders, receiver
        _, self.options, self.ecn, self.fps, default = SCENARIOS[name]
        self.seconds = seconds or default
        self.folder = folder

    def execute(self):
        processes = []

        def start(command, log):
            with open(self.folder / log, "w") as out:
                processes.append(subprocess.Popen(command, stdout=out, stderr=out))
            return processes[-1]

        flows = range(len(self.senders))
        link = [self.peers.link, "--quiet", "--log", str(self.folder / "link.csv"), "--summary",
                str(self.folder / "link.json")] + self.options
        for i in flows:
            link += ["--listen", f"{self.peers.address}:{self.peers.link_port + i}", "--forward", f"127.0.0.1:{self.peers.rx_port + i}"]
            start(self.peers.receiver(self.receiver, self.peers.rx_port + i, str(self.folder / f"rx{i}.json"),
                                      self.senders[i]), f"rx{i}.txt")
        start(link, "link.txt")
        time.sleep(0.5)
        for i in flows:
            start(self.peers.sender(self.senders[i], self.peers.link_port + i, self.ecn, self.fps,
                                    str(self.folder / f"tx{i}.json")), f"tx{i}.txt")
        time.sleep(self.seconds)
        # The senders are stopped first, then the receivers, and last the link, which then writes
        # its summary.
        count = len(self.senders)
        order = processes[count + 1:] + processes[:count] + [processes[count]]
        for p in order:
            p.send_signal(signal.SIGINT)
            time.sleep(0.2)
        for p in order:
            try:
                p.wait(timeout=5)
            except subprocess.TimeoutExpired:
                p.kill()
                p.wait()
        return self.measure(count)

    def measure(self, flows):
        sojourn, loss, sent, ages = [], 0, 0, []
        per_flow = [0] * flows
        link = json.load(open(self.folder / "link.json"))
        until = self.seconds - 0.5
        ports = {}
        with open(self.folder / "link.csv") as log:
            for row in csv.DictReader(log):
                at = float(row["time_s"])
                if at < SETTLE_S or at > until:
                    continue
                sent += 1
                if row["fate"] != "delivered":
                    loss += row["fate"] != "lost"
                    continue
                sojourn.append(float(row["sojourn_ms"]))
                flow = ports.setdefault(row["flow"], len(ports))
                per_flow[min(flow, flows - 1)] += int(row["size"])
        sojourn.sort()
        for i in range(flows):
            path = self.folder / f"rx{i}.json"
            if path.exists():
                ages.append(json.load(open(path))["frame_age_ms"])
        capacity = self.mean_capacity(SETTLE_S, until, link)
        total = sum(per_flow)
        return {
            "utilisation": total * 8 / (until - SETTLE_S) / capacity,
            "queue_ms": [percentile(sojourn, 50), percentile(sojourn, 95), percentile(sojourn, 99),
                         sojourn[-1] if sojourn else 0.0],
            "frame_ms": [ages[0][k] for k in ("p50", "p95", "p99", "max")] if ages else None,
            "own_loss": loss / max(sent, 1),
            "jain": total ** 2 / (flows * sum(b * b for b in per_flow)) if total else 0.0,
            "packets": sent,
        }

    def mean_capacity(self, start, end, link):
        """Returns the mean capacity [bit/s] of a constant rate or of steps."""
        if "--rate" in self.options:
            return float(self.options[self.options.index("--rate") + 1]) * 1e6
        steps = [float(s) for s in self.options[self.options.index("--steps") + 1].split(",")]
        length = float(self.options[self.options.index("--step-time") + 1])
        bits, ticks, t = 0.0, 0, start
        while t < end:
            bits += steps[min(int(t / length), len(steps) - 1)]
            ticks += 1
            t += 0.01
        return bits / ticks * 1e6


def print_header():
    print(f"{'scenario':24} {'sender':>9} {'receiver':>9}  {'util %':>6}  {'queue p50/p95/p99/max ms':>26}  "
          f"{'frame p50/p95/p99/max ms':>28}  {'own loss %':>10}  {'Jain':>5}")


def print_row(name, sender, receiver, m):
    queue = "/".join(f"{v:.1f}" for v in m["queue_ms"])
    frame = "/".join(f"{v:.0f}" for v in m["frame_ms"]) if m["frame_ms"] else "-"
    print(f"{name:24} {sender:>9} {receiver:>9}  {100 * m['utilisation']:6.1f}  {queue:>26}  {frame:>28}  "
          f"{100 * m['own_loss']:10.2f}  {m['jain']:5.3f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", help="which (all by default): " + " ".join(SCENARIOS))
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2] / "build")
    parser.add_argument("--reference", type=pathlib.Path, help="folder of scream_bw_test_tx and _rx")
    parser.add_argument("--peers", default="ours-ours",
                        help="comma-separated pairs sender-receiver of 'ours' and 'reference'")
    parser.add_argument("--mixed-flows", action="store_true", help="two_flows: the second sender is the reference's")
    parser.add_argument("--seconds", type=float, help="of each run, instead of the scenario's own")
    parser.add_argument("--port-offset", type=int, default=0, help="to run two of these side by side")
    parser.add_argument("--json", help="write the figures there")
    parser.add_argument("--keep", type=pathlib.Path, help="keep the logs in this folder")
    args = parser.parse_args()
    pairs = [p.split("-") for p in args.peers.split(",")]
    if any("reference" in p for p in pairs) and not args.reference:
        parser.error("--peers with 'reference' needs --reference FOLDER")
    unknown = [s for s in args.scenarios if s not in SCENARIOS]
    if unknown:
        parser.error("no such scenario: " + " ".join(unknown))
    os.environ.update(build_tree.environment(args.build))
    with contextlib.ExitStack() as stack:
        needs_host = args.mixed_flows or any(p[0] == "reference" for p in pairs)
        host = stack.enter_context(SenderHost()) if needs_host else None
        results = run_all(args, pairs, Peers(args.build, args.reference, host, args.port_offset))
    if args.json:
        with open(args.json, "w") as out:
            json.dump(results, out, indent=2)
    return 0


def run_all(args, pairs, peers):
    results = []
    print_header()
    for name in args.scenarios or SCENARIOS:
        for sender, receiver in pairs:
            folder = pathlib.Path(tempfile.mkdtemp(prefix="scream-"))
            senders = [sender] + (["reference" if args.mixed_flows else sender] if name.endswith("two_flows") else [])
            m = Run(peers, name, senders, receiver, args.seconds, folder).execute()
            print_row(name, "+".join(dict.fromkeys(senders)), receiver, m)
            results.append({"scenario": name, "sender": sender, "receiver": receiver, **m})
            if args.keep:
                shutil.copytree(folder, args.keep / f"{name}-{sender}-{receiver}", dirs_exist_ok=True)
            shutil.rmtree(folder)
    return results


if __name__ == "__main__":
    sys.exit(main())
