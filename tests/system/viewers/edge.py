# SPDX-License-Identifier: LGPL-2.1-or-later
"""A robot, and the edge that its viewers look at, each a process of GStreamer's."""
import os
import pathlib
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from ports import free_port  # noqa: E402


class Edge:
    """Serves a synthetic sensor over SCReAM to viewers at `port`."""

    def __init__(self, model="os1-64", coder="", mbit=2, sink=""):
        self.port, media = free_port("tcp"), free_port()
        self.edge = self.launch(f"screamsrc port={media} ! rtplidardepay ! foxglovesink port={self.port} {sink}")
        self.robot = self.launch(
            f"lidartestsrc is-live=true model={model} mode=1024x10 ! lidarenc {coder} ! rtplidarpay "
            f"! screamsink host=127.0.0.1 port={media} max-bitrate={int(mbit * 1e6)}"
        )

    def launch(self, pipeline):
        return subprocess.Popen(["gst-launch-1.0", "-q", *pipeline.split()])

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
        """Of the edge, so far."""
        fields = open(f"/proc/{self.edge.pid}/stat").read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
