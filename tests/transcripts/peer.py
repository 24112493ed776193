#!/usr/bin/env -S python3 -ISE
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The other end of a program in a transcript.

    peer.py http PORT METHOD PATH [BODY] prints the status and the answer without white space
    peer.py rtp PORT PACKET...           sends PACKETs to PORT, and prints nothing
    peer.py link 'PACKET...' LIDAR-LINK  sends PACKETs through lidar-link one by one, each with an answer

A PACKET is SEQUENCE:TIMESTAMP:MARKER:TOS:SIZE; a TIMESTAMP of -AGE is the time of day before AGE seconds, of
+AGE that in AGE seconds.
"""
import json
import signal
import socket
import struct
import subprocess
import sys
import time

WAIT = 30


def http(port, method, path, body=""):
    with socket.create_connection(("127.0.0.1", int(port)), timeout=WAIT) as connection:
        head = f"{method} {path} HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Length: {len(body)}\r\n\r\n"
        connection.sendall((head + body).encode())
        answer = b"".join(iter(lambda: connection.recv(65536), b"")).decode()
    print(answer.split()[1], "".join(answer.partition("\r\n\r\n")[2].split()))


def packet(text):
    """Returns an RTP packet and its TOS."""
    sequence, timestamp, marker, tos, size = text.split(":")
    ticks = int(timestamp) if timestamp[0] not in "+-" else int((time.time() + float(timestamp)) * 90000)
    header = struct.pack(">BBHII", 0x80, int(marker) << 7 | 96, int(sequence), ticks & 0xFFFFFFFF, 100)
    return header + bytes(int(size) - len(header)), int(tos)


def send(sender, text, to):
    payload, tos = packet(text)
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_TOS, tos)
    sender.sendto(payload, to)


def rtp(port, *packets):
    with socket.socket(type=socket.SOCK_DGRAM) as sender:
        for text in packets:
            send(sender, text, ("127.0.0.1", int(port)))


def link(packets, *program):
    receiver, sender = (socket.socket(type=socket.SOCK_DGRAM) for _ in range(2))
    receiver.setsockopt(socket.IPPROTO_IP, socket.IP_RECVTOS, 1)
    receiver.bind(("127.0.0.1", 0))
    receiver.settimeout(WAIT)
    sender.settimeout(WAIT)
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_RECVTOS, 1)
    ends = ["--listen", "127.0.0.1:0", "--forward", f"127.0.0.1:{receiver.getsockname()[1]}"]
    with subprocess.Popen([*program, *ends, "--json-lines"], stdout=subprocess.PIPE, text=True) as running:
        port = json.loads(running.stdout.readline())["listening"][0]
        for text in packets.split():
            send(sender, text, ("127.0.0.1", port))
            payload, control, _, back = receiver.recvmsg(65536, 100)
            receiver.setsockopt(socket.IPPROTO_IP, socket.IP_TOS, 96 | payload[3] & 1)
            receiver.sendto(payload[:1 + payload[3]], back)
            answer, of_answer, _, _ = sender.recvmsg(65536, 100)
            print(f"{len(payload)} bytes, sequence {payload[3]}, TOS {control[0][2][0]}; "
                  f"answer of {len(answer)} bytes, TOS {of_answer[0][2][0]}")
        running.send_signal(signal.SIGINT)
        running.communicate()
    sys.exit(running.returncode)


if __name__ == "__main__":
    {"http": http, "rtp": rtp, "link": link}[sys.argv[1]](*sys.argv[2:])
