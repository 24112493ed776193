# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of docs/results/synthetic-sensor.md."""
import resource

import common

SENSORS = [("os0-32", "1024x10"), ("os1-64", "1024x10"), ("os1-128", "1024x10"), ("os1-128", "2048x10"), ("os2-128", "2048x10")]
SCENES = ("street", "tunnel", "field", "town")


def cpu():
    """CPU seconds of 30 scans, without the start of the process."""
    def seconds(model, mode, scene, scans):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        source = f"lidartestsrc model={model} mode={mode} scene={scene} slices-per-scan=8 num-buffers={8 * scans}"
        common.run("gst-launch-1.0", "-q", *source.split(), "!", "fakesink")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    common.run("gst-inspect-1.0", "lidartestsrc")  # makes the registry before the measurement
    body = []
    for model, mode in SENSORS:
        times = [max(seconds(model, mode, scene, 31) - seconds(model, mode, scene, 1), 0) for scene in SCENES]
        body.append([f"{model} {mode}"] + [f"{time:.2f} s" for time in times] + [f"{100 * times[0] / 3:.0f} %"])
    return common.table(["model, mode", *SCENES, "of a core in real time, street"], body)


def likeness():
    """Bits a return of Draco on ranges within 2 cm, as a measure of how hard a scene is."""
    def bits(source):
        rows = common.rate_distortion(source, "--modes", "range-draco", "--slices", 1, "--errors", "0.02", "--scans", 10)
        return f"{float([row for row in rows if row['coding'].startswith('range-draco')][0]['bits_per_return']):.1f}"

    body = [[model, *(bits(f"synth:{model}:{scene}") for scene in SCENES), "–"] for model in ("os0-32", "os1-64", "os1-128")]
    real = [[name, *["–"] * len(SCENES), bits(source)] for name, source in common.SOURCES.items()]
    return common.table(["sensor", *SCENES, "real scans"], body + real)


TABLES = {"cpu": cpu, "likeness": likeness}
