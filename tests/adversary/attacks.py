# SPDX-License-Identifier: LGPL-2.1-or-later
"""The attacks. Each asserts what docs/security.md promises, and returns a line on what it saw."""
import dataclasses
import random
import struct
import time
import zlib

import ends
import wire

MOST_BITRATE = 20_000_000  # of senders
MOST_PATIENCE = 30  # seconds, of a machine that others use
MOST_GROWTH_KB = 96 * 1024  # what the queues of docs/security.md hold together


class Bench:
    """A receiver with an honest sender."""

    def __init__(self, context, options="", start=True):
        self.context = context
        self.random = random.Random(context.random.random())
        self.true_crcs = context.recording.crcs()
        self.port = ends.free_port()
        self.receiver = ends.Victim(ends.RECEIVER.format(port=self.port, options=options))
        self.sender = ends.HonestSender(context.recording, self.port, start=start)
        self.before = None

    def settle(self):
        """Until the stream runs, and its memory is known."""
        assert self.wait_for_clouds(10) is not None, "no cloud within 10 s"
        time.sleep(0.3)
        self.before = self.receiver.ask()

    def wait_for_clouds(self, limit, more=3):
        """Seconds until so many more true clouds were shown."""
        start = time.monotonic()
        shown = self.count_true()
        while time.monotonic() - start < limit:
            if self.count_true() >= shown + more:
                return time.monotonic() - start
            time.sleep(0.02)
        return None

    def await_packets(self, count):
        """Until so many came in: the kernel keeps a few hundred for a busy receiver."""
        start = time.monotonic()
        while self.receiver.ask()["net"]["packets-received"] < count:
            assert time.monotonic() - start < 5, f"fewer than {count} packets arrived"
            time.sleep(0.005)

    def count_true(self):
        self.receiver.ask()
        return sum(c in self.true_crcs for c in self.receiver.shown)

    def expect_flow(self, seconds=0.6, part=0.7):
        """The receiver shows what is sent now. A busy machine has several tries."""
        for tries in range(4):
            sent, shown = self.sender.sent, self.count_true()
            time.sleep(seconds)
            sent, shown = self.sender.sent - sent, self.count_true() - shown
            if sent > 0 and shown >= part * sent - 3:
                return
            time.sleep(tries)
        raise AssertionError(f"{shown} of {sent} slices were shown")

    def expect_only_true(self):
        strange = sum(c not in self.true_crcs for c in self.receiver.shown)
        assert strange == 0, f"{strange} slices were shown that nobody sent"

    def expect_bounded(self):
        grown = self.receiver.ask()["rss_kb"] - self.before["rss_kb"]
        most = MOST_GROWTH_KB * (3 if self.context.sanitized else 1)
        assert grown < most, f"memory grew by {grown} kB"
        more = self.receiver.last["threads"] - self.before["threads"]
        assert more <= 2, f"{more} threads were added"

    def finish(self):
        if self.before:
            self.expect_bounded()
        error = self.receiver.ask()["error"]
        assert not error, f"element error: {error}"
        if self.sender:
            self.sender.close()
        self.receiver.close()


def mutate(rng, packet):
    packet = bytearray(packet)
    for _ in range(rng.choice((1, 1, 2, 8))):
        what = rng.randrange(6)
        at = rng.randrange(len(packet)) if packet else 0
        if what == 0 and packet:
            packet[at] ^= 1 << rng.randrange(8)
        elif what == 1 and packet:
            packet[at] = rng.choice((0, 1, 0x7F, 0x80, 0xFF))
        elif what == 2:
            del packet[at:]
        elif what == 3:
            packet[at:at] = rng.randbytes(rng.choice((1, 4, 100)))
        elif what == 4 and len(packet) > 20:
            struct.pack_into(">I", packet, rng.randrange(len(packet) - 4), rng.choice((0, 1, 0xFFFF_FFFF, 1 << 22)))
        elif what == 5 and len(packet) > 60:
            source = rng.randrange(len(packet) - 8)
            packet[at:at + 8] = packet[source:source + 8]
    return bytes(packet)


def another_writer(context):
    """Units of every shape, written from the document, are all shown."""
    bench = Bench(context, start=False)
    sender = bench.sender
    sent = 0
    for scan in range(40):
        parts = []
        for _ in range(context.recording.slices[0].count):
            parts.append(sender.next_slice())
            sender.sent += 1
        payloads = [wire.config_unit(context.recording.config)] if scan % 5 == 0 else []
        marks = [False] * len(payloads)
        if scan % 4 == 3:  # the others are announced as skipped
            parts = parts[:2] + [dataclasses.replace(parts[-1], skipped=(1 << (len(parts) - 3)) - 1)]
        if scan % 4 == 2:
            small = [dataclasses.replace(p, count=len(parts)) for p in parts]
            for i in range(0, len(small), 2):
                payloads.append(wire.aggregate(small[i:i + 2], [0, 1125]))
                marks.append(True)
        else:
            for p in parts:
                some = wire.slice_payloads(p, (1188, 200, 1188, 76)[scan % 4])
                payloads += some
                marks += [False] * (len(some) - 1) + [True]
        sent += len(parts)
        for payload, mark in zip(payloads, marks):
            sender.send(sender.pack(payload, mark))
            if len(sender.packets) % 50 == 0:
                bench.await_packets(len(sender.packets))
    bench.await_packets(len(sender.packets))
    bench.wait_for_clouds(2, sent - bench.count_true())
    depay = bench.receiver.ask()["depay"]
    assert depay["slices-received"] == sent, f"{depay['slices-received']} of {sent} slices came"
    assert depay["slices-lost"] + depay["slices-damaged"] + depay["packets-invalid"] == 0, depay
    assert bench.receiver.last["clouds"] == sent, "every slice is a cloud"
    bench.expect_only_true()
    bench.finish()
    return f"{sent} slices, all shown"


def mutated_packets(context):
    """Damaged copies, from the sender's own address and SSRC."""
    bench = Bench(context)
    bench.settle()
    sent = 0
    until = time.monotonic() + context.seconds
    while time.monotonic() < until:
        for packet in bench.sender.packets[-4:]:
            for _ in range(8):
                bench.sender.socket.sendto(mutate(bench.random, packet), bench.sender.to)
                sent += 1
        time.sleep(0.005)
    assert bench.wait_for_clouds(3) is not None, "no clouds after the attack"
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    return f"{sent} packets"


def repaired_slices(context):
    """Damaged slices and configs whose CRCs are made to fit: only the decoder can refuse them."""
    bench = Bench(context)
    bench.settle()
    rng, sent = bench.random, 0
    until = time.monotonic() + context.seconds
    while time.monotonic() < until:
        s = bench.sender.next_slice()
        body = mutate(rng, s.body) or b"\0"
        forged = dataclasses.replace(s, body=body, scan_number=s.scan_number + 1)
        payload = wire.slice_unit(forged)
        if rng.random() < 0.2:
            payload = wire.config_unit(mutate(rng, context.recording.config) or b"\0")
        if len(payload) < 60_000:
            bench.sender.send(bench.sender.pack(payload))
        sent += 1
        time.sleep(0.002)
    assert bench.wait_for_clouds(5) is not None, "no clouds after the attack"
    bench.expect_flow()
    bench.finish()
    dropped = bench.receiver.last["dec"]["slices-dropped"]
    assert dropped > 0, "nothing was refused"
    return f"{sent} units, {dropped:.0f} refused by the decoder"


def hostile_configs(context):
    """Configs that no decoder can take are refused where they arrive."""
    bench = Bench(context)
    bench.settle()
    model = wire.sensor_model(32, 512)
    xyz = b"x:F32:0,y:F32:4,z:F32:8"
    hostile = [
        wire.build_config(b"x:F64:0,y:F64:8,z:F64:16", model), wire.build_config(b"x:F32:0,y:F32:0,z:F32:0", model),
        wire.build_config(b"range:U32:0", model), wire.build_config(xyz), wire.build_config(xyz, model, version=2),
        wire.build_config(xyz, model, geometry=3), wire.build_config(xyz, model, coder=9),
        wire.build_config(xyz, model, framerate=(1, 0)), wire.build_config(xyz, model[:-1]),
        wire.build_config(xyz, b"\2" + model[1:]), wire.build_config(xyz, struct.pack("<BBHHH", 1, 0, 65535, 65535, 1)),
        wire.build_config(b"x:F32:4294967290,y:F32:4,z:F32:8", model), wire.build_config(b"\0" * 60_000, model), b"",
    ]
    for n, config in enumerate(hostile * 3):
        own_id = (n + 1) & 0xFF
        bench.sender.send(bench.sender.pack(wire.config_unit(config, own_id)))
        s = dataclasses.replace(bench.sender.next_slice(), config_id=own_id)
        bench.sender.send(bench.sender.pack(wire.slice_unit(s)))
        time.sleep(0.01)
    assert bench.wait_for_clouds(3) is not None
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    depay = bench.receiver.last["depay"]
    refused = depay["configs-damaged"] + depay["packets-invalid"]
    assert refused >= 3 * len(hostile) - 3, f"{refused:.0f} of {3 * len(hostile)} configs were refused"
    return f"{3 * len(hostile)} configs, {refused:.0f} refused"


def varint(n):
    out = b""
    while n > 127:
        out, n = out + bytes([n & 127 | 128]), n >> 7
    return out + bytes([n])


def dear_slices(context):
    """A sensor of a million pixels, and slices of dozens of bytes that claim all of them."""
    bench = Bench(context)
    bench.settle()
    beams, columns = 1024, 1024
    fields = b"x:F32:0,y:F32:4,z:F32:8,range:U32:12"
    config = wire.build_config(fields, wire.sensor_model(beams, columns))
    for unit in split_unit(wire.config_unit(config), bench.sender.room):
        bench.sender.send(bench.sender.pack(unit))
    cpu, count = bench.receiver.ask()["cpu"], 40
    for n in range(count):
        payload = bytes([0x13 | (n & 1) << 2]) + b"\xff" * (20 + n)
        block = bytes([0x34, (n & 1) << 7]) + b"".join(map(varint, (beams, 0, columns, 1, 256, len(payload))))
        s = dataclasses.replace(bench.sender.next_slice(), body=block + payload, config_id=wire.config_id(config))
        bench.sender.send(bench.sender.pack(wire.slice_unit(s)))
        time.sleep(0.005)
    time.sleep(0.3)
    used = bench.receiver.ask()["cpu"] - cpu
    bench.expect_flow()
    bench.finish()
    assert used < 0.05 * count * (4 if context.sanitized else 1), f"{1000 * used / count:.0f} ms a slice"
    return f"{count} slices, {1000 * used / count:.1f} ms of CPU time each"


def split_unit(unit, room):
    """A config unit as fragments."""
    if len(unit) <= room:
        return [unit]
    parts = [bytes([wire.FIRST << 5 | wire.CONFIG]) + unit[1:room]]
    at = room
    while at < len(unit):
        kind = wire.MIDDLE if at + room - 2 < len(unit) else wire.LAST
        parts.append(bytes([kind << 5 | wire.CONFIG, unit[1]]) + unit[at:at + room - 2])
        at += room - 2
    return parts


def unfinished_slices(context):
    """First fragments that announce 4 MiB each, and never end."""
    bench = Bench(context)
    bench.settle()
    until, sent = time.monotonic() + context.seconds, 0
    while time.monotonic() < until:
        for index in range(200):
            s = dataclasses.replace(bench.sender.next_slice(), index=index + 10, count=4096)
            head = struct.pack(">BBII", wire.FIRST << 5 | wire.SLICE, s.config_id, 4 << 20, 0)
            bench.sender.send(bench.sender.pack(head + s.place() + s.times() + bytes(1000), marker=False))
            sent += 1
        time.sleep(0.02)
    assert bench.wait_for_clouds(5) is not None
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    return f"{sent} fragments"


def stranger_first(context):
    """A stranger's packet before the sender's first, and one every 0.1 s."""
    bench = Bench(context)
    bench.sender.pause()
    stranger = ends.udp_socket()
    for n in range(3):
        stranger.sendto(wire.rtp(b"\0\0", n * 1000, 0, 99), bench.sender.to)
        time.sleep(0.1)
    bench.sender.pause(False)
    start = time.monotonic()
    took = None
    for n in range(int(10 * context.seconds)):
        stranger.sendto(wire.rtp(b"\0\0", n * 1000, 0, 99), bench.sender.to)
        time.sleep(0.1)
        if took is None and bench.count_true() > 0:
            took = time.monotonic() - start
    assert took is not None and took < 2, f"the sender was let in after {took} s"
    bench.settle()
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    stranger.close()
    return f"the sender was let in after {1000 * took:.0f} ms"


def stream_of_garbage(context):
    """A stranger with a whole stream that decodes to nothing is there first."""
    bench = Bench(context)
    bench.sender.pause()
    stranger = ends.udp_socket()
    for n in range(100):
        stranger.sendto(wire.rtp(bench.random.randbytes(300), n, 0, 99), bench.sender.to)
        time.sleep(0.005)
    bench.sender.pause(False)
    start = time.monotonic()
    took = None
    for n in range(100, 100 + int(200 * context.seconds)):
        stranger.sendto(wire.rtp(bench.random.randbytes(300), n, 0, 99), bench.sender.to)
        time.sleep(0.005)
        if took is None and n % 10 == 0 and bench.count_true() > 0:
            took = time.monotonic() - start
    assert took is not None and took < 2, f"the sender was let in after {took} s"
    bench.settle()
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    stranger.close()
    return f"the sender was let in after {1000 * took:.0f} ms"


def forged_from_elsewhere(context):
    """Media, a goodbye and another stream from another address, with the sender's SSRC."""
    bench = Bench(context)
    bench.settle()
    stranger = ends.udp_socket()
    other = context.other
    until, sent = time.monotonic() + context.seconds, 0
    while time.monotonic() < until:
        stranger.sendto(wire.bye(bench.sender.ssrc), bench.sender.to)
        s = dataclasses.replace(other.slices[sent % len(other.slices)], config_id=wire.config_id(other.config))
        for unit in [wire.config_unit(other.config)] + wire.slice_payloads(s, 1188):
            stranger.sendto(wire.rtp(unit, sent, 0, bench.sender.ssrc, True), bench.sender.to)
            sent += 1
        time.sleep(0.005)
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    stranger.close()
    net = bench.receiver.last["net"]
    assert net["packets-foreign"] >= 0.9 * sent and net["peer-moves"] == 0, net
    return f"{sent} packets, {net['packets-foreign']:.0f} refused as foreign"


def moved_sender(context):
    """The sender moves again and again, with three streams, among packets with random SSRCs."""
    bench = Bench(context)
    bench.sender.companions = [1001, 1002]
    bench.settle()
    stranger = ends.udp_socket()
    worst, moves = 0, max(2, int(context.seconds))
    for _ in range(moves):
        bench.sender.move()
        start, took = time.monotonic(), None
        shown = bench.count_true()
        while time.monotonic() - start < 5 and took is None:
            stranger.sendto(wire.rtp(b"\0\0", 0, 0, bench.random.getrandbits(32)), bench.sender.to)
            time.sleep(0.01)
            if bench.count_true() > shown:
                took = time.monotonic() - start
        assert took is not None and took < 2, f"a moved sender was followed after {took} s"
        worst = max(worst, took)
        time.sleep(0.2)
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    stranger.close()
    return f"{moves} moves, each followed within {1000 * worst:.0f} ms"


def locked_out(context):
    """Hundreds of addresses send in every moment while the sender is away."""
    bench = Bench(context)
    bench.settle()
    bench.sender.pause()
    crowd = [ends.udp_socket() for _ in range(200)]
    until = time.monotonic() + context.seconds
    n = 0
    while time.monotonic() < until:
        for c in crowd:
            c.sendto(wire.rtp(bench.random.randbytes(50), n, 0, n % 7), bench.sender.to)
            n += 1
        time.sleep(0.02)
    bench.sender.move()
    bench.sender.pause(False)
    start, shown, took = time.monotonic(), bench.count_true(), None
    while time.monotonic() - start < 8 and took is None:
        for c in crowd[:50]:
            c.sendto(wire.rtp(bench.random.randbytes(50), n, 0, n % 7), bench.sender.to)
            n += 1
        if bench.count_true() > shown:
            took = time.monotonic() - start
        time.sleep(0.02)
    assert took is not None, "the sender never came back in"
    for c in crowd:
        c.close()
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    return f"{n} packets of {len(crowd)} addresses; the sender was back after {1000 * took:.0f} ms"


def replayed_stream(context):
    """All that was sent is sent again: by the sender's address, and by another one."""
    bench = Bench(context)
    bench.settle()
    stranger = ends.udp_socket()
    time.sleep(context.seconds / 2)
    old = list(bench.sender.packets)
    for n, packet in enumerate(old):
        (stranger if n % 2 else bench.sender.socket).sendto(packet, bench.sender.to)
        if n % 20 == 0:
            time.sleep(0.005)
    clouds = bench.receiver.ask()["clouds"]
    bench.expect_flow()
    bench.expect_only_true()
    sent = bench.sender.sent
    bench.finish()
    stranger.close()
    assert clouds <= sent + 1, f"{clouds} clouds of {sent} slices: a recording was shown again"
    return f"{len(old)} packets again"


def no_amplifier(context):
    """A stranger gets no more bytes back than it sends."""
    bench = Bench(context, start=False)
    stranger = ends.udp_socket()
    stranger.settimeout(0.001)
    sent = received = 0
    for n in range(int(300 * context.seconds)):
        packet = wire.rtp(b"\0\0", n * 900, 0, n % 40, True)
        stranger.sendto(packet, (ends.LOOPBACK, bench.port))
        sent += len(packet) + 28
        try:
            while True:
                received += len(stranger.recv(65536)) + 28
        except TimeoutError:
            pass
        time.sleep(0.001)
    bench.finish()
    stranger.close()
    assert received <= sent, f"{received} bytes for {sent}"
    return f"{sent} bytes sent, {received} came back"


class SenderBench:
    """A real sender, an honest receiver, and a stranger."""

    def __init__(self, pipeline=ends.SENDER, receiver=None, **names):
        self.receiver = receiver or ends.HonestReceiver()
        self.stranger = ends.udp_socket()
        self.sender = ends.Victim(pipeline.format(port=self.receiver.port, seed=5,
                                                  options=f"max-bitrate={MOST_BITRATE}", **names))
        until = time.monotonic() + MOST_PATIENCE
        while self.net()["feedback-accepted"] < 30:
            assert time.monotonic() < until, "no feedback was accepted"
            time.sleep(0.05)
        self.rss = self.sender.last["rss_kb"]
        self.target = self.sender.last["net"]["target-bitrate"]

    def net(self):
        return self.sender.ask()["net"]

    def finish(self, context):
        accepted = self.net()["feedback-accepted"]
        start = time.monotonic()
        while self.net()["feedback-accepted"] <= accepted + 5:
            assert time.monotonic() - start < MOST_PATIENCE, "honest feedback is not accepted any more"
            time.sleep(0.1)
        start, target = time.monotonic(), 0
        while time.monotonic() - start < MOST_PATIENCE and target < 0.9 * self.target:
            time.sleep(0.1)
            target = self.net()["target-bitrate"]
        assert target >= 0.9 * self.target, f"the target stays at {target / 1e6:.2f} Mbit/s"
        grown = self.sender.last["rss_kb"] - self.rss
        assert grown < MOST_GROWTH_KB * (3 if context.sanitized else 1), f"memory grew by {grown} kB"
        assert not self.sender.last["error"], self.sender.last["error"]
        self.sender.close()
        self.receiver.close()
        self.stranger.close()


def forged_feedback(context):
    """Reports from another address: all lost, all marked."""
    bench = SenderBench()
    media = wire.parse_rtp(bench.receiver.packets[-1])
    lost = bench.net()["packets-lost"]
    sent, until = 0, time.monotonic() + context.seconds
    while time.monotonic() < until:
        last = wire.parse_rtp(bench.receiver.packets[-1]).sequence
        for metrics in ([(False, 0, 0)] * 50 + [(True, 3, 0)], [(True, 3, 0)] * 50):
            report = wire.ccfb(9, [(media.ssrc, last - 49, metrics)], time.time())
            bench.stranger.sendto(report, bench.receiver.sender)
            sent += 1
        time.sleep(0.005)
    net = bench.net()
    assert net["feedback-foreign-address"] >= 0.9 * sent, net
    assert net["packets-lost"] == lost and net["packets-ce"] == 0, net
    bench.finish(context)
    return f"{sent} reports, none believed"


def hostile_feedback(context):
    """The receiver itself reports nonsense."""
    bench = SenderBench()
    rng = random.Random(context.random.random())
    ssrc = wire.parse_rtp(bench.receiver.packets[-1]).ssrc
    sent, until = 0, time.monotonic() + context.seconds
    while time.monotonic() < until:
        now, last = time.time(), wire.parse_rtp(bench.receiver.packets[-1]).sequence
        honest = bench.receiver.report(now)
        hostile = [
            mutate(rng, honest), rng.randbytes(rng.randrange(1, 200)),
            wire.ccfb(9, [(ssrc, last + 20_000, [(True, 0, 0)] * 10)], now),  # never sent
            wire.ccfb(9, [(ssrc ^ 1, last, [(True, 3, 0)] * 10)], now),
            wire.ccfb(9, [(ssrc, last - 9, [(True, 1, 0x1FFD)] * 10)], now),  # came before it was sent
            wire.ccfb(9, [(n, 0, [(True, 1, 0)]) for n in range(2000)], now),
            wire.ccfb(9, [(ssrc, 0, [(False, 0, 0)] * 16_000)], now),
            wire.ccfb(9, [], now - 1000), honest[:-4] + honest, wire.bye(ssrc),
            struct.pack(">BBHI", 0x8B, 205, 1, 9),  # no report in it
        ]
        for report in hostile:
            bench.receiver.socket.sendto(report, bench.receiver.sender)
            sent += 1
        time.sleep(0.01)
    net = bench.net()
    assert net["feedback-ignored"] > 0 and net["rtcp-malformed"] > 0 and net["feedback-foreign-blocks"] > 0, net
    bench.finish(context)
    return f"{sent} reports, {net['feedback-ignored']:.0f} ignored, {net['rtcp-malformed']:.0f} malformed"


def hostile_twcc(context):
    """Transport-wide feedback that lies: the session takes it from anyone, and screamaux stays sound."""
    receiver = ends.TwccReceiver()
    bench = SenderBench(ends.TWCC_SENDER, receiver, rtcp_port=receiver.rtcp_to[1])
    rng = random.Random(context.random.random())
    sent, until = 0, time.monotonic() + context.seconds
    while time.monotonic() < until:
        now, last = time.time(), receiver.newest
        ticks = int(now / wire.TWCC_TICK) // 256
        received, lost = 0x2000, 0x0000  # runs of small deltas, and of nothing
        hostile = [
            mutate(rng, receiver.report(now)),
            wire.twcc_packet(last, 9, ticks, sent, [], rng.randbytes(rng.randrange(99))),
            wire.twcc_packet(last + 20_000, 10, ticks, sent, [received | 10], bytes(10)),  # never sent
            wire.twcc_packet(last - 9, 10, ticks, sent, [received | 10], bytes(3)),  # deltas are missing
            wire.twcc_packet(last - 9, 10, ticks - 10**6, sent, [received | 10], bytes(10)),  # came long ago
            wire.twcc_packet(last - 9, 10, 0xFF_FFFF, sent, [0x4000 | 10], b"\x7f\xff" * 10),  # and long from now
            wire.twcc_packet(last - 9, 10, ticks, sent, [0x4000 | 10], b"\x80\x00" * 10),  # each before the one before
            wire.twcc_packet(last - 9, 10, ticks, sent, [0x6000 | 10], bytes(40)),  # a status that there is not
            wire.twcc_packet(last, 0xFFFF, ticks, sent, [received | 0x1FFF] * 8, bytes(0x1FFF)),
            wire.twcc_packet(last - 9, 0, ticks, sent, [received | 10], bytes(10)),
            wire.twcc_packet(last - 9, 10, ticks, sent, [lost | 0] * 300 + [received | 10], bytes(10)),
            wire.twcc_packet(last - 9, 10, ticks, sent, [received | 10], bytes(10), media_ssrc=sent),
        ]
        if rng.random() < 0.02:  # takes the session 30 ms
            hostile.append(wire.twcc_packet(0, 0xFFFF, ticks, sent, [lost | 0x1FFF] * 8, b""))
        for report in hostile:
            bench.stranger.sendto(report, receiver.rtcp_to)
            sent += 1
        time.sleep(0.01)
    net = bench.net()
    assert net["packets-acked"] <= net["packets-sent"] and net["target-bitrate"] <= MOST_BITRATE, net
    bench.finish(context)
    return f"{sent} reports, {net['twcc-mismatched']:.0f} mismatched"


def path_with_key(context):
    """Between two ends with SRTP: reads, changes and repeats packets, and shows a recording later."""
    key = "srtp-key=" + "5a" * 30
    bench = Bench(context, key, start=False)
    relay = ends.Relay(bench.port)
    rng = bench.random
    relay.on_media = lambda packet: [mutate(rng, packet), packet, packet, rng.choice(relay.media)]
    sender = ends.Victim(ends.SENDER.format(port=relay.port, seed=3, options=key))
    start = time.monotonic()
    while bench.receiver.ask()["clouds"] < 10:
        assert time.monotonic() - start < 10, "no clouds"
        time.sleep(0.05)
    bench.before = bench.receiver.last
    time.sleep(context.seconds)
    sent = sender.ask()["pay"]["slices-sent"]
    last = bench.receiver.ask()
    assert last["clouds"] >= 0.7 * sent - 30, f"{last['clouds']} of {sent:.0f} slices were shown"
    sent = sender.ask()["pay"]["slices-sent"]  # asked after the receiver: no cloud is of a later slice
    assert last["clouds"] <= sent, f"{last['clouds']} clouds of {sent:.0f} slices: a copy was shown"
    assert last["depay"]["slices-damaged"] == 0, last["depay"]
    refused = last["net"]["srtp-refused"]
    assert refused >= len(relay.media), f"{refused:.0f} of {3 * len(relay.media)} copies were refused"
    sender.close()
    recording = list(relay.media)
    relay.close()
    bench.finish()
    later = Bench(context, key + " max-age=200000000", start=False)
    time.sleep(0.3)
    attacker = ends.udp_socket()
    for n, packet in enumerate(recording):
        attacker.sendto(packet, (ends.LOOPBACK, later.port))
        if n % 20 == 0:
            time.sleep(0.002)
    time.sleep(0.2)
    last = later.receiver.ask()
    assert last["clouds"] == 0 and last["net"]["packets-old"] > 0, "a recording was shown as live"
    later.finish()
    attacker.close()
    return f"{len(recording)} packets, {refused:.0f} copies refused, the recording too"


def flood_with_key(context):
    """Strangers' streams at a receiver with SRTP, before and while the sender sends."""
    key = "srtp-key=" + "5a" * 30
    bench = Bench(context, key, start=False)
    stranger = ends.udp_socket()
    to = (ends.LOOPBACK, bench.port)

    def flood(packets):
        for _ in range(packets):
            stranger.sendto(wire.rtp(bench.random.randbytes(200), bench.random.getrandbits(16), 0,
                                     bench.random.getrandbits(32)), to)

    flood(200)
    bench.before = bench.receiver.ask()
    sender = ends.Victim(ends.SENDER.format(port=bench.port, seed=3, options=key))
    start, took = time.monotonic(), None
    while time.monotonic() - start < max(3, context.seconds):
        flood(20)
        time.sleep(0.01)
        if took is None and bench.receiver.ask()["clouds"] > 0:
            took = time.monotonic() - start
    assert took is not None, "the sender was never let in"
    clouds = bench.receiver.ask()["clouds"]
    start = time.monotonic()
    while bench.receiver.ask()["clouds"] <= clouds + 20:
        assert time.monotonic() - start < 5, f"the stream does not go on: {bench.receiver.last['net']} {sender.ask()['net']}"
        time.sleep(0.05)
    sender.close()
    bench.finish()
    stranger.close()
    refused = bench.receiver.last["net"]["srtp-refused"]
    return f"{refused:.0f} packets refused; the sender was let in after {1000 * took:.0f} ms"


MEDIA = [another_writer, mutated_packets, repaired_slices, hostile_configs, dear_slices, unfinished_slices,
         stranger_first, stream_of_garbage, forged_from_elsewhere, moved_sender, locked_out, replayed_stream,
         no_amplifier, forged_feedback, hostile_feedback, hostile_twcc, path_with_key, flood_with_key]
