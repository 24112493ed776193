# SPDX-License-Identifier: LGPL-2.1-or-later
"""Servers that speak HTTP badly where ouster_src expects a sensor."""
import gzip
import json
import socket
import threading
import time

import ends
from bench import MOST_PATIENCE

OK = b"HTTP/1.1 200 OK\r\n"
LIMIT_KB = 64 * 1024


def answer(body, extra=b""):
    return OK + b"Content-Type: application/json\r\n" + extra + b"Content-Length: %d\r\n\r\n" % len(body) + body


def drip(pieces, pause):
    for piece in pieces:
        yield piece
        time.sleep(pause)


def forever(piece):
    while True:
        yield piece


def chunks(size):
    yield OK + b"Transfer-Encoding: chunked\r\n\r\n"
    yield from forever(b"%x\r\n" % size + b"[" * size + b"\r\n")


def redirects(port):
    yield b"HTTP/1.1 302 Found\r\nLocation: http://127.0.0.1:%d/again\r\nContent-Length: 0\r\n\r\n" % port


def file_redirect(_port):
    yield b"HTTP/1.1 302 Found\r\nLocation: file:///etc/passwd\r\nContent-Length: 0\r\n\r\n"


MEBIBYTE = 1 << 20
SERVERS = {
    "drips headers": lambda _: drip([OK] + [b"X: y\r\n"] * 100_000, 0.01),
    "drips a body": lambda _: drip([OK + b"Content-Length: 100000\r\n\r\n"] + [b"["] * 100_000, 0.01),
    "headers without end": lambda _: forever(b"X-Pad: " + b"x" * 8000 + b"\r\n"),
    "one header without end": lambda _: forever(b"x" * 8000),
    "chunks without end": lambda _: chunks(65536),
    "chunks of wrong size": lambda _: iter([OK + b"Transfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n[["]),
    "redirects without end": redirects,
    "redirects to a file": file_redirect,
    "a compressed gibibyte": lambda _: iter([answer(gzip.compress(b" " * (64 << 20)), b"Content-Encoding: gzip\r\n")]),
    "a mebibyte of strings": lambda _: iter([answer(b'["' + b"x" * (MEBIBYTE - 10) + b'"]')]),
    "a mebibyte of objects": lambda _: iter([answer(b"[" + b"{}," * (MEBIBYTE // 3 - 10) + b"{}]")]),
    "a mebibyte of digits": lambda _: iter([answer(b"1" * MEBIBYTE)]),
    "depth": lambda _: iter([answer(b"[" * MEBIBYTE)]),
    "beams without end": lambda _: iter([answer(json.dumps({"beam_altitude_angles": [1e308] * 50_000}).encode())]),
    "numbers out of range": lambda _: iter([answer(json.dumps({"lidar_data_format": {
        "columns_per_frame": -1, "pixels_per_column": 1e300, "columns_per_packet": 0}}).encode())]),
    "nothing": lambda _: iter([]),
    "another protocol": lambda _: iter([b"SSH-2.0-OpenSSH_9.2\r\n"]),
    "a length below 0": lambda _: iter([OK + b"Content-Length: -5\r\n\r\n{}"]),
}


class Server(threading.Thread):
    def __init__(self, behaviour):
        super().__init__(daemon=True)
        self.behaviour = behaviour
        self.listener = socket.create_server((ends.LOOPBACK, 0))
        self.port = self.listener.getsockname()[1]
        self.requests = 0
        self.start()

    def run(self):
        while True:
            try:
                connection, _ = self.listener.accept()
            except OSError:
                return
            threading.Thread(target=self._serve, args=(connection,), daemon=True).start()

    def _serve(self, connection):
        with connection:
            try:
                connection.recv(65536)
                self.requests += 1
                for piece in self.behaviour(self.port):
                    connection.sendall(piece)
                connection.shutdown(socket.SHUT_WR)
                connection.settimeout(1)
                while connection.recv(65536):
                    pass
            except OSError:
                pass  # the client has closed the connection

    def close(self):
        self.listener.close()


def bad_server(name):
    def attack(context):
        server = Server(SERVERS[name])
        victim = ends.Victim(f"ouster_src name=src hostname=127.0.0.1:{server.port} lidar-port={ends.free_port()} "
                             f"imu=false ! fakesink name=out sync=false async=false")
        start, rss = time.monotonic(), victim.last["rss_kb"]
        while server.requests == 0:
            assert time.monotonic() - start < MOST_PATIENCE, "nobody asked"
            time.sleep(0.02)
        time.sleep(min(1.0, context.seconds))
        report = victim.ask()
        grown = report["rss_kb"] - rss
        assert grown < LIMIT_KB * context.memory_factor, f"memory grew by {grown} kB"
        took = victim.ask("null")["took"]
        limit = 3000 if context.sanitized else 1000
        assert took < limit, f"stopping took {took} ms"
        victim.close()
        server.close()
        return f"{server.requests} requests, stopped within {took} ms"

    attack.__name__ = "server: " + name
    attack.__doc__ = "ouster_src asks a server that sends " + name
    return attack


ALL = [bad_server(name) for name in SERVERS]
