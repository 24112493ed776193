#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""lidar-eval to-pcap: clouds of another sensor, put into a capture, are read back at the same places.

The packets are read here by hand, by Ouster's description of them, not by our parser.
"""
import json
import math
import random
import struct
import subprocess
import sys
import tempfile

COLUMNS, BEAMS, TOP, BOTTOM = 512, 16, 15.0, -15.0


def direction(beam, column):
    azimuth = 2 * math.pi * (0.5 - column / COLUMNS)  # a turn begins behind, as Ouster's and KITTI's do
    altitude = math.radians(TOP - (TOP - BOTTOM) * beam / (BEAMS - 1))
    return (math.cos(azimuth) * math.cos(altitude), math.sin(azimuth) * math.cos(altitude),
            math.sin(altitude))


def point_at(beam, column, range_mm, intensity):
    return struct.pack("<4f", *(c * range_mm / 1000 for c in direction(beam, column)), intensity)


def make_cloud(seed):
    """Ranges [mm] and intensities [0, 1] of some pixels, and their KITTI file."""
    dice = random.Random(seed)
    pixels, data = {}, b""
    for beam in range(BEAMS):
        for column in range(COLUMNS):
            if dice.random() < 0.3:
                continue
            range_mm, intensity = dice.randrange(1000, 80000), dice.random()
            pixels[beam, column] = (range_mm, intensity)
            point = point_at(beam, column, range_mm, intensity)
            behind = point_at(beam, column, range_mm + 900, 1 - intensity)
            # If a pixel has several points, only the nearest point counts, in whichever order they
            # are.
            data += dice.choice((point, point + behind, behind + point))
    return pixels, data


def read_packets(path):
    with open(path, "rb") as file:
        data = file.read()
    assert struct.unpack("<I", data[:4])[0] == 0xA1B23C4D, "nanosecond pcap"
    at = 24
    while at < len(data):
        size = struct.unpack("<I", data[at + 8:at + 12])[0]
        yield data[at + 16 + 42:at + 16 + size]
        at += 16 + size


def main():
    tool = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        clouds = []
        for scan in range(2):
            pixels, data = make_cloud(scan)
            clouds.append(pixels)
            with open(f"{folder}/{scan:06}.bin", "wb") as file:
                file.write(data)
        subprocess.run([tool, "to-pcap", folder, "-o", f"{folder}/out.pcap", "--beams",
                        f"{BEAMS}:{TOP}:{BOTTOM}", "--columns", str(COLUMNS)], check=True)
        with open(f"{folder}/out.json", encoding="utf-8") as file:
            metadata = json.load(file)
        packets = list(read_packets(f"{folder}/out.pcap"))
    turned = [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    assert metadata["lidar_intrinsics"]["lidar_to_sensor_transform"] == turned
    layout = metadata["lidar_data_format"]
    assert (layout["columns_per_frame"], layout["pixels_per_column"]) == (COLUMNS, BEAMS)
    assert layout["udp_profile_lidar"] == "RNG19_RFL8_SIG16_NIR16"
    assert len(packets) == 2 * COLUMNS // 16, len(packets)
    column_size = 12 + BEAMS * 12
    seen = 0
    for packet in packets:
        assert len(packet) == 32 + 16 * column_size + 32
        frame = struct.unpack("<H", packet[2:4])[0]
        for i in range(16):
            block = packet[32 + i * column_size:]
            column, status = struct.unpack("<HH", block[8:12])
            assert status & 1
            for beam in range(BEAMS):
                pixel = block[12 + beam * 12:]
                range_mm = struct.unpack("<I", pixel[:4])[0] & 0x7FFFF
                expected, intensity = clouds[frame].get((beam, column), (0, 0))
                assert abs(range_mm - expected) <= 1, (frame, beam, column, range_mm, expected)
                if expected:
                    assert abs(pixel[4] - 255 * intensity) <= 1
                    seen += 1
    assert seen == sum(len(c) for c in clouds)


if __name__ == "__main__":
    main()
