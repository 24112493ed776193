#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""lidar-eval to-kitti and slam kitti:FOLDER: scans that are written are read back, and KITTI's own layout is read.

    kitti_sequence_test.py LIDAR_EVAL
"""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1]
DRIVE = ["synth:os0-32:street:512", "--scans", "12", "--speed", "8"]


def run(*arguments, fails=False):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert (done.returncode != 0) == fails, (arguments, done.stdout, done.stderr)
    return done.stdout + done.stderr


def slam(*arguments):
    return json.loads(run("slam", *arguments, "--json"))


def scans_come_back_with_their_beams_and_times(folder):
    run("to-kitti", *DRIVE, "-o", folder)
    assert len(list((folder / "velodyne").iterdir())) == len(list((folder / "phases").iterdir())) == 12
    times = [float(line) for line in (folder / "times.txt").read_text().split()]
    assert all(abs(b - a - 0.1) < 1e-6 for a, b in zip(times, times[1:])), times
    direct, read = slam(*DRIVE), slam(f"kitti:{folder}")
    assert read["scans"] == 12 and read["tracked"] == direct["tracked"], read
    # The folder has the same points and the same trajectory. It lacks only rows without a return.
    assert abs(read["error"]["ate_rmse_m"] - direct["error"]["ate_rmse_m"]) < 0.002, (read, direct)
    assert abs(read["error"]["length_m"] - direct["error"]["length_m"]) < 1e-3
    assert "not empty" in run("to-kitti", *DRIVE, "-o", folder, fails=True)


def poses_of_a_camera_become_those_of_the_sensor(folder):
    """KITTI's cameras look along z, with x to the right: the trajectory must not turn."""
    before = slam(f"kitti:{folder}")["error"]
    camera = [[0, -1, 0, 0.1], [0, 0, -1, -0.2], [1, 0, 0, -0.3]]  # the sensor's pose in the camera's frame

    def product(a, b):
        a4, b4 = a + [[0, 0, 0, 1]], b + [[0, 0, 0, 1]]
        return [[sum(a4[i][k] * b4[k][j] for k in range(4)) for j in range(4)] for i in range(3)]

    back = [[camera[j][i] for j in range(3)] for i in range(3)]
    inverse = [row + [-sum(row[k] * camera[k][3] for k in range(3))] for row in back]
    rows = []
    for line in (folder / "poses.txt").read_text().splitlines():
        numbers = [float(word) for word in line.split()]
        pose = product(product(camera, [numbers[0:4], numbers[4:8], numbers[8:12]]), inverse)
        rows.append(" ".join(f"{value:.9e}" for row in pose for value in row))
    (folder / "poses.txt").write_text("\n".join(rows) + "\n")
    flat = " ".join(str(value) for row in camera for value in row)
    (folder / "calib.txt").write_text(f"P0: {flat}\nTr: {flat}\n")
    after = slam(f"kitti:{folder}")["error"]
    for name in ("ate_rmse_m", "rpe_rmse_m", "length_m"):
        assert abs(before[name] - after[name]) < 1e-4, (before, after)
    again = folder / "again"
    run("to-kitti", f"kitti:{folder}", "-o", again)
    run("slam", f"kitti:{again}", "--out", folder / "again.tum")
    error = json.loads(run("ate", f"kitti:{folder}", folder / "again.tum", "--json"))
    assert abs(error["ate_rmse_m"] - before["ate_rmse_m"]) < 1e-4, (before, error)


def straight_scans_of_listed_beams_are_read(folder):
    """Scans as KITTI has them: without phases, beam by beam; each beam turns once, from straight ahead."""
    (folder / "velodyne").mkdir(parents=True)
    for scan in range(4):
        data = b""
        for beam in range(16):
            for column in range(360):
                azimuth, height = math.radians(column + 0.5), math.radians(beam - 12)
                # The sensor is in a room of 20 by 12 m and moves by half a metre from scan to scan.
                x, y = math.cos(azimuth), math.sin(azimuth)
                ahead = (10 - 0.5 * scan) if x > 0 else (10 + 0.5 * scan)
                wall = min(ahead / abs(x), 6 / abs(y))
                reach = min(wall, 1.8 / -math.tan(height) if height < 0 else 1e9)
                data += struct.pack("<4f", reach * x, reach * y, reach * math.tan(height), 0.5)
        (folder / f"velodyne/{scan:06d}.bin").write_bytes(data)
    (folder / "times.txt").write_text("".join(f"{0.1036 * scan:.6e}\n" for scan in range(4)))
    found = slam(f"kitti:{folder}", "--out", folder / "way.tum")
    assert found["scans"] == 4 and found["lost"] == 0, found
    last = (folder / "way.tum").read_text().splitlines()[-1].split()
    assert abs(float(last[1]) - 1.5) < 0.1 and abs(float(last[2])) < 0.05, last
    assert slam(f"kitti:{folder}", "--every-beam", "2")["scans"] == 4


def points_whose_beams_are_unknown_are_shuffled(folder):
    """Phases in no order tell no beams, and neither does a line of points."""
    files = {"velodyne": [v for i in range(600) for v in (5 + i / 100, 1, 0, 0)], "phases": [i % 2 for i in range(600)]}
    for kind, data in files.items():
        (folder / kind).mkdir(parents=True)
        (folder / f"{kind}/000000.bin").write_bytes(struct.pack(f"<{len(data)}f", *data))
    (folder / "times.txt").write_text("0.0\n")
    assert "600 points, shuffled" in run("clouds", f"kitti:{folder}", "--shuffle", "--errors=0.05", "--efforts=0")


def faults_leave_scans_out():
    long = ["synth:os0-32:street:512", "--speed", "8"]
    assert slam(*long, "--scans", 40, "--lost-scans", "0.3")["error"]["length_m"] > 33
    gap = slam(*long, "--scans", 110, "--gap", "1")
    assert gap["error"]["length_m"] > 0.8 * 119 - 1, gap


def what_is_wrong_is_said(folder):
    assert "no folder velodyne" in run("slam", f"kitti:{folder}/none", fails=True)
    times = folder / "times.txt"
    good = times.read_text()
    times.write_text(good.splitlines()[1] + "\n" + good)
    assert "line 2 is not later" in run("slam", f"kitti:{folder}", fails=True)
    times.write_text("0.0\nsoon\n")
    assert "line 2 is not a time" in run("slam", f"kitti:{folder}", fails=True)
    times.write_text("")
    assert "times.txt: has no time" in run("slam", f"kitti:{folder}", fails=True)
    times.write_text(good + "1e3\n")
    assert "000004.bin" in run("slam", f"kitti:{folder}", fails=True)
    times.write_text(good)
    (folder / "velodyne/000001.bin").write_bytes(b"123")
    assert "not a list of 4 floats" in run("slam", f"kitti:{folder}", fails=True)


with tempfile.TemporaryDirectory() as temporary:
    synthetic, listed, unknown = (pathlib.Path(temporary) / name for name in ("synthetic", "listed", "unknown"))
    scans_come_back_with_their_beams_and_times(synthetic)
    poses_of_a_camera_become_those_of_the_sensor(synthetic)
    straight_scans_of_listed_beams_are_read(listed)
    points_whose_beams_are_unknown_are_shuffled(unknown)
    faults_leave_scans_out()
    what_is_wrong_is_said(listed)
