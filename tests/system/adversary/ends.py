# SPDX-License-Identifier: LGPL-2.1-or-later
"""The ends of an attacked stream: pipelines in processes of their own, and an honest sender and receiver."""
import dataclasses
import json
import os
import pathlib
import random
import select
import socket
import subprocess
import sys
import threading
import time
import zlib

import wire

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from ports import free_port  # noqa: E402,F401

LOOPBACK = "127.0.0.1"
RECEIVER = ("screamsrc name=net address=127.0.0.1 port={port} {options} ! rtplidardepay name=depay ! "
            "lidardec name=dec ! fakesink name=out sync=false async=false")
SENDER = ("lidartestsrc is-live=true model=os0-32 mode=512x10 seed={seed} ! lidarenc name=dec effort=0 max-error=0.05 ! "
          "rtplidarpay name=pay mtu=1200 ! screamsink name=net host=127.0.0.1 port={port} {options}")

TWCC_URI = "http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01"
TWCC_SENDER = ("lidartestsrc is-live=true model=os0-32 mode=512x10 seed={seed} ! lidarenc name=dec effort=0 max-error=0.05 ! "
               "rtplidarpay name=pay mtu=1200 ! application/x-rtp,extmap-1=(string)" + TWCC_URI + " ! "
               "screamaux name=net {options} ! bin.send_rtp_sink_0 rtpbin name=bin rtp-profile=avpf "
               "bin.send_rtp_src_0 ! udpsink host=127.0.0.1 port={port} sync=false async=false "
               "bin.send_rtcp_src_0 ! fakesink sync=false async=false "
               "udpsrc address=127.0.0.1 port={rtcp_port} ! bin.recv_rtcp_sink_0")


def udp_socket(port=0):
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
    s.setsockopt(socket.IPPROTO_IP, socket.IP_RECVTOS if hasattr(socket, "IP_RECVTOS") else 13, 1)
    s.bind((LOOPBACK, port))
    return s


class Victim:
    """The program `victim` with a pipeline; the attribute `last` is its last report."""

    program = None  # set once by the main program
    longest_stop = 0  # the longest time that a victim needed to stop [s]

    def __init__(self, pipeline, **process):
        env = dict(os.environ)
        # AddressSanitizer keeps freed memory in a quarantine, and the measured memory of the
        # pipeline includes it. So the quarantine is small.
        env["ASAN_OPTIONS"] = ":".join(filter(None, [env.get("ASAN_OPTIONS"), "quarantine_size_mb=8"]))
        self.process = subprocess.Popen([self.program, pipeline], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, env=env, **process)
        self.shown = []  # CRC-32 of every slice that came out
        self.last = None
        self._read()

    def _read(self):
        line = self.process.stdout.readline()
        assert line, f"the pipeline died, exit code {self.process.wait()}"
        self.last = json.loads(line)
        self.shown += self.last["slices"]
        return self.last

    def ask(self, command="report"):
        self.process.stdin.write(command + "\n")
        self.process.stdin.flush()
        return self._read()

    def stat(self, element, name):
        return self.ask()[element].get(name, 0)

    def close(self):
        begin = time.monotonic()
        self.process.stdin.close()
        try:
            code = self.process.wait(180)  # ends much sooner if the machine is not busy
            Victim.longest_stop = max(Victim.longest_stop, time.monotonic() - begin)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise AssertionError("the pipeline did not end within 180 s") from None
        finally:
            self.process.stdout.close()
        assert code == 0, f"the pipeline ended with exit code {code}"

    def timed_close(self):
        """Closes the process. Returns the seconds until it is gone."""
        begin = time.monotonic()
        self.close()
        return time.monotonic() - begin


@dataclasses.dataclass
class Recording:
    config: bytes
    slices: list

    def crcs(self):
        return {zlib.crc32(s.body) for s in self.slices}


class HonestReceiver(threading.Thread):
    """Answers each stream with true feedback, and keeps what comes."""

    def __init__(self, sock=None):
        super().__init__(daemon=True)
        self.socket = sock or udp_socket()
        self.port = self.socket.getsockname()[1]
        self.packets = []
        self.sender = None
        self.answers = True
        self.running = True
        self._arrived = {}  # SSRC: {sequence: (time, ECN)}
        self._reported = 0
        self.start()

    def run(self):
        while self.running:
            if select.select([self.socket], [], [], 0.005)[0]:
                self._take(*self.socket.recvmsg(65536, 64))
            fresh = len(self.packets) - self._reported
            if fresh >= 16 or (fresh and self.packets[-1][1] >> 7):
                self._reported = len(self.packets)
                if self.answers:
                    self.socket.sendto(self.report(time.time()), self.sender)

    def _take(self, packet, ancillary, _flags, sender):
        if wire.is_rtcp(packet):
            return
        ecn = ancillary[0][2][0] & 3 if ancillary else 0
        r = wire.parse_rtp(packet)
        self.sender = sender
        self.packets.append(packet)
        arrived = self._arrived.setdefault(r.ssrc, {})
        arrived[r.sequence] = (time.time(), ecn)
        if len(arrived) > 64:
            del arrived[next(iter(arrived))]

    def report(self, now):
        blocks = []
        for ssrc, arrived in self._arrived.items():
            last = next(reversed(arrived))
            begin = min(arrived, key=lambda s: ((s - last + 0x8000) & 0xFFFF))
            metrics = []
            for i in range(((last - begin) & 0xFFFF) + 1):
                at, ecn = arrived.get((begin + i) & 0xFFFF, (None, 0))
                metrics.append((at is not None, ecn, int(1024 * (now - at)) if at else 0))
            blocks.append((ssrc, begin, metrics))
        return wire.ccfb(7, blocks, now)

    def close(self):
        self.running = False
        self.join()
        self.socket.close()


class TwccReceiver(HonestReceiver):
    """Answers with transport-wide feedback, to a port of its own."""

    def __init__(self):
        self.rtcp_to = (LOOPBACK, free_port())
        self.numbers = {}  # number: time of arrival
        self.newest = 0
        self._count = 0
        super().__init__()

    def _take(self, packet, ancillary, _flags, sender):
        if wire.is_rtcp(packet):
            return
        number = wire.transport_number(packet, 1)
        assert number is not None, "a packet without a number"
        self.sender = self.rtcp_to
        self.packets.append(packet)
        self.numbers[number] = time.time()
        self.newest = number
        if len(self.numbers) > 64:
            del self.numbers[next(iter(self.numbers))]

    def report(self, now):
        self._count += 1
        first = min(self.numbers, key=lambda n: (n - self.newest + 0x8000) & 0xFFFF)
        span = ((self.newest - first) & 0xFFFF) + 1
        return wire.twcc(first, [self.numbers.get((first + i) & 0xFFFF) for i in range(span)], self._count)


class HonestSender(threading.Thread):
    """Streams a recording over and over, at its pace, from a socket of its own."""

    def __init__(self, recording, port, ssrc=None, mtu=1200, slices_per_second=80, start=True):
        super().__init__(daemon=True)
        self.recording = recording
        self.to = (LOOPBACK, port)
        self.ssrc = random.getrandbits(32) if ssrc is None else ssrc
        self.room = mtu - 12
        self.interval = 1 / slices_per_second
        self.socket = udp_socket()
        self._next_socket = None
        self.sequence = random.getrandbits(16)
        self.sent = 0
        self.packets = []  # all packets that were sent
        # SSRCs of other media. Each slice is followed by a packet of each of them.
        self.companions = []
        self.feedback_bytes = 0
        self.config_id = wire.config_id(recording.config)
        self._scan_number = random.getrandbits(32)
        self._companion_sequence = 0
        self._paused = False
        self.running = True
        if start:
            self.start()

    def run(self):
        due = time.monotonic()
        while self.running:
            self._take_next_socket()
            if not self._paused:
                self._send_slice()
            while select.select([self.socket], [], [], 0)[0]:
                self.feedback_bytes += len(self.socket.recv(65536)) + 28
            due = max(due + self.interval, time.monotonic() - 0.1)
            time.sleep(max(due - time.monotonic(), 0))

    def next_slice(self):
        of = self.recording.slices
        s = of[self.sent % len(of)]
        number = self._scan_number + self.sent // s.count
        return dataclasses.replace(s, config_id=self.config_id, scan_number=number & 0xFFFF_FFFF,
                                   scan_id=self.sent // s.count, capture=wire.ntp(time.time()), skipped=0)

    def _send_slice(self):
        payloads = wire.slice_payloads(self.next_slice(), self.room)
        if self.sent % 20 == 0:
            payloads.insert(0, wire.config_unit(self.recording.config))
        for i, payload in enumerate(payloads):
            self.send(self.pack(payload, marker=i == len(payloads) - 1))
        self.sent += 1
        for ssrc in self.companions:
            self._companion_sequence += 1
            self.socket.sendto(wire.rtp(bytes(100), self._companion_sequence, 0, ssrc, payload_type=97), self.to)

    def pack(self, payload, marker=True):
        self.sequence = (self.sequence + 1) & 0xFFFF
        return wire.rtp(payload, self.sequence, int(time.time() * 90_000), self.ssrc, marker)

    def send(self, packet):
        self.packets.append(packet)
        try:
            self.socket.sendto(packet, self.to)
        except ConnectionRefusedError:
            pass  # the receiver has not started yet, or has ended

    def pause(self, paused=True):
        self._paused = paused

    def move(self):
        """Goes on from another port, as after NAT rebinding."""
        self._next_socket = udp_socket()
        while self._next_socket and self.is_alive():
            time.sleep(0.001)
        self._take_next_socket()

    def _take_next_socket(self):
        """Closes the old socket in the thread that uses it, if that runs."""
        if self._next_socket:
            self.socket.close()
            self.socket, self._next_socket = self._next_socket, None

    def close(self):
        self.running = False
        if self.ident:
            self.join()
        self.socket.close()


class Relay(threading.Thread):
    """Stands between a sender and a receiver, and keeps a copy of the media."""

    def __init__(self, to_port):
        super().__init__(daemon=True)
        self.inside = udp_socket()
        self.outside = udp_socket()
        self.port = self.inside.getsockname()[1]
        self.to = (LOOPBACK, to_port)
        self.media = []
        self.on_media = None  # a function that gets each packet and returns the packets to forward
        self.running = True
        self.start()

    def run(self):
        sender = None
        while self.running:
            for s in select.select([self.inside, self.outside], [], [], 0.01)[0]:
                packet, source = s.recvfrom(65536)
                if s is self.outside:
                    if sender:
                        self.inside.sendto(packet, sender)
                    continue
                sender = source
                self.media.append(packet)
                for out in self.on_media(packet) if self.on_media else [packet]:
                    self.outside.sendto(out, self.to)

    def close(self):
        self.running = False
        self.join()
        self.inside.close()
        self.outside.close()


def whole_scans(slices):
    """Returns the slices of the scans that are complete."""
    scans = {}
    for s in slices:
        scans.setdefault(s.scan_number, []).append(dataclasses.replace(s, skipped=0))
    return [s for scan in scans.values() if len(scan) == scan[0].count for s in scan]


def record(seed, scans):
    """Records at least `scans` whole scans of a real sender, read by the rules of docs/wire-format.md."""
    receiver = HonestReceiver()
    victim = Victim(SENDER.format(port=receiver.port, seed=seed, options=""))
    until = time.monotonic() + 300  # much longer than needed, for a busy machine
    reader, read, whole = wire.Reader(), 0, []
    while time.monotonic() < until and len(whole) < 8 * scans:
        time.sleep(0.05)
        packets = receiver.packets
        while read < len(packets):
            reader.push(packets[read])
            read += 1
        whole = whole_scans(reader.slices)
    report = victim.ask()
    victim.close()
    receiver.close()
    assert len(whole) >= 8 * scans, f"only {len(whole)} slices of whole scans came"
    assert report["net"]["feedback-accepted"] > 10 and report["net"]["feedback-ignored"] == 0, report["net"]
    assert len(reader.configs) == 1
    return Recording(next(iter(reader.configs.values())), whole)
