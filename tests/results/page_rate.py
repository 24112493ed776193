# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/rate.md."""
import pathlib
import re
import tempfile

import common

SYNTHETIC = {
    "OS1-64 street": "synth:os1-64:street",
    "OS0-32 tunnel": "synth:os0-32:tunnel",
    "OS1-64 field": "synth:os1-64:field",
}
SCENES = ("tunnel", "street", "field")
MODES = ("range-adaptive", "xyz-sequential")
BITS = (3, 5, 8)


def distortion():
    """The paper's setting nearest to 2 cm, and ours."""
    body = []
    for name, source in common.SOURCES.items():
        rows = common.rate_distortion(
            source, "--scans", 3, "--modes", "range-adaptive,xyz-kd6,xyz-sequential", "--errors", "0.02"
        )

        def best(start):
            near = [row for row in rows if row["coding"].startswith(start)]
            near.sort(key=lambda row: abs(float(row["max_error_m"]) - 0.02))
            few = [row for row in near if row["max_error_m"] == near[0]["max_error_m"]]
            row = min(few, key=lambda row: float(row["bits_per_return"]))
            return f"{float(row['bits_per_return']):.2f} ({1000 * float(row['max_error_m']):.1f})"

        xyz = min((best(f"xyz-{kind}, whole") for kind in ("kd6", "sequential")), key=lambda c: float(c.split()[0]))
        body.append([
            name, best("paper: automatic bits, level 0"), best("paper: automatic bits, level 7"), xyz,
            best("range-adaptive, whole"), best("range-adaptive, 8"),
        ])
    head = ["capture", "paper, level 0", "paper, level 7", "our xyz, whole scans", "our ranges, whole scans", "our ranges, 8 slices"]
    return common.table(head, body)


def predict():
    """Predictors trained in the tunnel, asked about other scenes."""
    body = []
    with tempfile.TemporaryDirectory() as folder:
        model = pathlib.Path(folder) / "tunnel.json"
        common.run(
            common.program("lidar-train"), "synth:os0-32:tunnel", "--scans", 10, "--samples", 80, "--slices", "1,2,4,8",
            "--intensity-bits", 0, "--modes", "range-adaptive,xyz-sequential,xyz-kd0,xyz-kd2,xyz-kd4,xyz-kd6", "-o", model,
        )
        for scene in SCENES:
            text = common.lidar_eval(
                "predict", f"synth:os0-32:{scene}", "--model", model, "--samples", 50, "--scans", 10, "--modes", ",".join(MODES)
            )
            for mode in MODES:
                cells = re.search(rf"^ +{mode} .*", text, re.M)[0].split()
                means = [cell for cell in cells[2:] if cell != "%"][::2]
                body.append([scene, mode, *means])
    return common.table(["scene", "mode", "paper's model [%]", "ours, as fitted", "ours, corrected"], body)


def followed(source, *options):
    """Returns rows of `lidar-eval track`: steady, walk, jump, and how far r_min is off over the walk."""
    text = common.lidar_eval("track", source, "--scans", 22, "--length", 150, *options)
    found = {}
    for kind in ("steady", "walk", "jump"):
        found[kind] = [cell for cell in re.search(rf"^{kind} .*", text, re.M)[0].split()[2:] if cell not in ("%", "mm")]
    return found


def track():
    """How closely 8 slices a scan follow targets, at a bound of 2 cm."""
    body = []
    for name, source in {**SYNTHETIC, **common.SOURCES}.items():
        row = followed(source)
        cells = [row["steady"][0], row["steady"][1], row["walk"][0], row["walk"][1], row["jump"][0], row["jump"][2], row["walk"][-1]]
        body.append([name, *cells])
    head = ["[%]", "steady: mean", "p95", "walk: mean", "p95", "jump: mean", "furthest over", "r_min off"]
    return common.table(head, body)


def below():
    """Scans that are skipped at a fifth of r_min."""
    body = []
    for preference in ("maintain-accuracy", "maintain-framerate", "balanced"):
        row = followed(
            SYNTHETIC["OS1-64 street"], "--rate", 300000, "--profiles", "steady,walk,jump", "--degradation-preference", preference
        )["steady"]
        body.append([preference, f"{row[4]} of 150"])
    return common.table(["preference", "scans skipped"], body)


def r_min():
    """The bitrate that the geometry of whole scans needs for a bound, and that of the paper's setting."""
    body = []
    for source in ("OS0-32", "OS1-128"):
        text = common.lidar_eval("bounds", common.SOURCES[source], "--errors", "0.02,0.05")
        for line in re.findall(r"^ +\d+ mm +automatic.*", text, re.M):
            bound, q, coder = re.match(r" +(\d+ mm).*q = (\d+), ([\w-]+)", line).groups()
            rates = re.findall(r"([\d.]+) Mbit/s", line)
            body.append([source, bound, f"{rates[0]} (q = {q}, {coder})", rates[1], rates[2]])
    return common.table(["Mbit/s", "bound", "paper: best level", "xyz, continuous step", "range"], body)


def intensity():
    """Bits a return that intensities cost in addition to geometry within 2 cm."""
    def bits_of(source, bits):
        rows = common.rate_distortion(
            source, "--scans", 3, "--modes", "range-adaptive", "--slices", 8, "--errors", "0.02", "--intensity-bits", bits
        )
        return float([row for row in rows if row["coding"].startswith("range-adaptive")][0]["bits_per_return"])

    geometry = {name: bits_of(source, 0) for name, source in common.SOURCES.items()}
    body = [["(geometry)"] + [f"({bits:.2f})" for bits in geometry.values()]]
    for bits in BITS:
        body.append([bits] + [f"{bits_of(s, bits) - geometry[n]:.2f}" for n, s in common.SOURCES.items()])
    return common.table(["intensity-bits", *common.SOURCES], body)


def loop():
    """How much rate controller and SCReAM oscillate over a constant link, in simulated time."""
    body = []
    for parameter, slices in enumerate(("whole scans", "8 slices")):
        text = common.run(
            common.program("core_loop_test"), f"--gtest_filter=*OnAConstantLinkStandsStill/{parameter}"
        )
        for line in re.findall(r"^(?:target|sent), .* tone .*", text, re.M):
            what = line.split(" mean ")[0].strip()
            body.append([slices, what, *re.findall(r"[\d.]+(?= Mbit/s| %)", line)])
    head = ["", "", "mean [Mbit/s]", "deviation [%]", "peak to peak in 10 s", "strongest sine, 0.1 to 2 Hz"]
    return common.table(head, body)


TABLES = {"distortion": distortion, "predict": predict, "track": track, "below": below, "r_min": r_min, "loop": loop, "intensity": intensity}
