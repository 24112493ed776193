#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Latency, load, loss and recovery of ouster_src against ouster-replay, over loopback sockets.

Run in `meson devenv -C build`; prints Markdown tables. Fails if losses are not counted exactly.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

PORT = 17502  # the port for LiDAR packets; IMU packets use the next port


class Sensor:
    """ouster-replay as a child process."""

    def __init__(self, tool, *arguments):
        ports = ["--lidar-port", str(PORT), "--imu-port", str(PORT + 1)]
        self.process = subprocess.Popen([tool, "--http-port", "0", *ports, *arguments],
                                        stdout=subprocess.PIPE, text=True)
        self.http = json.loads(self.process.stdout.readline())["http"]
        self.host = f"127.0.0.1:{self.http}"

    def request(self, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        with urllib.request.urlopen(f"http://{self.host}{path}", data, timeout=5) as answer:
            return json.loads(answer.read())

    def stop(self):
        self.process.terminate()
        return json.loads(self.process.stdout.read().splitlines()[-1])


class Receiver:
    """gst-launch-1.0 with ouster_src; notes when buffers and messages come."""

    def __init__(self, host, debug=False):
        environment = dict(os.environ, GST_DEBUG_NO_COLOR="1")
        if debug:
            environment["GST_DEBUG"] = "ouster_src:6"
        sink = ["fakesink", "sync=false"] + ([] if debug else ["silent=false"])
        flags = ["-m"] if debug else ["-m", "-v"]
        self.process = subprocess.Popen(
            ["gst-launch-1.0", *flags, "ouster_src", "name=s", f"hostname={host}", "udp-dest=@auto",
             f"lidar-port={PORT}", f"imu-port={PORT + 1}", "!", *sink],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
        self.latencies = []
        self.buffers = []
        self.lost = 0
        self.kernel_drops = 0
        self.thread = threading.Thread(target=self.read)
        self.thread.start()

    def read(self):
        for line in self.process.stdout:
            found = re.search(r"leaves (-?\d+) us after", line)
            if found:
                self.latencies.append(int(found.group(1)))
            elif "last-message = chain" in line:
                self.buffers.append(time.monotonic())
            elif "ouster-packet-loss" in line:
                self.lost = int(re.search(r"total=\(guint64\)(\d+)", line).group(1))
                self.kernel_drops = int(re.search(r"kernel=\(guint64\)(\d+)", line).group(1))

    def cpu_seconds(self):
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def stop(self):
        self.process.terminate()
        self.process.wait()
        self.thread.join()


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else float("nan")


def load(tool, seconds, model, mode, speeds, loss):
    """Measures each speed. Returns whether the element counted all lost packets, and no other."""
    exact = True
    with tempfile.TemporaryDirectory() as folder:
        pcap, metadata = f"{folder}/drive.pcap", f"{folder}/drive.json"
        subprocess.run([tool, "--synthesize", model, "--mode", mode, "--scans", "10",
                        "--write-pcap", pcap, "--write-metadata", metadata], check=True)
        for speed in speeds:
            sensor = Sensor(tool, "--pcap", pcap, "--metadata", metadata, "--speed", str(speed),
                            "--dest", "")
            receiver = Receiver(sensor.host, debug=True)
            time.sleep(3)
            before = sensor.request("/replay/stats")
            receiver.latencies.clear()
            lost_before = receiver.lost
            sensor.request("/replay/faults", {"loss": loss})
            cpu, start = receiver.cpu_seconds(), time.monotonic()
            time.sleep(seconds)
            cpu, elapsed = receiver.cpu_seconds() - cpu, time.monotonic() - start
            sent = sensor.request("/replay/stats")["sent"] - before["sent"]
            sensor.request("/replay/faults", {"loss": 0})
            time.sleep(2.5)  # losses are reported once per second
            after = sensor.request("/replay/stats")
            receiver.stop()
            sensor.stop()
            dropped = after["lost"] - before["lost"] + receiver.kernel_drops
            exact = exact and receiver.lost - lost_before == dropped
            print(f"| {model} {mode} | {speed:g} x | {sent / elapsed:.0f} | {100 * cpu / elapsed:.0f} % "
                  f"| {percentile(receiver.latencies, 0.5)} "
                  f"| {percentile(receiver.latencies, 0.99)} | {after['lost'] - before['lost']} "
                  f"| {receiver.kernel_drops} | {receiver.lost - lost_before} |", flush=True)
    return exact


def wait_for_buffer(receiver, since, limit=20):
    """Time from `since` to the first buffer after it [s]."""
    while time.monotonic() < since + limit:
        later = [t for t in receiver.buffers if t > since]
        if later:
            return later[0] - since
        time.sleep(0.005)
    return float("nan")


def recovery(tool):
    sensor = Sensor(tool, "--synthesize", "os0-32", "--mode", "1024x10", "--dest", "",
                    "--boot", "0.5")
    receiver = Receiver(sensor.host)
    wait_for_buffer(receiver, time.monotonic())
    time.sleep(1)

    def fault_and_end(name, fault, end, seconds):
        sensor.request("/replay/faults", fault)
        time.sleep(seconds)
        sensor.request("/replay/faults", end)
        taken = wait_for_buffer(receiver, time.monotonic())
        print(f"| {name} | packets fit again | {1000 * taken:.0f} ms |", flush=True)
        time.sleep(1)

    fault_and_end("silent for 3 s (unplugged)", {"silent": True}, {"silent": False}, 3)
    fault_and_end("packets of a wrong size for 2 s", {"wrong_size": True}, {"wrong_size": False}, 2)

    def restart(name, path, body, http):
        sensor.request("/replay/faults", http)
        sensor.request(path, body)
        time.sleep(0.1)
        taken = wait_for_buffer(receiver, time.monotonic()) + 0.1 - 0.5
        print(f"| {name} | the sensor scans again | {1000 * taken:.0f} ms |", flush=True)
        sensor.request("/replay/faults", {"http_status": 0, "http_delay_ms": 0})
        time.sleep(2)

    restart("restart, new init id", "/replay/restart", {}, {})
    restart("restart while HTTP answers 500", "/replay/restart", {}, {"http_status": 500})
    restart("restart while HTTP takes 1 s", "/replay/restart", {}, {"http_delay_ms": 1000})
    restart("another mode and profile set by someone else",
            "/api/v1/sensor/config?reinit=true&persist=false",
            {"lidar_mode": "512x20", "udp_profile_lidar": "RNG15_RFL8_NIR8"}, {})
    receiver.stop()
    sensor.stop()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tool", default="ouster-replay", help="path of ouster-replay")
    parser.add_argument("--seconds", type=float, default=10, help="of each measurement of load")
    parser.add_argument("--speeds", type=float, nargs="+", default=[1, 2, 4])
    parser.add_argument("--loss", type=float, default=0.001, help="share of packets dropped")
    parser.add_argument("--model", default="os1-128")
    parser.add_argument("--modes", nargs="+", default=["2048x10", "1024x20"])
    parser.add_argument("--port", type=int, default=PORT, help="of the lidar packets; the IMU's is the next")
    parser.add_argument("what", choices=["load", "recovery"])
    arguments = parser.parse_args()
    globals()["PORT"] = arguments.port
    if arguments.what == "recovery":
        print("| fault | time counts from when | to the next slice |\n|---|---|---|")
        recovery(arguments.tool)
    else:
        print("| sensor | rate | packets/s | CPU of a core | latency p50 [us] | p99 [us] "
              "| packets dropped on request | by the kernel | counted as lost |\n"
              "|---|---|---|---|---|---|---|---|---|")
        results = [load(arguments.tool, arguments.seconds, arguments.model, mode, arguments.speeds,
                        arguments.loss) for mode in arguments.modes]
        if not all(results):
            sys.exit("losses were not counted exactly")


if __name__ == "__main__":
    sys.exit(main())
