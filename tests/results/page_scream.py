# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/scream.md. `over_sockets` and `beside_over_sockets` take an idle machine and real time."""
import csv
import json
import tempfile

import common
import controller

PEERS = common.HERE / "peers"
QUEUE = ["queue p95 [ms]", "queue p99 [ms]", "queue max [ms]"]
FRAME = ["frame p95 [ms]", "frame p99 [ms]"]
ALONE = ("frames", "slices", "two_flows")
BESIDE = ("cubic_", "reno_", "prague_", "draft_")


def ours_and_draft(prefixes):
    """Returns (case, figures of ours, figures of the draft alone) of each case."""
    ours = {
        case: of
        for case, of in controller.figures().items()
        if case.startswith(prefixes) and not case.endswith("_ect1")  # there a FIFO marks no packets
    }
    draft = controller.figures("--draft", *ours)
    return [(case, of, draft[case]) for case, of in ours.items()]


def alone():
    body = []
    for case, ours, draft in ours_and_draft(ALONE):
        row = [f"`{case}`"]
        for of in (ours, draft):
            bold = of is ours
            row.append(controller.cell(of, ["utilisation [%]"], 1, bold))
            row.append(controller.cell(of, QUEUE, 1, bold))
        row[3:3] = [controller.cell(ours, FRAME, 0)]
        body.append(row)
    return common.table(["scenario", "util %", "queue [ms]", "frame [ms]", "draft: util %", "draft: queue [ms]"], body)


def beside():
    body = []
    for case, ours, draft in ours_and_draft(BESIDE):
        row = [f"`{case}`"]
        for of in (ours, draft):
            shares = [controller.cell(of, [name], 1, False) for name in ("ours [Mbit/s]", "theirs [Mbit/s]")]
            row.append(" : ".join(shares))
        row[2:2] = [
            controller.cell(ours, ["Jain's index"], 3),
            controller.cell(ours, ["own loss [%]", "their loss [%]"], 2, False),
        ]
        body.append(row)
    return common.table(["scenario", "ours : other [Mbit/s]", "Jain", "own/other's loss %", "the draft : other"], body)


def gaps():
    columns = {
        "complete, of the oracle's [%]": ("of the oracle's scans %", 1),
        "spread of the starts [points]": ("spread", 1),
        "complete, of a fixed step's [%]": ("of a fixed step's %", 1),
        "in time, of a fixed step's [%]": ("in time, of a fixed step's %", 1),
        "utilisation [%]": ("util %", 0),
        "p95 over the oracle's [ms]": ("p95 over the oracle's [ms]", 0),
        "back after a gap [s]": ("back [s]", 2),
    }
    body = [
        [f"`{case}`", *(controller.cell(of, [name], digits) for name, (_, digits) in columns.items())]
        for case, of in controller.figures().items()
        if "spread of the starts [points]" in of
    ]
    return common.table(["trace/source", *(head for head, _ in columns.values())], body)


def peer(name):
    """Returns rows of a dated file of another implementation's figures, by scenario."""
    with open(PEERS / name) as file:
        return {row["scenario"]: row for row in csv.DictReader(line for line in file if not line.startswith("#"))}


def measured(script, *options):
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        path = common.ROOT / "tests/benchmarks" / script
        common.run("chrt", "-r", 10, path, "--build", common.build, "--json", file.name, *options)
        return json.load(open(file.name))


def over_sockets():
    reference = peer("scream_reference.csv")
    body = []
    for m in measured("scream_sockets.py"):
        theirs = reference.get(m["scenario"], {})
        body.append([
            f"`{m['scenario']}`",
            f"{100 * m['utilisation']:.1f}",
            "/".join(f"{v:.1f}" for v in m["queue_ms"]),
            "/".join(f"{v:.0f}" for v in m["frame_ms"]) if m["frame_ms"] else "–",
            *(theirs.get(name) or "–" for name in ("utilisation", "queue_ms")),
        ])
    head = ["scenario", "util %", "queue [ms]", "frame [ms]", "reference: util %", "reference: queue [ms]"]
    return common.table(head, body)


def jain(a, b):
    return (a + b) ** 2 / 2 / (a**2 + b**2)


def beside_table(figures):
    body = [
        [
            f"`{case}`",
            f"{of['ours_mbps']:.1f} : {of['theirs_mbps']:.1f}",
            f"{jain(of['ours_mbps'], of['theirs_mbps']):.3f}",
            f"{100 * of['our_loss']:.2f}/{100 * of['their_loss']:.2f}",
            f"{of['queue_p95_ms']:.1f}",
        ]
        for case, of in figures.items()
    ]
    return common.table(["case", "ours : other [Mbit/s]", "Jain", "own/other's loss %", "queue p95 [ms]"], body)


def beside_over_sockets():
    return beside_table({case: runs[0] for case, runs in measured("beside_sockets.py").items()})


def beside_peers():
    return beside_table({
        case: {name: float(value) for name, value in row.items() if name != "scenario"}
        for case, row in peer("beside_peers.csv").items()
    })


def elements():
    """CPU time of the whole process for packets of 1200 bytes."""
    text = common.run(common.program("scream-elements-bench"), "--benchmark_format=json")
    body = []
    for run in json.loads(text)["benchmarks"]:
        rate = run["bits_per_cpu_second"]
        body.append([f"`{run['name'].split('/')[0].lower()}`", f"{1e6 * 1200 * 8 / rate:.1f} µs", f"{rate / 1e9:.1f} Gbit/s"])
    return common.table(["element", "CPU time a packet", "bits a CPU second"], body)


TABLES = {
    "alone": alone,
    "gaps": gaps,
    "beside": beside,
    "over-sockets": over_sockets,
    "beside-over-sockets": beside_over_sockets,
    "beside-peers": beside_peers,
    "elements": elements,
}
