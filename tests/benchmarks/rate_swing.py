#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the rates of a demo's timeline.csv move about their means, and how closely one follows the other.

usage: rate_swing.py TIMELINE [FROM TO]   (seconds; the whole run without them)
"""
import cmath
import csv
import math
import sys

SAMPLES_PER_SECOND = 10


def swing(rates):
    """Mean, and of the mean: deviation, largest peak to peak within 10 s, strongest sine."""
    mean = sum(rates) / len(rates)
    deviation = math.sqrt(sum((r - mean) ** 2 for r in rates) / len(rates)) / mean
    window = min(10 * SAMPLES_PER_SECOND, len(rates))
    peak = max(max(rates[i:i + window]) - min(rates[i:i + window]) for i in range(len(rates) - window + 1)) / mean
    best = (0, 0)
    for step in range(15, 201):
        hertz = step / 50
        total = sum((r - mean) * cmath.exp(-2j * math.pi * hertz * i / SAMPLES_PER_SECOND) for i, r in enumerate(rates))
        best = max(best, (2 * abs(total) / len(rates) / mean, hertz))
    return mean, deviation, peak, best


def seconds(rates):
    """Means of whole seconds."""
    n = SAMPLES_PER_SECOND
    return [sum(rates[i:i + n]) / n for i in range(0, len(rates) - n + 1, n)]


def main():
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    first, last = (float(a) for a in sys.argv[2:4]) if len(sys.argv) > 3 else (0, math.inf)
    rows = [r for r in rows if first <= float(r["time_s"]) < last]
    rates = {name: [float(r[name + "_mbps"]) for r in rows] for name in ("target", "encoded", "sent")}
    for name, values in rates.items():
        mean, deviation, peak, (tone, hertz) = swing(values)
        print(f"{name:8} mean {mean:5.2f} Mbit/s, deviation {100 * deviation:4.1f} %, peak to peak {100 * peak:4.1f} %, "
              f"strongest sine of 0.3 to 4 Hz {100 * tone:4.2f} % at {hertz:.2f} Hz")
    for name in ("encoded", "sent"):
        shares = [a / b for a, b in zip(seconds(rates[name]), seconds(rates["target"])) if b > 0]
        mean = sum(shares) / len(shares)
        deviation = math.sqrt(sum((s - mean) ** 2 for s in shares) / len(shares))
        print(f"{name:8} / target, by seconds: {100 * mean:5.1f} %, deviation {100 * deviation:.1f} %")


if __name__ == "__main__":
    main()
