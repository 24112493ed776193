# SPDX-License-Identifier: LGPL-2.1-or-later
"""The part of NATS that a stranger needs to publish."""
import json
import socket


def _table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0xC96C5795D7870F42 if byte & 1 else 0)
        table.append(byte)
    return table


CRC64 = _table()


def crc64(data):
    """CRC-64/XZ: a format is named by the CRC of its text."""
    crc = 2**64 - 1
    for byte in data:
        crc = crc >> 8 ^ CRC64[(crc ^ byte) & 255]
    return crc ^ (2**64 - 1)


class Client:
    def __init__(self, url):
        self.url = url
        host, port = url.removeprefix("nats://").split(":")
        self.socket = socket.create_connection((host, int(port)))
        self.file = self.socket.makefile("rb")
        self.file.readline()  # skips the line INFO of the server
        self.socket.sendall(b'CONNECT {"verbose":false}\r\n')

    def publish(self, subject, data, reply=""):
        self.socket.sendall(f"PUB {subject} {reply} {len(data)}\r\n".encode() + data + b"\r\n")

    def _read(self):
        """Reads a line, or the data of a message."""
        line = self.file.readline()
        assert line, "the server has left"
        if line == b"PING\r\n":
            self.socket.sendall(b"PONG\r\n")
        if not line.startswith(b"MSG"):
            return line
        data = self.file.read(int(line.split()[-1]))
        self.file.readline()
        return data

    def flush(self):
        """Waits until the server has all that was published."""
        self.socket.sendall(b"PING\r\n")
        while self._read() != b"PONG\r\n":
            pass

    def make_stream(self, name, subjects):
        self.socket.sendall(b"SUB answers 1\r\n")
        settings = {"name": name, "subjects": subjects, "storage": "memory", "retention": "limits", "num_replicas": 1}
        self.publish(f"$JS.API.STREAM.CREATE.{name}", json.dumps(settings).encode(), "answers")
        while not (answer := self._read()).startswith(b"{"):
            pass
        assert "error" not in json.loads(answer), answer
