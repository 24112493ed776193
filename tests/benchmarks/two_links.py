#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Streams a recorded drive over two links and over each alone, over sockets, and compares it with what a sender that
knew them could deliver.

Without --trace the links are two drives that lidar-trace makes. A trace may be played from a later
second on: --trace A --trace B@37. A scan is in time if all its slices are decoded within 0.2 s of
their capture. Run it with real-time priority (chrt -r 10) on a machine that does nothing else.
"""
import argparse
import collections
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import build_tree  # noqa: E402
from ports import free_port  # noqa: E402

MAX_AGE_NS = 200_000_000
# The time at the start of a run in which scans do not count [s].
SETTLE_S = 3.0
CASES = {"first alone": (0,), "second alone": (1,), "both": (0, 1)}
HEAD = ("| links | scans | in time [%] | bound [%] | p50 [ms] | p95, bound [ms] | p99, bound [ms] | Mbit/s | sent twice [%] "
        "| saved packets |\n|---|---|---|---|---|---|---|---|---|---|")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--trace", action="append", default=[], metavar="FILE[@S]", help="of the links, twice")
    parser.add_argument("--pcap", type=pathlib.Path, help="an Ouster capture instead of a synthetic drive")
    parser.add_argument("--metadata", type=pathlib.Path, help="of --pcap")
    parser.add_argument("--max-error", type=float, default=0.05, help="[m]")
    parser.add_argument("--duration", type=float, default=60, help="of a run [s]")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--rtt", type=float, default=40, help="of each link [ms]")
    parser.add_argument("--case", action="append", choices=list(CASES), help="repeatable; without it all")
    parser.add_argument("--more", default="", help="properties of screamsink, in one string")
    parser.add_argument("--output", type=pathlib.Path, help="keep what the ends print in this folder")
    return parser.parse_args()


def traces(args, folder):
    """Returns file and start of each link's trace."""
    if args.trace:
        return [(pathlib.Path(t.partition("@")[0]), float(t.partition("@")[2] or 0)) for t in args.trace]
    made = []
    for seed in (1, 2):
        path = folder / f"drive_{seed}.txt"
        command = [args.build / "src/tools/lidar-trace", "--seed", str(seed)]
        path.write_bytes(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
        made.append((path, 0.0))
    return made


def rotated(trace, start, path):
    """Writes the trace turned to begin at `start` [s]: lidar-link begins with the first line."""
    steps = [tuple(map(float, line.split())) for line in trace.read_text().splitlines() if line.strip() and line[0] != "#"]
    end = steps[-1][0] + (steps[-1][0] - steps[-2][0])
    turned = sorted(((t - start) % end, rate) for t, rate in steps)
    path.write_text("".join(f"{t:.3f} {rate}\n" for t, rate in turned))
    return path


def source(args):
    if not args.pcap:
        return "lidartestsrc model=os1-64 mode=1024x10 scene=street speed=12 name=source is-live=true"
    metadata = f" metadata={args.metadata}" if args.metadata else ""
    return f"ouster_src location={args.pcap}{metadata} loop=true name=source is-live=true"


def start(command, log, **options):
    return subprocess.Popen([str(word) for word in command], stderr=open(log, "w"), **options)


def end_with(command, folder, name):
    """Starts a process of lidar-demo. Its records go to a file, its clouds to /dev/null."""
    words = " ".join(shlex.quote(str(w)) for w in command)
    out = open(folder / f"{name}.jsonl", "w")
    return start(["bash", "-c", f"exec {words} 3>/dev/null"], folder / f"{name}.log", stdout=out)


def stop(process):
    process.send_signal(signal.SIGINT)
    try:
        process.wait(8)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def stream(args, folder, used, files):
    demo, tools = args.build / "src/tools/lidar-demo", args.build / "src/tools"
    port, ports = free_port(), [free_port() for _ in used]
    receiver = end_with([demo, "receive", f"screamsrc name=receiver address=127.0.0.1 port={port} ! rtplidardepay name=depayloader "
                         "! lidardec name=decoder ! scanassembler name=assembler ! fakesink sync=false async=false"], folder, "receiver")
    links = [start([tools / "lidar-link", "--listen", f"127.0.0.1:{p}", "--forward", f"127.0.0.1:{port}", "--rtt", args.rtt,
                    "--trace", files[i], "--aqm", "ramp", "--aqm-low", 2, "--aqm-high", 10, "--quiet", "--log", folder / f"link{i}.csv"],
                   folder / f"link{i}.log") for i, p in zip(used, ports)]
    time.sleep(1)
    to = (f"host=127.0.0.1 port={ports[0]}" if len(used) == 1 else
          "bonding-addresses=" + ",".join(f"127.0.0.1:{p}@127.0.0.{n + 1}" for n, p in enumerate(ports)))
    sender = end_with([demo, "send", f"{source(args)} ! queue ! lidarenc name=encoder max-error={args.max_error} ! rtplidarpay "
                       f"! screamsink name=sender {to} start-bitrate=4000000 {args.more}"], folder, "sender")
    time.sleep(args.duration)
    for process in [sender, receiver, *links]:
        stop(process)


def records(folder, name):
    for line in open(folder / f"{name}.jsonl"):
        try:
            yield json.loads(line)
        except ValueError:
            continue


def last_words(folder, name):
    lines = (folder / f"{name}.log").read_text().splitlines()
    return "\n".join([f"The {name}'s last lines:", *lines[-5:]])


def judge(folder):
    """Returns the figures of one run."""
    captured, decoded, encoded, counts = {}, {}, 0, {}
    stats = {}
    for r in records(folder, "sender"):
        key = (r.get("scan"), r.get("slice"))
        if r["type"] == "captured":
            captured[key], counts[key[0]] = r["due_ns"], r["count"]
        elif r["type"] == "encoded":
            encoded += r["bytes"]
        elif r["type"] == "stats":
            stats = r.get("sender") or stats
    for r in records(folder, "receiver"):
        if r["type"] == "decoded":
            decoded.setdefault((r["scan"], r["slice"]), r["unix_ns"])
    if not captured or not decoded:
        sys.exit(f"No cloud came through.\n{last_words(folder, 'sender')}\n{last_words(folder, 'receiver')}")
    first, last = min(captured.values()), max(captured.values())
    scans = collections.defaultdict(list)
    for key, due in captured.items():
        if first + SETTLE_S * 1e9 <= due <= last - 1e9:
            scans[key[0]].append(decoded.get(key, 1 << 62) - due)
    whole = {scan: ages for scan, ages in scans.items() if len(ages) == counts[scan]}
    ages = sorted(age / 1e6 for of in whole.values() for age in of if age < 1 << 60)
    links = stats.get("links") or []
    first_packets = sum(l["packets-first"] for l in links)
    return {
        "scans": len(whole), "in_time": sum(max(of) <= MAX_AGE_NS for of in whole.values()), "ages": ages,
        "rate": 8 * encoded / ((last - first) / 1e9) / 1e6,
        "twice": 100 * (sum(l["packets-sent"] for l in links) / first_packets - 1) if first_packets else 0,
        "saved": sum(l["packets-saved"] for l in links),
    }


def percentile(values, share):
    return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def bound(args, used, files, rate):
    """Returns the share in time, p95 and p99 of a sender that knew the links."""
    command = [args.build / "src/tools/lidar-trace", "--rate", f"{rate:.3f}", "--duration", str(args.duration)]
    for i in used:
        command += ["--bound", files[i]]
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    row = next(line for line in text.splitlines() if line.startswith("all, where" if len(used) > 1 else files[used[0]].as_posix()))
    whole, _, p95, p99 = map(float, re.findall(r"[\d.]+", row[len(row.rstrip("0123456789. ")):]))
    return whole, p95, p99


def main():
    args = parse_arguments()
    os.environ.update(build_tree.environment(args.build))
    with tempfile.TemporaryDirectory() as name:
        folder = args.output or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        files = [rotated(*t, folder / f"trace{i}.txt") for i, t in enumerate(traces(args, folder))]
        print(HEAD)
        for case in args.case or CASES:
            runs = []
            for n in range(args.runs):
                of = folder / f"{case.replace(' ', '_')}_{n}"
                of.mkdir(exist_ok=True)
                stream(args, of, CASES[case], files)
                runs.append(judge(of))
            runs.sort(key=lambda r: r["in_time"] / max(r["scans"], 1))
            r = runs[len(runs) // 2]  # the median run
            share, p95, p99 = bound(args, CASES[case], files, r["rate"])
            all_shares = ", ".join(f"{100 * x['in_time'] / x['scans']:.1f}" for x in runs)
            print(f"| {case} | {r['scans']} | {all_shares} | {share:.1f} | {percentile(r['ages'], .5):.0f} "
                  f"| {percentile(r['ages'], .95):.0f}, {p95:.0f} | {percentile(r['ages'], .99):.0f}, {p99:.0f} | {r['rate']:.2f} "
                  f"| {r['twice']:.0f} | {r['saved']} |", flush=True)


if __name__ == "__main__":
    main()
