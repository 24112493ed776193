#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What many connections, topics, robots, sensors and formats of a stranger cost.

Prints a line of JSON for each kind and number: processor time of the victim, its most memory, what it reported, and
how long it took to stop. Ends with 1 if the time grows faster than the number, or a stop takes longer than a second.
"""
import argparse
import collections
import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import time
import urllib.request

import ends
import nats

COUNTS = (1_000, 8_000, 65_000)
# The number of chunks in a recording that expand to 128 MiB each. To read them takes longer than
# the time for which the victim waits for its state.
BOMBS = 600
MOST_STOP = 1  # the longest time to stop [s]
SLICES = "application/x-lidar-slice, alignment=(string)slice, number=(int)"
RECORDING = "mcapsrc name=src location={path} ! fakesink name=out"
SUBJECT = "fleet.r7.lidar.front"
PATIENCE = 300  # the longest wait [s]


class Process:
    """A program that is watched."""

    def __init__(self, *words, **options):
        words = [str(word) for word in words]
        self.process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, **options)

    def cpu(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")")[-1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) / 1024

    def stop(self):
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=60)
        return time.monotonic() - begin


def program(build, name):
    return next(p for p in build.rglob(name) if p.is_file() and os.access(p, os.X_OK))


def metric(url, name):
    text = urllib.request.urlopen(url, timeout=PATIENCE).read().decode()
    return float(re.search(rf"^{name}\S* (\S+)$", text, re.M)[1])


def connections(args, count, folder):
    """Silent connections to the metrics of lidar-edge."""
    config = folder / "edge.json"
    config.write_text(json.dumps({"http-port": 0, "interval": 0.5, "robots": [{"name": "r7", "port": ends.free_port()}]}))
    edge = Process(program(args.build, "lidar-edge"), config, stderr=subprocess.DEVNULL)
    url = re.search(r"http:\S+", edge.process.stdout.readline())[0]
    port = int(re.search(r":(\d+)/", url)[1])
    begin, silent = edge.cpu(), collections.deque()
    for _ in range(count):
        silent.append(socket.create_connection((ends.LOOPBACK, port)))
        # The server closes the oldest silent connection to make room for a newer one.
        if len(silent) > 40:
            oldest = silent.popleft()
            oldest.settimeout(PATIENCE)
            assert oldest.recv(1) == b"", "a silent connection got an answer"
            oldest.close()
    used = edge.cpu() - begin
    since = time.monotonic()
    while (told := metric(url, "lidar_http_connections_cut")) < count - 40:
        assert time.monotonic() - since < PATIENCE, "not told"
        time.sleep(0.2)
    for connection in silent:
        connection.close()
    return used, edge.memory_mb(), told, edge.stop()


def mcap_record(op, content):
    return struct.pack("<BQ", op, len(content)) + content


def mcap_text(text):
    return struct.pack("<I", len(text)) + text.encode()


def topics(args, count, folder):
    """A recording of topics with a message each."""
    path = folder / "topics.mcap"
    with path.open("wb") as file:
        file.write(b"\x89MCAP0\r\n" + mcap_record(1, mcap_text("") * 2))
        file.write(mcap_record(3, struct.pack("<H", 1) + mcap_text("gst_lidar_msgs/msg/CodedSlice") + mcap_text("ros2msg") + mcap_text("x")))
        metadata = mcap_text("gst_caps") + mcap_text("application/x-lidar-slice,alignment=(string)slice")
        for i in range(count):
            channel = struct.pack("<HH", i + 1, 1) + mcap_text(f"/t{i}") + mcap_text("cdr")
            file.write(mcap_record(4, channel + struct.pack("<I", len(metadata)) + metadata))
            file.write(mcap_record(5, struct.pack("<HIQQ", i + 1, 0, i, i)))
        file.write(mcap_record(15, bytes(4)) + mcap_record(2, bytes(20)) + b"\x89MCAP0\r\n")
    player = ends.Victim(RECORDING.format(path=path))
    begin = time.monotonic()
    while not player.ask()["eos"] and not player.last["error"]:
        assert time.monotonic() - begin < PATIENCE, "the recording has no end"
        time.sleep(0.05)
    told = bool(player.last["error"]) or player.last["warnings"]
    return player.last["cpu"], player.last["rss_kb"] / 1024, told, player.timed_close()


def bombs(args, count, folder):
    """Chunks of 128 MiB of zeros in a recording; the pipeline is stopped while it reads them."""
    path, file = folder / "bombs.mcap", bytearray(b"\x89MCAP0\r\n")
    blocks = 1024
    zeros = b"\x28\xb5\x2f\xfd\xa0" + struct.pack("<I", blocks << 17)
    zeros += b"".join(struct.pack("<I", (i == blocks - 1) | 1 << 1 | 1 << 20)[:3] + b"\0" for i in range(blocks))
    summary = mcap_record(3, struct.pack("<H", 1) + mcap_text("gst_lidar_msgs/msg/CodedSlice") + mcap_text("ros2msg") + mcap_text("x"))
    metadata = mcap_text("gst_caps") + mcap_text("application/x-lidar-slice,alignment=(string)slice")
    summary += mcap_record(4, struct.pack("<HH", 1, 1) + mcap_text("/t") + mcap_text("cdr") + struct.pack("<I", len(metadata)) + metadata)
    for i in range(1, count + 1):
        at = len(file)
        file += mcap_record(6, struct.pack("<QQQI", i, i, blocks << 17, 0) + mcap_text("zstd") + struct.pack("<Q", len(zeros)) + zeros)
        summary += mcap_record(8, struct.pack("<QQQQIQ", i, i, at, len(file) - at, 0, 0) + mcap_text("zstd") + struct.pack("<QQ", len(zeros), blocks << 17))
    file += mcap_record(15, bytes(4))
    start = len(file)
    file += summary + mcap_record(2, struct.pack("<QQI", start, 0, 0)) + b"\x89MCAP0\r\n"
    path.write_bytes(file)
    player = ends.Victim(RECORDING.format(path=path))
    time.sleep(0.5)
    return player.ask()["cpu"], player.last["rss_kb"] / 1024, player.last["warnings"], player.timed_close()


@contextlib.contextmanager
def server(folder):
    """A nats-server with the stream that lidar-worker follows."""
    words = ["nats-server", "-a", ends.LOOPBACK, "-p", "-1", "-js", "-sd", folder / "store", "--ports_file_dir", folder,
             "-l", folder / "log"]
    process = subprocess.Popen([str(word) for word in words],
                               env={**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin:/usr/local/bin"})
    try:
        while not (found := list(folder.glob("*.ports"))) or "nats://" not in found[0].read_text():
            time.sleep(0.05)
        client = nats.Client(json.loads(found[0].read_text())["nats"][0])
        client.make_stream("fleet", ["fleet.*.lidar.>"])
        yield client
    finally:
        process.kill()
        process.wait()


def watched_subjects(args, folder, subjects):
    """The processor time that lidar-worker takes in 3 s."""
    with server(folder) as client:
        for subject in subjects:
            client.publish(subject, b"x")
        client.flush()
        worker = Process(program(args.build, "lidar-worker"), "*", "--url", client.url, "--http-port", 0, "--interval", 0.5,
                         stderr=subprocess.DEVNULL)
        url = None
        while not url:
            url = re.search(r"http:\S+", worker.process.stdout.readline())
        time.sleep(3)
        begin = worker.cpu()
        time.sleep(3)
        used = worker.cpu() - begin
        return used, worker.memory_mb(), metric(url[0], "lidar_worker_sensors_left_out"), worker.stop()


def sensors(args, count, folder):
    """Sensors made up by one robot; lidar-worker follows all."""
    return watched_subjects(args, folder, [f"fleet.r7.lidar.s{i}" for i in range(count)])


def robots(args, count, folder):
    """Robots made up by a client that may publish; lidar-worker follows all."""
    return watched_subjects(args, folder, [f"fleet.r{i}.lidar.front" for i in range(count)])


def formats(args, count, folder):
    """Announces formats of a stream over NATS, then a damaged one until natssrc has counted it."""
    with server(folder) as client:
        receiver = ends.Victim(f"natssrc name=src url={client.url} subject={SUBJECT} ! fakesink name=out")
        client.flush()
        time.sleep(1)
        begin = receiver.ask()["cpu"]
        for i in range(count):
            text = (SLICES + str(i)).encode()
            client.publish(f"{SUBJECT}.config.{nats.crc64(text):016x}", text)
            if i % 500 == 499:
                client.flush()
        nested = SLICES.encode() + b"1, a=" + b"[[ a, b={" * 60
        since = time.monotonic()
        while receiver.ask()["src"]["formats-damaged"] < 1:
            client.publish(f"{SUBJECT}.config.{0:016x}", nested)
            client.flush()
            assert time.monotonic() - since < PATIENCE, "the formats are not read"
            time.sleep(0.05)
        last = receiver.last
        return last["cpu"] - begin, last["rss_kb"] / 1024, last["src"]["formats-damaged"], receiver.timed_close()


KINDS = (connections, topics, robots, sensors, formats)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", help="kinds, as in topics,formats")
    parser.add_argument("--most", type=int, default=COUNTS[-1], help="the largest number")
    args = parser.parse_args()
    args.build = args.build.resolve()
    ends.Victim.program = str(args.build / "tests/system/adversary/victim")
    failed = False
    kinds = [k for k in KINDS + (bombs,) if not args.only or k.__name__ in args.only.split(",")]
    for kind in kinds:
        used = {}
        for count in [c for c in COUNTS if c <= args.most] if kind is not bombs else [BOMBS]:
            folder = pathlib.Path(tempfile.mkdtemp())
            try:
                used[count], memory, told, stop = kind(args, count, folder)
            finally:
                shutil.rmtree(folder, ignore_errors=True)
            print(json.dumps({"kind": kind.__name__, "count": count, "cpu_s": round(used[count], 2),
                              "memory_mb": round(memory), "told": float(told), "stop_s": round(stop, 2)}), flush=True)
            failed |= stop > MOST_STOP
        least, most = min(used), max(used)
        # A short CPU time counts as 0.05 s, because it is measured in ticks of 10 ms.
        failed |= used[most] > 2 * most / least * max(used[least], 0.05)
    raise SystemExit(failed)


if __name__ == "__main__":
    main()
