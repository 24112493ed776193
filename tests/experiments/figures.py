#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of a run of the demo with --slam that take more than a line of awk.

figures.py way FOLDER   x,y,step,error of each pose at the edge
figures.py now FOLDER   error of the newest pose at the edge, extrapolated at its last velocity to
                        each moment: RMSE and 95th percentile [m]
figures.py age FOLDER   how old points and poses at the edge are, and how wrong that makes them [ms, m]
"""
import bisect
import csv
import math
import sys

SAMPLE_S = 0.005
PERIOD_S = 0.1  # the duration of a scan [s]
WARM_UP_S = 3  # the time until the rate has settled [s]


def trajectory(path):
    """Returns times, and places x, y, z."""
    rows = [line.split() for line in open(path) if line.strip() and line[0] != "#"]
    rows = [row for row in rows if len(row) == 8]
    return [float(row[0]) for row in rows], [[float(c) for c in row[1:4]] for row in rows]


def at(times, places, time):
    i = min(max(bisect.bisect_left(times, time), 1), len(times) - 1)
    span = times[i] - times[i - 1]
    f = min(max((time - times[i - 1]) / span if span > 0 else 0, 0), 1)
    return [a + f * (b - a) for a, b in zip(places[i - 1], places[i])]


def table(path):
    return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(open(path))]


def percentile(values, p):
    values = sorted(values)
    return values[min(len(values) - 1, int(p / 100 * len(values)))] if values else float("nan")


def rotated(q, v):
    """Returns `v` turned by the quaternion w, x, y, z."""
    w, x, y, z = q
    tx, ty, tz = 2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])
    return [
        v[0] + w * tx + y * tz - z * ty,
        v[1] + w * ty + z * tx - x * tz,
        v[2] + w * tz + x * ty - y * tx,
    ]


def lay_over(places, truth):
    """Returns `places` turned and moved so that they fit `truth` best (Horn, 1987)."""
    n = len(places)
    mean_p = [sum(p[k] for p in places) / n for k in range(3)]
    mean_t = [sum(t[k] for t in truth) / n for k in range(3)]
    m = [[0.0] * 3 for _ in range(3)]
    for p, t in zip(places, truth):
        for a in range(3):
            for b in range(3):
                m[a][b] += (p[a] - mean_p[a]) * (t[b] - mean_t[b])
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = m
    matrix = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ]
    # The quaternion is the eigenvector that belongs to the largest eigenvalue. Power iteration
    # finds the eigenvalue with the largest magnitude. A shift of all eigenvalues makes these two
    # the same.
    shift = max(sum(abs(v) for v in row) for row in matrix)
    q = [1.0, 0.1, 0.1, 0.1]
    for _ in range(5000):
        q = [shift * q[a] + sum(matrix[a][b] * q[b] for b in range(4)) for a in range(4)]
        norm = math.sqrt(sum(v * v for v in q))
        q = [v / norm for v in q]
    moved = []
    for p in places:
        turned = rotated(q, [p[k] - mean_p[k] for k in range(3)])
        moved.append([turned[k] + mean_t[k] for k in range(3)])
    return moved


def offset_of(folder):
    """Returns the offset from the time of the tables to that of the trajectories."""
    with open(folder + "/packets.csv") as file:
        first = next(csv.DictReader(file))
    return int(first["unix_ns"]) / 1e9 - float(first["time_s"])


def poses_of(folder):
    """Returns when each pose was known, its time, and its place laid over the truth."""
    times, places = trajectory(folder + "/edge.tum")
    truth = trajectory(folder + "/truth.tum")
    offset = offset_of(folder)
    places = lay_over(places, [at(*truth, t) for t in times])
    found = []
    for pose in table(folder + "/poses.csv"):
        time = pose["due_s"] - PERIOD_S / 2
        i = min(max(bisect.bisect_left(times, time + offset - PERIOD_S / 2), 0), len(times) - 1)
        if abs(times[i] - offset - time) < PERIOD_S / 2:
            found.append((pose["posed_s"], time, places[i]))
    return found, truth, offset


def now(folder):
    poses, truth, offset = poses_of(folder)
    errors = []
    if len(poses) > 30:
        end = poses[-1][0]
        newest, time = 1, poses[1][0] + WARM_UP_S
        while time < end:
            while poses[newest + 1][0] <= time:
                newest += 1
            (_, before, a), (_, then, b) = poses[newest - 1], poses[newest]
            steps = (time - then) / (then - before)
            place = [y + steps * (y - x) for x, y in zip(a, b)]
            errors.append(math.dist(place, at(*truth, time + offset)))
            time += SAMPLE_S
    rmse = math.sqrt(sum(e * e for e in errors) / len(errors)) if errors else float("nan")
    print(f"{rmse:.4g},{percentile(errors, 95):.4g}")


def way(folder):
    times, places = trajectory(folder + "/edge.tum")
    truth = trajectory(folder + "/truth.tum")
    true_places = [at(*truth, t) for t in times]
    offset = offset_of(folder)
    timeline = table(folder + "/timeline.csv")
    for t, place, true in zip(times, lay_over(places, true_places), true_places):
        i = min(max(int((t - offset) * 10), 0), len(timeline) - 1)
        # A bin of the timeline without a report has a step of 0. The step of the previous bin is
        # still valid there.
        while i > 0 and timeline[i]["step_m"] == 0:
            i -= 1
        print(f"{place[0]:.3f},{place[1]:.3f},{timeline[i]['step_m']},{math.dist(place, true):.4f}")


def ages(events, end):
    """Returns pairs of a time and the birth of the newest event that has arrived by then; `events` are pairs of arrival
    and birth."""
    events.sort()
    newest, i, found, t = None, 0, [], events[0][0] + WARM_UP_S
    while t < end:
        while i < len(events) and events[i][0] <= t:
            newest = max(newest or 0, events[i][1])
            i += 1
        found.append((t, newest))
        t += SAMPLE_S
    return found


def age(folder):
    slices = [(s["decoded_s"], s["due_s"]) for s in table(folder + "/slices.csv") if s["decoded_s"] > 0]
    truth = trajectory(folder + "/truth.tum")
    offset, poses = offset_of(folder), table(folder + "/poses.csv")
    posed = [(p["posed_s"], p["due_s"] - PERIOD_S / 2) for p in poses]
    end = min(max(slices)[0], max(posed)[0])
    points = [1000 * (t - birth) for t, birth in ages(slices, end)]
    pose_ages, held, predicted = [], [], []
    for t, birth in ages(posed, end):
        now = at(*truth, t + offset)
        then = at(*truth, birth + offset)
        before = at(*truth, birth + offset - PERIOD_S)
        step = (t - birth) / PERIOD_S
        pose_ages.append(1000 * (t - birth))
        held.append(math.dist(now, then))
        predicted.append(math.dist(now, [b + step * (b - a) for a, b in zip(before, then)]))
    figures = [percentile(points, 50), percentile(points, 95), percentile(pose_ages, 50)]
    figures += [percentile(pose_ages, 95), percentile(held, 95), percentile(predicted, 95)]
    print(",".join(f"{f:.4g}" for f in figures))


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in ("way", "now", "age"):
        sys.exit(__doc__)
    {"way": way, "now": now, "age": age}[sys.argv[1]](sys.argv[2])


main()
