#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the demo several times over each link, over sockets, and prints the rows of docs/results/demo.md: medians.

Each figure is followed by that of a sender that knew the link (the demo's oracle). The links: the
demo's own steps and drive, regular gaps that lidar-trace makes, and the traces given. Run it with
real-time priority (chrt -r 10) on a machine that does nothing else.
"""
import argparse
import json
import lzma
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import build_tree  # noqa: E402

# name: options of the demo
STEPS_AND_DRIVE = {"default": [], "drive": ["--drive"]}
# name: options of lidar-trace
GAPS = {
    "gap_100ms_every_0.6s": ["--gap", "0.1", "--every", "0.6", "--rate", "8"],
    "gap_100ms_every_2s": ["--gap", "0.1", "--every", "2", "--rate", "8"],
    "gap_1s_every_10s": ["--gap", "1", "--every", "10", "--rate", "8"],
}
HEADER = ("| link | scans | complete | in time | of the oracle's [%] | capture_to_cloud p95 [ms] | the oracle's "
          "| utilisation where usable [%] | queue p95 [ms] | back after a gap p50 [s] | p95 |\n"
          "|---|---|---|---|---|---|---|---|---|---|---|")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--duration", type=float, default=60, help="of a run [s]; of default and drive 40")
    parser.add_argument("--pcap", type=pathlib.Path, help="an Ouster capture for gaps and traces; may be .xz")
    parser.add_argument("--metadata", type=pathlib.Path, help="of --pcap, where it does not lie beside it")
    parser.add_argument("--trace", type=pathlib.Path, action="append", default=[], help="repeatable")
    parser.add_argument("--case", action="append", help=f"of {', '.join([*STEPS_AND_DRIVE, *GAPS])}; repeatable. "
                        "Without it all, or with --trace only the traces")
    parser.add_argument("--fixed-step", action="store_true", help="also without adaptation, at the same error bound")
    parser.add_argument("--more", type=shlex.split, default=[], metavar="OPTIONS", help="of the demo, in one string: --more='--geometry xyz'")
    parser.add_argument("--max-error", type=float, default=0.05, help="[m]")
    parser.add_argument("--output", type=pathlib.Path, help="keep the reports of the runs in this folder")
    return parser.parse_args()


def links(args, folder):
    """Yields name and options of each link."""
    cases = args.case or ([] if args.trace else [*STEPS_AND_DRIVE, *GAPS])
    for name in cases:
        if name in STEPS_AND_DRIVE:
            yield name, STEPS_AND_DRIVE[name], 40
        elif name in GAPS:
            trace = folder / f"{name}.txt"
            made = subprocess.run([args.build / "src/tools/lidar-trace", *GAPS[name]], check=True, capture_output=True)
            trace.write_bytes(made.stdout)
            yield name, [*source(args, folder), "--trace", trace], args.duration
        else:
            sys.exit(f"There is no case {name}.")
    for trace in args.trace:
        yield trace.stem, [*source(args, folder), "--trace", trace.resolve()], args.duration


def source(args, folder):
    """Returns options for the capture; none for the synthetic sensor."""
    if args.pcap is None:
        return []
    pcap = args.pcap
    if pcap.suffix == ".xz":
        pcap = folder / args.pcap.stem
        if not pcap.exists():
            pcap.write_bytes(lzma.open(args.pcap).read())
    metadata = args.metadata or next(iter(args.pcap.parent.glob("*.json")), None)
    return ["--pcap", pcap] + (["--metadata", metadata.resolve()] if metadata else [])


def run(args, options, duration, report):
    """Returns the summary of one run."""
    command = [args.build / "src/tools/lidar-demo", "run", "--no-plots", "--duration", duration, "--max-error",
               args.max_error, "--output", report, *options, *args.more]
    done = subprocess.run([str(word) for word in command], env=build_tree.environment(args.build), capture_output=True, text=True, check=False)
    summary = report / "summary.json"
    if not summary.exists():
        sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stderr}")
    return json.loads(summary.read_text())


def middle(values, form):
    """Returns the median of the runs' values."""
    known = sorted(v for v in values if v is not None)
    return format(known[len(known) // 2], form) if known else "–"


def row(name, summaries):
    def each(form, get):
        return middle([get(s) for s in summaries], form)

    def back(percentile):
        gaps = [s["gaps"]["back_after_s"] for s in summaries]
        return middle([g[percentile] if g else None for g in gaps], ".2f")

    oracle = [s["oracle"] for s in summaries]
    share = [s["scans_complete"] / max(1, o["scans_complete"]) for s, o in zip(summaries, oracle)]
    return " | ".join([
        f"| {name}", each("d", lambda s: s["scans_captured"]), each("d", lambda s: s["scans_complete"]),
        each("d", lambda s: s["scans_in_time"]), middle([100 * v for v in share], ".1f"),
        each(".0f", lambda s: s["capture_to_cloud_ms"]["p95"]), middle([o["capture_to_cloud_ms"]["p95"] for o in oracle], ".0f"),
        each(".0f", lambda s: 100 * s["utilisation_of_usable"] if s["utilisation_of_usable"] is not None else None),
        each(".1f", lambda s: s["queue_delay_ms"]["p95"]), back("p50"), back("p95")]) + " |"


def main():
    args = parse_arguments()
    fixed = ["--fixed-step", 2 * args.max_error]
    print(HEADER, flush=True)
    broken = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        reports = args.output or folder / "reports"
        shutil.rmtree(reports, ignore_errors=True)
        reports.mkdir(parents=True)
        for name, options, duration in links(args, folder):
            for variant, more in [("", [])] + ([(" without adaptation", fixed)] if args.fixed_step else []):
                summaries = [run(args, options + more, duration, reports / f"{name}{variant.replace(' ', '-')}-{number}")
                             for number in range(args.runs)]
                print(row(name + variant, summaries), flush=True)
                broken += sum(not g["holds"] for s in summaries for g in s["guarantees"])
    if broken:
        sys.exit(f"{broken} guarantees did not hold.")


if __name__ == "__main__":
    main()
