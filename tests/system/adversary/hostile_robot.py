#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""One robot of lidar-edge changes the format of its stream with each slice, within its bandwidth.

Prints a line of JSON for a run without that robot and one for a run with it: memory of lidar-edge, slices of the
others that were lost, and how long it took to stop.
"""
import argparse
import contextlib
import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import urllib.request

import ends
import media
import wire

MOST_MBPS = 2
BLACK_BOX = {"record-max-file-size": 20_000_000, "record-max-files": 3}


def hostile_packets():
    """Configs of two formats as long as they may be, then slices that take turns between them, for ever."""
    formats = [wire.build_config(b"x:F32:0,y:F32:4,z:F32:8,range:U32:12", wire.sensor_model(b, 1024)) for b in (500, 512)]
    units = [part for f in formats for part in media.split_unit(wire.config_unit(f), 1100)]
    n = scan = 0
    while True:
        if scan % 200 == 0:
            for unit in units:
                yield wire.rtp(unit, n, scan * 1000, 99, True)
                n += 1
        slices = [wire.Slice(b"abc", wire.config_id(formats[i % 2]), scan, i, 24, scan) for i in range(24)]
        yield wire.rtp(wire.aggregate(slices, [0] * len(slices)), n, scan * 1000, 99, True)
        n, scan = n + 1, scan + 1


class Edge:
    def __init__(self, build, folder, ports):
        robots = [{"name": f"r{i}", "port": port, "record": f"{folder}/r{i}-%05d.mcap", "max-mbps": 100 if i else MOST_MBPS,
                   **BLACK_BOX} for i, port in enumerate(ports)]
        config = pathlib.Path(folder) / "edge.json"
        config.write_text(json.dumps({"http-port": 0, "interval": 0.5, "robots": robots}))
        program = next(p for p in build.rglob("lidar-edge") if p.is_file() and os.access(p, os.X_OK))
        self.process = subprocess.Popen([program, config], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.url = re.search(r"http:\S+", self.process.stdout.readline())[0]

    def metric(self, name, robot):
        text = urllib.request.urlopen(self.url, timeout=5).read().decode()
        found = re.search(rf'^{name}{{robot="{robot}",sensor="lidar"}} (\S+)$', text, re.M)
        return float(found[1]) if found else 0

    def memory_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) / 1024

    def stop(self):
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(60)
        assert code == 0, f"lidar-edge ended with exit code {code}"
        return time.monotonic() - begin


def honest_robots(ports):
    """One sensor is coded once and sent as many robots, each with its own SCReAM."""
    source = "lidartestsrc is-live=true model=os0-32 mode=512x10 ! lidarenc effort=0 ! tee name=t"
    branches = [f"t. ! queue ! rtplidarpay ! screamsink host=127.0.0.1 port={port}" for port in ports]
    return subprocess.Popen(["gst-launch-1.0", "-q", *" ".join([source, *branches]).split()], stdout=subprocess.DEVNULL)


def run(args, hostile):
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        ports = [ends.free_port() for _ in range(1 + args.others)]
        edge = Edge(args.build, folder, ports)
        stack.callback(edge.process.kill)
        others = honest_robots(ports[1:])
        stack.callback(others.kill)
        socket = stack.enter_context(ends.udp_socket())
        end, sent = time.monotonic() + args.seconds, 0
        for packet in hostile_packets():
            if time.monotonic() >= end:
                break
            if hostile:
                socket.sendto(packet, ("127.0.0.1", ports[0]))
                sent += len(packet)
            time.sleep(0.02)
        names = [f"r{i}" for i in range(1, len(ports))]
        figures = {
            "hostile": hostile,
            "sent_mb": round(sent / 1e6, 2),
            "memory_mb": round(edge.memory_mb()),
            "received": sum(edge.metric("lidar_rtplidardepay_slices_received", name) for name in names),
            "lost": sum(edge.metric("lidar_rtplidardepay_slices_lost", name) for name in names),
            "packets_lost": sum(edge.metric("lidar_screamsrc_packets_lost", name) for name in names),
            "dropped": edge.metric("lidar_rtplidardepay_slices_changing_format", "r0"),
        }
        others.send_signal(signal.SIGINT)
        others.wait(20)
        figures["stop_s"] = round(edge.stop(), 2)
        return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--others", type=int, default=19, help="robots beside it")
    args = parser.parse_args()
    args.build = args.build.resolve()
    for hostile in (False, True):
        print(json.dumps(run(args, hostile)), flush=True)


if __name__ == "__main__":
    main()
