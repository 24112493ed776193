#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs lidarodometry and other odometries over the same points, and prints the table of docs/results/odometry.md.

A peer is a program, built outside of this tree, that is called as

    PROGRAM FOLDER POSES.tum

It reads a sequence of KITTI's layout, as `lidar-eval to-kitti` writes it: velodyne/*.bin (x y z 0 as F32), phases/*.bin
(when each point was sampled, as part of its sweep of 0.1 s; straight scans have none) and times.txt (the middle of each
sweep). It writes a pose a scan, with its own time, in TUM's format.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The source and the seed of each drive. The speed is 14 m/s. No parameter was tuned on these seeds.
DRIVES = [
    ("os0-32:street", 12), ("os0-32:town", 12), ("os0-32:field", 12),
    ("os1-64:street", 14), ("os1-64:town", 14), ("os1-64:field", 14),
    ("os1-128:street:1024", 16),
]
FAULTED = ["os0-32:field", "os1-64:street"]
FAULTS = {
    "": [],
    "5 cm": ["--step", "0.1"],
    "3 % lost": ["--lost-scans", "0.03"],
    "half the beams": ["--every-beam", "2"],
    "1 s gap": ["--gap", "1"],
}
START = 20  # the number of scans that count as the start
HEAD = ["ATE [m]", "drift [%]", "RPE [m]", "CPU of a scan [ms]", "memory [MB]", "start lost"]


def measure(command):
    """Returns the output of a command, its processor time [s] and its largest memory [MB]."""
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, text=True) as process:
        text = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))} failed")
    return text, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def head_of(path, scans):
    """Writes the first poses of a trajectory to a second file. Returns its path."""
    lines = [line for line in path.read_text().splitlines() if line and line[0] != "#"]
    short = path.with_suffix(".start")
    short.write_text("\n".join(lines[:scans]) + "\n")
    return short


class Bench:
    def __init__(self, lidar_eval, peers, scans):
        self.lidar_eval, self.peers, self.scans = lidar_eval, peers, scans

    def error(self, truth, estimate):
        return json.loads(measure([self.lidar_eval, "ate", truth, estimate, "--json"])[0])

    def figures(self, truth, estimate, cpu_s, memory_mb, scans):
        """Returns the figures of HEAD; the last one is a truth value."""
        error, start = self.error(truth, estimate), self.error(truth, head_of(estimate, START))
        drift = f"{100 * error['drift']:.2f}" if "drift" in error else "–"
        return [f"{error['ate_rmse_m']:.3f}", drift, f"{error['rpe_rmse_m']:.3f}", f"{1000 * cpu_s / scans:.0f}",
                f"{memory_mb:.0f}", start["end_error_m"] > 0.1 * start["length_m"]]

    def row(self, source, options, label):
        """Fills each cell with the figures of all odometries, ours first. They read one folder, so that times and
        memory compare."""
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary) / "scans"
            measure([self.lidar_eval, "to-kitti", source, *options, "-o", folder])
            truth = f"kitti:{folder}"
            scans = len((folder / "times.txt").read_text().split())
            poses = pathlib.Path(temporary) / "poses.tum"
            ours = [self.lidar_eval, "slam", f"kitti:{folder}", "--out", poses, "--json"]
            commands = {"lidarodometry": ours, **{name: [program, folder, poses] for name, program in self.peers.items()}}
            found = {}
            for name, command in commands.items():
                _, cpu, memory = measure(command)
                found[name] = self.figures(truth, poses, cpu, memory, scans)
        lost = ", ".join(name for name, figures in found.items() if figures[-1])
        return [label, *("/".join(cells) for cells in list(zip(*found.values()))[:-1]), lost or "–"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lidar-eval", default=ROOT / "build/src/tools/lidar-eval")
    parser.add_argument("--peer", action="append", default=[], metavar="NAME=PROGRAM", help="another odometry; repeatable")
    parser.add_argument("--scans", type=int, default=120, help="of each synthetic drive")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=SOURCE",
                        help="scans with a truth, such as KITTI00=kitti:FOLDER, in place of the synthetic drives; repeatable")
    parser.add_argument("--only", default="", metavar="TEXT", help="synthetic drives whose name has it, such as os0-32")
    parser.add_argument("--quick", action="store_true", help="one drive as it is")
    arguments = parser.parse_args()
    bench = Bench(arguments.lidar_eval, dict(pair.split("=", 1) for pair in arguments.peer), arguments.scans)
    print(f"| drive | {' | '.join(HEAD)} |\n|" + "---|" * (1 + len(HEAD)))

    def show(source, options, label):
        print(f"| {' | '.join(bench.row(source, options, label))} |", flush=True)

    for pair in arguments.set:
        name, source = pair.split("=", 1)
        for fault, options in FAULTS.items():
            show(source, options, ", ".join(filter(None, [name, fault])))
    for drive, seed in [] if arguments.set else DRIVES[:1] if arguments.quick else DRIVES:
        if arguments.only not in drive:
            continue
        options = ["--speed", 14, "--seed", seed, "--scans", arguments.scans]
        for fault, more in FAULTS.items():
            if not fault or (drive in FAULTED and not arguments.quick):
                name = drive.upper().replace(":1024", "").replace(":", " ").split()
                label = ", ".join(filter(None, [f"{name[0]} {name[1].lower()}", fault]))
                show(f"synth:{drive}", [*options, *more], label)


if __name__ == "__main__":
    main()
