#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""CPU time and bytes that SRTP costs each end, for a stream of 55 Mbit/s over loopback.

usage: srtp_overhead.py [BUILD_DIR] [SECONDS]; prints the least of ROUNDS runs
"""
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import build_tree  # noqa: E402

BUILD = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "build")
SECONDS = int(sys.argv[2]) if len(sys.argv) > 2 else 10
ROUNDS = 4
PORT = 5464
KEYS = {"aes-128-icm": 30, "aes-256-icm": 46, "aes-128-gcm": 28, "aes-256-gcm": 44}
CAPS = ("application/x-rtp,media=video,clock-rate=90000,encoding-name=RAW,sampling=RGB,depth=(string)8,"
        "width=(string)320,height=(string)240,payload=96")


def launch(pipeline):
    return subprocess.Popen(["gst-launch-1.0", "-q", "-e"] + pipeline.split(), env=build_tree.environment(BUILD),
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def cpu(process):
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit("gst-launch-1.0 failed")
    return usage.ru_utime + usage.ru_stime


def sender(options, seconds):
    return launch(f"videotestsrc is-live=true num-buffers={30 * seconds} pattern=black ! "
                  "video/x-raw,format=RGB,width=320,height=240,framerate=30/1 ! rtpvrawpay mtu=1200 ! "
                  f"screamsink port={PORT} min-bitrate=80000000 start-bitrate=90000000 max-bitrate=100000000 "
                  + options)


def run(options):
    """Returns the CPU time of sender and receiver, and the bytes that came through."""
    out = tempfile.NamedTemporaryFile(dir="/dev/shm")
    receiver = launch(f"screamsrc port={PORT} caps={CAPS} {options} ! filesink location={out.name} sync=false async=false")
    time.sleep(1)
    sending = sender(options, SECONDS)
    return cpu(sending), cpu(receiver), os.path.getsize(out.name)


def packet_size(options):
    """Returns the bytes of UDP payload in a full packet."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(("127.0.0.1", PORT))
        listener.settimeout(5)
        process = sender(options, 1)
        sizes = [len(listener.recv(2048)) for _ in range(10)]
        process.kill()
        process.wait()
    return max(sizes)


def main():
    suites = {"": "", **{c: f"srtp-cipher={c} srtp-key={'5a' * size}" for c, size in KEYS.items()},
              "hmac-sha1-32": f"srtp-auth=hmac-sha1-32 srtp-key={'5a' * 30}"}
    rounds = [{name: run(options) for name, options in suites.items()} for _ in range(ROUNDS)]
    # The least time of all rounds is used, because disturbances by other programs can only make a
    # time longer.
    least = {name: [min(r[name][end] for r in rounds) for end in (0, 1)] for name in suites}
    size = packet_size("")
    came = [r[name][2] for r in rounds for name in suites]
    if min(came) < 0.99 * max(came):
        sys.exit(f"{min(came)} to {max(came)} bytes came through: too busy a machine")
    packets = max(came) / size
    print(f"without SRTP: {8e-6 * max(came) / SECONDS:.1f} Mbit/s in packets of {size} bytes; "
          f"{1e3 * least[''][0] / SECONDS:.0f} ms of CPU a second at the sender, {1e3 * least[''][1] / SECONDS:.0f} at the receiver")
    for name, options in list(suites.items())[1:]:
        more = [u - b for u, b in zip(least[name], least[""])]
        print(f"{name:>12}: {1e3 * more[0] / SECONDS:+5.1f} and {1e3 * more[1] / SECONDS:+5.1f} ms; "
              f"{1e6 * more[0] / packets:4.1f} and {1e6 * more[1] / packets:4.1f} us and {packet_size(options) - size} bytes a packet")


main()
