#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Robots of a fleet behind one foxglovesink: lidar-edge, NATS, natssrc, and a viewer for each token.

A token opens its own robot; a token that is changed, expired or of another robot opens nothing. A robot that sends
garbage disturbs no viewer. Viewers replay what JetStream keeps.
"""
import base64
import hashlib
import hmac
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

from edge import free_port
from viewer import Socket, Viewer

SECRET = "0123456789abcdef0123456789abcdef"
ROBOTS = ("r7", "r8")
SKIPPED = 77


def base64url(data):
    return base64.urlsafe_b64encode(data).rstrip(b"=").decode()


def token(topics, seconds=600):
    """A JSON Web Token (RFC 7519), signed by HS256."""
    claims = {"exp": int(time.time()) + seconds, "topics": topics}
    text = base64url(b'{"alg":"HS256"}') + "." + base64url(json.dumps(claims).encode())
    return text + "." + base64url(hmac.new(SECRET.encode(), text.encode(), hashlib.sha256).digest())


def wait_for(port):
    until = time.monotonic() + 30
    while time.monotonic() < until:
        try:
            return socket.create_connection(("127.0.0.1", port)).close()
        except OSError:
            time.sleep(0.1)
    raise TimeoutError(f"nobody listens on {port}")


class Fleet:
    """Two robots, lidar-edge, a server, and the pipeline of the viewers at `port`."""

    def __init__(self, folder):
        nats, self.port = free_port(), free_port()
        self.robot_ports = {robot: free_port() for robot in ROBOTS}
        config = {
            "nats": {"url": f"nats://127.0.0.1:{nats}", "jetstream": "fleet"},
            "robots": [{"name": r, "sensor": "front", "port": p} for r, p in self.robot_ports.items()],
        }
        (folder / "edge.json").write_text(json.dumps(config))
        server = shutil.which("nats-server", path="/usr/sbin:/usr/local/bin")
        self.processes = [self.run(server, "-a", "127.0.0.1", "-p", str(nats), "-js", "-sd", str(folder))]
        wait_for(nats)
        self.processes.append(self.run(os.environ["LIDAR_EDGE"], folder / "edge.json"))
        pads = " ".join(f"sink_{i}::topic=/{r}/points" for i, r in enumerate(ROBOTS))
        sources = " ".join(
            f"natssrc url=nats://127.0.0.1:{nats} subject=fleet.{r}.lidar.front ! view.sink_{i}"
            for i, r in enumerate(ROBOTS)
        )
        self.launch(f"foxglovesink name=view port={self.port} token-secret={SECRET} {pads} {sources}")
        for port in self.robot_ports.values():
            self.launch(
                "lidartestsrc is-live=true model=os0-32 mode=512x10 ! lidarenc ! rtplidarpay "
                f"! screamsink host=127.0.0.1 port={port}"
            )
        wait_for(self.port)

    def run(self, *command):
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def launch(self, pipeline):
        self.processes.append(self.run("gst-launch-1.0", "-q", *pipeline.split()))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.kill()
            process.wait()

    def viewer(self, robot, topics):
        """Returns a viewer of the robot, once slices have come."""
        viewer = Viewer(self.port, topic=f"/{robot}/points/slices", path=f"/?token={token(topics)}")
        viewer.until(f"slices of {robot}", lambda: viewer.slices)
        return viewer

    def status(self, text):
        return Socket(self.port, path=f"/?token={text}").status


def go_back(viewer):
    """Replays what came before the viewer did, then goes back to live."""
    viewer.until("what JetStream keeps", lambda: viewer.recording and viewer.recording["to"] > viewer.recording["from"] + 2)
    begin = viewer.recording["from"]
    viewer.forget()
    viewer.ask("replay", number=1, time=begin)
    viewer.until("two seconds of scans", lambda: len({s[0] for s in viewer.slices if s[5] == 1}) >= 20)
    assert next(s[2] for s in viewer.slices if s[5] == 1) > 2, "slices of before"
    viewer.until("the end of the replay", lambda: viewer.recording["number"] == 1 and viewer.recording["end"])
    viewer.ask("live")
    viewer.until("live slices", lambda: viewer.slices[-1][5] == 0)


def main():
    if not shutil.which("nats-server", path="/usr/sbin:/usr/local/bin") or "LIDAR_EDGE" not in os.environ:
        print("nats-server or lidar-edge is missing")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name, Fleet(pathlib.Path(name)) as fleet:
        own = fleet.viewer("r7", ["/r7/*"])
        both = fleet.viewer("r8", ["/r7/*", "/r8/*"])
        assert {f"/{r}/points" for r in ROBOTS} <= set(both.channels), both.channels.keys()
        own.run(0.2)
        assert all(topic.startswith("/r7/") for topic in own.channels), own.channels.keys()
        go_back(own)
        # A viewer of r7 tries to subscribe to a channel of r8 by the channel's number.
        other = both.channels["/r8/points/slices"]["id"]
        own.forget()
        own.socket.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": 8, "channelId": other}]}))
        own.SUBSCRIPTION = 8
        own.run(1)
        assert not own.slices, "a token of r7 opened r8"
        good = token(["/r7/*"])
        assert fleet.status(good) == 101
        assert fleet.status(good[:-4] + ("AAAA" if good[-4:] != "AAAA" else "BBBB")) == 401, "changed"
        assert fleet.status(token(["/r7/*"], seconds=-1)) == 401, "over"
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            for i in range(500):
                stranger.sendto(os.urandom(40 + i), ("127.0.0.1", fleet.robot_ports["r8"]))
        both.forget()
        both.run(1)
        assert both.slices, "slices of r8 after nonsense"
    print("two robots, a viewer each")
    return 0


if __name__ == "__main__":
    sys.exit(main())
