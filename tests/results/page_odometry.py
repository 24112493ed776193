# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/odometry.md."""
import json

import common

# Model, scene, columns, speed [m/s], seed, scans.
DRIVES = [
    ("os0-32", "field", 512, 2, 0, 150),
    ("os0-32", "field", 512, 5, 0, 220),
    ("os0-32", "field", 512, 12, 2, 110),
    ("os0-32", "street", 512, 5, 0, 100),
    ("os0-32", "town", 512, 12, 1, 110),
    ("os1-32", "street", 512, 5, 0, 100),
    ("os1-64", "field", 1024, 12, 1, 100),
]


def drives():
    body = []
    for model, scene, columns, speed, seed, scans in DRIVES:
        found = json.loads(
            common.lidar_eval(
                "slam", f"synth:{model}:{scene}:{columns}", "--json",
                "--speed", speed, "--seed", seed, "--scans", scans,
            )
        )
        error = found["error"]
        body.append([
            f"{model}, {scene}, {columns}", f"{speed} m/s", seed, scans, f"{error['length_m']:.0f} m",
            f"{100 * error['end_error_m'] / error['length_m']:.2f} %", f"{error['ate_rmse_m']:.3f} m",
            f"{error['rpe_rmse_m']:.3f} m", f"{found['cpu_ms_p95']:.0f} ms",
        ])
    head = ["sensor, scene, columns", "speed", "seed", "scans", "way", "end", "ATE", "RPE", "CPU of a scan, p95"]
    return common.table(head, body)


TABLES = {"drives": drives}
