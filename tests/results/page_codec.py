# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/codec.md."""
import json
import re

import common

MODES = {
    "effort 0": "range-adaptive",
    "effort 1": "range-mixing1",
    "effort 2": "range-mixing2",
    "effort 3": "range-mixing3",
    "Draco, sequential, on our ranges": "range-draco",
    "Draco, sequential, on x, y and z": "xyz-sequential",
    "Draco, kd-tree, on x, y and z": "xyz-kd6",
}
CODERS = {"effort 0": 3, "effort 1": 11, "effort 2": 12, "effort 3": 13}


def sizes():
    """Bits a return of every coder, within 2 and 5 cm."""
    columns = {}
    for source, path in common.SOURCES.items():
        rows = common.rate_distortion(
            path, "--modes", ",".join(MODES.values()), "--slices", "8", "--errors", "0.02,0.05"
        )
        for row in rows:
            mode = row["coding"].split(",")[0]
            columns.setdefault((source, mode), []).append(float(row["bits_per_return"]))
    body = [
        [name] + [" / ".join(f"{bits:.2f}" for bits in columns[source, mode]) for source in common.SOURCES]
        for name, mode in MODES.items()
    ]
    return common.table(["bits a return", *common.SOURCES], body)


def benchmark(pattern):
    text = common.run(
        common.program("codec-benchmark"),
        f"--benchmark_filter={pattern}",
        "--benchmark_format=json",
        "--benchmark_min_time=0.2",
    )
    return {row["name"]: row for row in json.loads(text)["benchmarks"]}


def speed():
    """Million returns a second of CPU time, encode and decode, within 2 cm."""
    rows = benchmark(r"(En|De)code/range/source:[01]/slices:[18]/.*intensity:0$")
    body = []
    for name, coder in CODERS.items():
        cells = []
        for source in (0, 1):
            for slices in (1, 8):
                case = f"range/source:{source}/slices:{slices}/coder:{coder}/error_mm:20/intensity:0"
                both = [rows.get(f"{way}/{case}") for way in ("Encode", "Decode")]
                speeds = [f"{row['returns/s'] / 1e6:.3g}" if row else "–" for row in both]
                cells.append(" / ".join(speeds))
        body.append([name, *cells])
    head = ["million returns/s", "OS0-32, whole", "OS0-32, 8 slices", "OS1-128, whole", "OS1-128, 8 slices"]
    return common.table(head, body)


def static():
    """Bits a return of a sensor that stands still."""
    text = common.lidar_eval("static", "synth:os1-64:street", "--errors", "0.02", "--scans", "60")
    rows = re.findall(r"^ +([123]) +20 +([\d.]+) +([\d.]+) +([\d.]+) +(\d+) %", text, re.M)
    head = ["effort", "without references", "with, all 60 scans", "second half", "slices that refer"]
    return common.table(head, [[*row[:4], row[4] + " %"] for row in rows])


# Bits per point for an error of 2 cm / 5 cm. The first text has the results of TMC13 with its
# predictive or its octree geometry, whichever is better. They were measured by hand on 2026-11-24.
# The second text has the goals.
PEERS = {
    "XT32": ("2.09 / 1.03", "1.2 / 0.75"),
    "Pandar64": ("1.87 / 0.70", "1.5 / 0.65"),
    "OT128": ("2.10 / 0.80", "1.9 / 0.78"),
    "AT128": ("4.70 / 2.27", "2.9 / 2.0"),
    "VLP-16": ("3.48 / 2.13", "2.8 / 1.8"),
    "VLS-128": ("6.83 / 5.25", "4.4 / 3.4"),
    "KITTI, as recorded": ("3.93 / 2.93", "2.4 / 1.65"),
    "OS0-32": ("2.56 / 2.17", "2.01 / 1.24"),
    "OS1-128": ("3.90 / 2.93", "2.66 / 1.90"),
    "Mid-360, synthetic": ("–", "0.6 of Draco"),
    **{name: ("–", "–") for name in ("Pandar40P", "QT64", "QT128", "XT16", "XT32M", "VLP-32")},
}


def cloud_rows(text):
    """Returns bits, and the times to encode and decode, by coder."""
    found = {}
    for coder, *numbers in re.findall(r"^ +\d+ mm  (Draco|effort \d) +([\d.]+)(?: +[\d.]+ +(\d+) +(\d+))?$", text, re.M):
        found.setdefault(coder, []).append(numbers)
    return found


def clouds():
    """Bits a point of clouds without a sensor model, and the speed at 2 cm."""
    efforts = ["effort 1", "effort 3"]
    body = []
    sources = {**common.CLOUDS, **common.SOURCES, "Mid-360, synthetic": "synth:mid-360:street"}
    for name, path in sources.items():
        if name not in PEERS:
            continue
        text = common.lidar_eval("clouds", path, "--efforts=1,3", "--scans=1", "--repeats=5")
        points = int(re.search(r"(\d+) points", text)[1])
        rows = cloud_rows(text)
        rows["shuffled"] = cloud_rows(
            common.lidar_eval("clouds", path, "--efforts=3", "--scans=1", "--shuffle")
        )["effort 3"]
        bits = [" / ".join(f"{float(row[0]):.2f}" for row in rows[coder]) for coder in ["Draco", *efforts, "shuffled"]]
        speed = " / ".join(f"{1e3 / float(ns):.1f}" for ns in rows["effort 1"][0][1:])
        peer, goal = PEERS[name]
        body.append([name, f"{points:,}", bits[0], peer, *bits[1:], goal, speed])
    head = ["scan", "points", "Draco", "TMC13", *efforts, "effort 3, shuffled", "goal", "million points/s, effort 1"]
    return common.table(head, body)


# The source of each cloud, and the names of its fields for ring and time. Each driver gives these
# fields other names.
DRIVERS = {
    "VLP-16, Nebula's": ("filesrc location=tests/data/lidars/vlp16.pcd ! pointcloudparse", "channel", "time_stamp"),
    "VLP-16, synthetic": ("lidartestsrc model=vlp-16 num-buffers=5", "ring", "time"),
    "XT32, synthetic": ("lidartestsrc model=xt32 num-buffers=5", "ring", "timestamp"),
    "AT128, synthetic": ("lidartestsrc model=at128 num-buffers=5", "ring", "timestamp"),
    "Mid-360, synthetic": ("lidartestsrc model=mid-360 num-buffers=5", "line", "timestamp"),
}


def fields():
    """Bits a point of the points alone, and what fields and order add, at effort 1 within 2 cm."""

    def bits(source, options):
        coder = f"lidarenc effort=1 max-error=0.02 intensity-bits=0 stats-interval=1 {options}"
        text = common.run("gst-launch-1.0", "-m", *f"{source} ! {coder} ! fakesink".split())
        return float(re.findall(r"bits-per-return=\(double\)([\d.]+)", text)[-1])

    body = []
    for name, (source, ring, time) in DRIVERS.items():
        alone = bits(source, "")
        choices = [f"fields={ring}", f"fields={time}", "keep-order=true", f"fields={ring},{time} keep-order=true"]
        more = [f"{bits(source, choice) - alone:.2f}" for choice in choices]
        body.append([name, f"`{ring}`, `{time}`", f"{alone:.2f}", *more])
    head = ["scan", "ring and time", "points alone", "ring", "time", "order", "all three"]
    return common.table(head, body)


TABLES = {"clouds": clouds, "fields": fields, "sizes": sizes, "static": static, "speed": speed}
