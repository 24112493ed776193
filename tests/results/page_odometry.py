# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/odometry.md."""
import json

import common

# The columns are: model, scene, columns, speed [m/s], seed, number of scans.
DRIVES = [
    ("os0-32", "field", 512, 2, 0, 150),
    ("os0-32", "field", 512, 5, 0, 220),
    ("os0-32", "field", 512, 12, 2, 110),
    ("os0-32", "street", 512, 5, 0, 100),
    ("os0-32", "town", 512, 12, 1, 110),
    ("os1-32", "street", 512, 5, 0, 100),
    ("os1-64", "field", 1024, 12, 1, 100),
]


# The columns are: sensor, scene, columns, speed [m/s], seed, number of scans, options that leave
# out scans or beams.
CALIBRATED = [
    ("os0-32", "street", 512, 10, 50, 120, []),
    ("os0-32", "town", 512, 10, 50, 120, []),
    ("os0-32", "field", 512, 10, 50, 120, []),
    ("os0-32", "field", 1024, 7, 136, 80, []),
    ("os0-32", "field", 1024, 14, 12, 120, ["--every-beam", 2]),
    ("os0-32", "field", 512, 10, 51, 120, ["--gap", 1]),
    ("os0-32", "town", 512, 10, 51, 120, ["--lost-scans", 0.1]),
    ("os0-32", "tunnel", 512, 8, 1, 60, []),
    ("os0-64", "street", 512, 8, 1, 40, ["--every-scan", 5]),
    ("os0-64", "town", 512, 8, 1, 40, ["--every-scan", 5]),
    ("os0-64", "field", 512, 8, 1, 40, ["--every-scan", 5]),
    ("os1-64", "street", 512, 10, 50, 120, []),
    ("os1-64", "town", 512, 10, 50, 120, []),
    ("os1-64", "field", 512, 10, 50, 120, []),
]
FAULTS = {"--every-beam": "half the beams", "--gap": "1 s gap", "--lost-scans": "10 % lost", "--every-scan": "2 Hz"}
# Drives over a rough road: around corners on hills in the town, and over open country, where the
# road bounces 2.5 times as much at the same roughness. The columns are: scene, speed [m/s], seed,
# roughness.
BUMPY = [
    ("town", 12, 3, 4),
    ("town", 15, 4, 4),
    ("town", 15, 5, 4),
    ("field", 12, 3, 2),
    ("field", 15, 4, 2),
    ("field", 12, 3, 4),
    ("field", 15, 4, 4),
]
STARTS = range(100, 140)  # the seeds of the drives


def slam(model, scene, columns, speed, seed, scans, *options):
    # A synthetic drive has ten scans per second. `--every-scan` keeps every n-th of them.
    return json.loads(
        common.lidar_eval(
            "slam", f"synth:{model}:{scene}:{columns}", "--json",
            "--speed", speed, "--seed", seed, "--scans", scans, *options,
        )
    )


def confidence():
    """How well the deviation fits the error; the last row is the mean over all scans."""
    body = []
    kinds = ("deviation", "turn_deviation")
    sums = {(kind, part): 0 for kind in kinds for part in ("within_1_sigma", "within_3_sigma")}
    scans_of_all = 0
    for model, scene, columns, speed, seed, scans, fault in CALIBRATED:
        found = slam(model, scene, columns, speed, seed, scans, *fault)
        scans_of_all += found["scans"]
        name = ", ".join([model, scene, *(FAULTS[option] for option in fault[:1])])
        row = [name, f"{speed} m/s", f"{found['error']['end_error_m']:.2f} m", f"{found['deviation']['mean']:.2f} m"]
        for kind in kinds:
            for part in ("within_1_sigma", "within_3_sigma"):
                sums[kind, part] += found["scans"] * found[kind][part]
                row.append(f"{100 * found[kind][part]:.0f} %")
        body.append(row)
    body.append(["all", "", "", "", *(f"{100 * total / scans_of_all:.1f} %" for total in sums.values())])
    head = ["sensor, scene", "speed", "end", "deviation, mean", "position within 1 σ", "3 σ", "turn within 1 σ", "3 σ"]
    return common.table(head, body)


def starts():
    body = []
    for speed in (7, 10):
        runs = [slam("os0-32", "field", 1024, speed, seed, 40) for seed in STARTS]
        lost = sum(run["lost_at_start"] > 0 or run["maps"] > 1 for run in runs)
        worst = max(run["error"]["end_error_m"] / run["error"]["length_m"] for run in runs)
        body.append([f"{speed} m/s", len(runs), lost, f"{100 * worst:.1f} %"])
    return common.table(["speed", "drives", "starts lost", "end after 40 scans, worst"], body)


def gyroscope():
    """The smooth drive has all scans; the rough one lacks 1 s of scans after 10 s."""
    body = []
    for scene, speed, seed, roughness in BUMPY:
        def ate(*options):
            return slam("os0-32", scene, 512, speed, seed, 160, *options)["error"]["ate_rmse_m"]
        rough = ("--roughness", roughness, "--gap", 1)
        smooth, without, measured = ate(), ate(*rough), ate(*rough, "--gyroscope")
        body.append([f"os0-32, {scene}", f"{speed} m/s", seed, roughness, *(f"{m:.3f} m" for m in (smooth, without, measured)),
                     f"{measured / smooth:.1f}"])
    return common.table(
        ["sensor, scene", "speed", "seed", "roughness", "ATE, smooth", "rough, with a gap", "the same with IMU", "ratio to smooth"], body)


def drives():
    body = []
    for model, scene, columns, speed, seed, scans in DRIVES:
        found = slam(model, scene, columns, speed, seed, scans)
        error = found["error"]
        body.append([
            f"{model}, {scene}, {columns}", f"{speed} m/s", seed, scans, f"{error['length_m']:.0f} m",
            f"{100 * error['end_error_m'] / error['length_m']:.2f} %", f"{error['ate_rmse_m']:.3f} m",
            f"{error['rpe_rmse_m']:.3f} m", f"{found['cpu_ms_p95']:.0f} ms",
        ])
    head = ["sensor, scene, columns", "speed", "seed", "scans", "way", "end", "ATE", "RPE", "CPU of a scan, p95"]
    return common.table(head, body)


TABLES = {"drives": drives, "gyroscope": gyroscope, "starts": starts, "confidence": confidence}
