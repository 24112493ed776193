# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/demo.md. Each row is a run in real time, which needs an idle machine and root."""
import json
import pathlib
import tempfile

import common

CAPTURE = ("--pcap", f"{common.DATA}/OS-1-128_v2.3.0_1024x10_lb_n3.pcap", "--metadata", f"{common.DATA}/OS-1-128_v2.3.0_1024x10.json")
RUNS = {
    "default source": (),
    "16 slices": ("--slices", 16),
    "whole scans": ("--slices", 1),
    "OS1-128": ("--model", "os1-128"),
    "capture": CAPTURE,
    "xyz": ("--geometry", "xyz"),
    "no L4S": ("--no-l4s",),
    "fixed bits": (*CAPTURE, "--fixed-bits", 15),
}


def gaps():
    """The demo's own links, three runs each, compared with a sender that knew the link."""
    return common.as_printed(
        common.run("chrt", "-r", 10, common.ROOT / "tests/benchmarks/demo_sockets.py", "--build", common.build)
    )


def summary_of(options):
    with tempfile.TemporaryDirectory() as folder:
        common.run(
            "chrt", "-r", 10, common.ROOT / "pipelines/demo.sh", "--no-install", "--no-build", "--no-plots",
            "--steps", "12,6,9,5,15,7", "--output", folder, *options, check=False,
        )
        return json.loads((pathlib.Path(folder) / "summary.json").read_text())


def steps():
    """A run of 40 s of each kind over steps of the capacity."""
    body = []
    for name, options in RUNS.items():
        s = summary_of(options)
        steady, whole = s["capture_to_cloud_steady_ms"], s["capture_to_cloud_ms"]
        body.append([
            name, f"{s['scans_captured']}/{s['scans_skipped']}/{s['scans_complete']}", s["slices_lost"],
            f"{s['mean_rate_bps'] / 1e6:.1f}", f"{100 * s['utilisation_of_usable']:.1f}",
            f"{s['queue_delay_steady_ms']['p95']:.1f}/{s['queue_delay_ms']['p95']:.1f}",
            f"{steady['p50']:.1f}/{steady['p95']:.1f}/{steady['p99']:.1f}",
            f"{whole['p95']:.1f}/{whole['max']:.1f}",
            f"{100 * s['max_error_m']:.1f}/{100 * s['mean_error_m']:.2f}",
        ])
    head = [
        "run", "scans captured/skipped/complete", "slices lost", "Mbit/s", "utilisation of usable [%]",
        "queue p95, steady/whole [ms]", "capture_to_cloud p50/p95/p99, steady [ms]",
        "p95/max, whole run [ms]", "error max/mean [cm]",
    ]
    return common.table(head, body)


TABLES = {"gaps": gaps, "steps": steps}
