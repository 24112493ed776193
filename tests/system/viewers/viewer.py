# SPDX-License-Identifier: LGPL-2.1-or-later
"""A viewer of foxglovesink's slices, and a slow link to it. Only the standard library is needed."""
import base64
import json
import os
import queue
import select
import socket
import ssl
import struct
import threading
import time

HEAD = struct.Struct("<BIQ")  # opcode, subscription, time of capture
SLICE = struct.Struct("<BBHHHIIQ")  # version, flags, index, count, replay, scan, first column, sent
FRAME_SECONDS = 1 / 60


class Socket:
    """The WebSocket of a client (RFC 6455): sends texts, reads frames."""

    def __init__(self, port, path="/", host="127.0.0.1", tls=False):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10)
        if tls:
            context = ssl.create_default_context()
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
            self.socket = context.wrap_socket(self.socket, server_hostname=host)
        self.socket.sendall(
            f"GET {path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n".encode()
        )
        self.bytes = b""
        while b"\r\n\r\n" not in self.bytes:
            self.bytes += self.read()
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])

    def read(self):
        data = self.socket.recv(65536)
        if not data:
            raise ConnectionError("the server has ended the connection")
        return data

    def send(self, text, opcode=1):
        data = text.encode() if isinstance(text, str) else text
        size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(">H", len(data))
        self.socket.sendall(bytes([0x80 | opcode]) + size + bytes(4) + data)  # the mask is four zero bytes

    def frame(self):
        """Returns opcode and payload of the next frame, or None if it has not come completely."""
        b = self.bytes
        if len(b) < 2:
            return None
        size, at = b[1], 2
        if size == 126:
            size, at = struct.unpack(">H", b[2:4])[0] if len(b) >= 4 else 1 << 62, 4
        elif size == 127:
            size, at = struct.unpack(">Q", b[2:10])[0] if len(b) >= 10 else 1 << 62, 10
        if len(b) < at + size:
            return None
        self.bytes = b[at + size :]
        return b[0] & 15, b[at : at + size]

    def frames(self, seconds):
        """The frames of the next `seconds`; pings are answered."""
        until = time.monotonic() + seconds
        while True:
            frame = self.frame()
            if frame and frame[0] == 9:
                self.send(frame[1], opcode=10)
            elif frame:
                yield frame
                continue
            left = until - time.monotonic()
            pending = getattr(self.socket, "pending", lambda: 0)()
            if frame is None and not pending and not select.select([self.socket], [], [], max(left, 0))[0]:
                return
            if frame is None:
                self.bytes += self.read()
            if left < 0:
                return


class Viewer:
    """Acknowledges the newest slice each FRAME_SECONDS, as the page does, and notes the age of all."""

    SUBSCRIPTION, FRAME = 9, 4  # the id of the subscription, and the size of a frame's header in bytes

    def __init__(self, port, topic="/points/slices", **kwargs):
        self.socket = Socket(port, **kwargs)
        self.topic = topic
        self.slices = []  # (scan, index, age [s], bytes, is recoded, number of the replay)
        self.channels = {}
        self.recording = None  # the last message about the recording

    def run(self, seconds):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            newest = None
            for opcode, payload in self.socket.frames(FRAME_SECONDS):
                if opcode == 1:
                    self.on_text(json.loads(payload))
                elif opcode == 2:
                    newest = self.on_slice(payload) or newest
            if newest:
                scan, index = newest
                drawn = {"op": "drawn", "subscriptionId": self.SUBSCRIPTION, "scan": scan, "slice": index}
                self.socket.send(json.dumps(drawn))

    def on_text(self, message):
        if message["op"] == "recording":
            self.recording = message
        if message["op"] != "advertise":
            return
        for channel in message["channels"]:
            self.channels[channel["topic"]] = channel
            if channel["topic"] == self.topic:
                item = {"id": self.SUBSCRIPTION, "channelId": channel["id"]}
                self.socket.send(json.dumps({"op": "subscribe", "subscriptions": [item]}))

    def on_slice(self, payload):
        _, subscription, captured = HEAD.unpack_from(payload)
        if subscription != self.SUBSCRIPTION:
            return None
        _, flags, index, _, replay, scan, _, _ = SLICE.unpack_from(payload, HEAD.size)
        self.slices.append((scan, index, time.time() - captured / 1e9, len(payload), flags & 1, replay))
        return scan, index

    def until(self, what, holds, seconds=30):
        """Runs until `holds()` is true."""
        end = time.monotonic() + seconds
        while not holds():
            assert time.monotonic() < end, what
            self.run(0.2)

    def ask(self, op, **rest):
        self.socket.send(json.dumps({"op": op, "subscriptionId": self.SUBSCRIPTION, **rest}))

    def slice_bytes(self):
        return sum(s[3] - HEAD.size - SLICE.size for s in self.slices)

    def forget(self):
        self.slices = []

    def figures(self, seconds):
        """Scans a second, the age [ms] that 95 % are below, Mbit/s, bytes per byte of the slices, the part of slices
        coded anew."""
        ages = sorted(s[2] for s in self.slices)
        scans = len({s[0] for s in self.slices})
        return {
            "scans_per_second": round(scans / seconds, 2),
            "age_p95_ms": round(1e3 * ages[len(ages) * 95 // 100]) if ages else None,
            "mbit_per_second": round(8e-6 * sum(s[3] + self.FRAME for s in self.slices) / seconds, 2),
            "over_slices": round(sum(s[3] + self.FRAME for s in self.slices) / max(self.slice_bytes(), 1), 3),
            "recoded": round(sum(s[4] for s in self.slices) / max(len(self.slices), 1), 2),
        }


class Bottleneck:
    """Forwards connections to `port`: to the client at `mbit` Mbit/s, and both ways `delay` seconds late."""

    CHUNK, BUFFER = 1400, 16384

    def __init__(self, port, mbit, delay):
        self.target, self.bytes_per_second, self.delay = port, mbit * 1e6 / 8, delay
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            client = self.listener.accept()[0]
            server = socket.socket()
            # The kernel's buffer is small, because it adds to the buffer of the simulated link.
            server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, self.BUFFER)
            server.connect(("127.0.0.1", self.target))
            for s in (client, server):
                s.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self.forward(server, client, self.bytes_per_second)
            self.forward(client, server, None)

    def forward(self, source, sink, rate):
        late = queue.Queue()

        def receive():
            free = time.monotonic()
            try:
                while data := source.recv(self.CHUNK):
                    free = max(free, time.monotonic()) + (len(data) / rate if rate else 0)
                    time.sleep(max(free - time.monotonic(), 0))
                    late.put((free + self.delay, data))
            except OSError:
                pass
            late.put((0, b""))

        def send():
            try:
                while True:
                    at, data = late.get()
                    if not data:
                        break
                    time.sleep(max(at - time.monotonic(), 0))
                    sink.sendall(data)
                sink.shutdown(socket.SHUT_WR)
            except OSError:
                source.close()

        for work in (receive, send):
            threading.Thread(target=work, daemon=True).start()
