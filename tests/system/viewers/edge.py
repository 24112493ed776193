#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""A robot, and the edge that its viewers look at, each a process.

As a program it is the edge: it runs the pipeline of its arguments, and for each line of its input prints the p95 of
the slices' ages [ms] after foxglovesink since the line before.
"""
import os
import pathlib
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from ports import free_port


class Edge:
    """Serves a synthetic sensor over SCReAM to viewers at `port`."""

    def __init__(self, model="os1-64", coder="", mbit=2, sink=""):
        self.port, media = free_port(), free_port()
        # A tee pushes a buffer to its branches one after the other. If foxglovesink blocked, the
        # buffer would arrive late in the second branch.
        pipeline = (
            f"screamsrc port={media} ! rtplidardepay ! tee name=t t. ! identity ! foxglovesink port={self.port} {sink} "
            "t. ! fakesink name=behind sync=false async=false signal-handoffs=true"
        )
        self.edge = subprocess.Popen(
            ["/usr/bin/python3", pathlib.Path(__file__), pipeline], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.robot = subprocess.Popen(
            "gst-launch-1.0 -q lidartestsrc is-live=true "
            f"model={model} mode=1024x10 ! lidarenc {coder} ! rtplidarpay "
            f"! screamsink host=127.0.0.1 port={media} max-bitrate={int(mbit * 1e6)}".split()
        )

    def __enter__(self):
        until = time.monotonic() + 60
        while time.monotonic() < until:
            try:
                socket.create_connection(("127.0.0.1", self.port)).close()
                return self
            except OSError:
                time.sleep(0.1)
        raise TimeoutError("the edge does not listen")

    def __exit__(self, *_):
        for process in (self.robot, self.edge):
            process.kill()
            process.wait()

    def processor_seconds(self):
        """Returns the processor time of the edge so far."""
        fields = open(f"/proc/{self.edge.pid}/stat").read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def delay_ms(self):
        """Returns p95 of the delays since the last call, from capture until the slice has passed foxglovesink."""
        self.edge.stdin.write("\n")
        self.edge.stdin.flush()
        return float(self.edge.stdout.readline())


def run(text):
    import gi

    gi.require_version("Gst", "1.0")
    from gi.repository import Gst

    Gst.init(None)
    pipeline, ages = Gst.parse_launch(text), []
    captured = Gst.Caps.from_string("timestamp/x-unix")

    def note(_, buffer, __):
        ages.append(time.time() - buffer.get_reference_timestamp_meta(captured).timestamp / 1e9)

    pipeline.get_by_name("behind").connect("handoff", note)
    pipeline.set_state(Gst.State.PLAYING)
    for _ in sys.stdin:
        passed, ages[:] = sorted(ages), []
        print(1e3 * passed[len(passed) * 95 // 100] if passed else "nan", flush=True)


if __name__ == "__main__":
    run(sys.argv[1])
