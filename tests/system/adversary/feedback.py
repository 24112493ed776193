# SPDX-License-Identifier: LGPL-2.1-or-later
"""Attacks on a sender by the feedback that it gets."""
import random
import struct
import time

import ends
import wire
from bench import MOST_BITRATE, MOST_GROWTH_KB, MOST_PATIENCE, mutate


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

    def net_when(self, holds):
        """Returns the statistics once `holds` accepts them: a slow sender has yet to read what came."""
        start = time.monotonic()
        while not holds(net := self.net()):
            assert time.monotonic() - start < MOST_PATIENCE, net
            time.sleep(0.1)
        return net

    def finish(self, context):
        accepted = self.net()["feedback-accepted"]
        start = time.monotonic()
        while self.net()["feedback-accepted"] <= accepted + 5:
            assert time.monotonic() - start < MOST_PATIENCE, "honest feedback is not accepted any more"
            time.sleep(0.1)
        # Waits until the target has recovered. The target of a source that sends little remains
        # low, so it is also compared with the sent bitrate: on a busy machine the source sends less
        # than before.
        start = time.monotonic()
        while (net := self.net())["target-bitrate"] < min(0.9 * self.target, 2 * net["sent-bitrate"]):
            assert time.monotonic() - start < MOST_PATIENCE, \
                f"the target stays at {net['target-bitrate'] / 1e6:.2f} of {self.target / 1e6:.2f} Mbit/s"
            time.sleep(0.1)
        grown = self.sender.last["rss_kb"] - self.rss
        assert grown < MOST_GROWTH_KB * context.memory_factor, f"memory grew by {grown} kB"
        assert not self.sender.last["error"], self.sender.last["error"]
        self.sender.close()
        self.receiver.close()
        self.stranger.close()


def forged_feedback(context):
    """Reports from another address: all lost, all marked."""
    bench = SenderBench()
    media = wire.parse_rtp(bench.receiver.packets[-1])
    lost = bench.net()["packets-lost"]
    sent, until, foreign = 0, time.monotonic() + context.seconds, 0
    # The kernel drops reports when the sender is busy. So the attack continues until the sender has
    # received enough of them.
    while time.monotonic() < until or foreign < 100:
        assert time.monotonic() < until + MOST_PATIENCE, f"{foreign:.0f} of {sent} reports were refused as foreign"
        last = wire.parse_rtp(bench.receiver.packets[-1]).sequence
        for metrics in ([(False, 0, 0)] * 50 + [(True, 3, 0)], [(True, 3, 0)] * 50):
            report = wire.ccfb(9, [(media.ssrc, last - 49, metrics)], time.time())
            bench.stranger.sendto(report, bench.receiver.sender)
            sent += 1
        time.sleep(0.005)
        foreign = bench.net()["feedback-foreign-address"]
    net = bench.net()
    assert net["packets-lost"] == lost and net["packets-ce"] == 0, net
    bench.finish(context)
    return f"{sent} reports, none believed"


def feedback_at_line_rate(context):
    """Reports from another address, as many as a socket takes."""
    bench = SenderBench()
    media = wire.parse_rtp(bench.receiver.packets[-1])
    report = wire.ccfb(9, [(media.ssrc, media.sequence, [(False, 0, 0)] * 50)], time.time())
    before, cpu = bench.net(), bench.sender.last["cpu"]
    sent, until = 0, time.monotonic() + context.seconds
    while time.monotonic() < until:
        for _ in range(100):
            bench.stranger.sendto(report, bench.receiver.sender)
        sent += 100
    net = bench.net()
    foreign = net["feedback-foreign-address"] - before["feedback-foreign-address"]
    used = (bench.sender.last["cpu"] - cpu) / max(foreign, 1)
    assert foreign > 0 and net["packets-lost"] == before["packets-lost"], net
    bench.finish(context)
    return f"{sent / context.seconds:.0f} reports a second, {foreign / sent:.0%} read, {1e6 * used:.1f} us each, none believed"


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
            wire.ccfb(9, [(ssrc, last + 20_000, [(True, 0, 0)] * 10)], now),  # packets never sent
            wire.ccfb(9, [(ssrc ^ 1, last, [(True, 3, 0)] * 10)], now),
            wire.ccfb(9, [(ssrc, last - 9, [(True, 1, 0x1FFD)] * 10)], now),  # arrived before they were sent
            wire.ccfb(9, [(n, 0, [(True, 1, 0)]) for n in range(2000)], now),
            wire.ccfb(9, [(ssrc, 0, [(False, 0, 0)] * 16_000)], now),
            wire.ccfb(9, [], now - 1000), honest[:-4] + honest, wire.bye(ssrc),
            struct.pack(">BBHI", 0x8B, 205, 1, 9),  # an empty report
        ]
        for report in hostile:
            bench.receiver.socket.sendto(report, bench.receiver.sender)
            sent += 1
        time.sleep(0.01)
    net = bench.net_when(lambda net: net["feedback-ignored"] > 0 and net["rtcp-malformed"] > 0
                         and net["feedback-foreign-blocks"] > 0)
    bench.finish(context)
    return f"{sent} reports, {net['feedback-ignored']:.0f} ignored, {net['rtcp-malformed']:.0f} malformed"


def hostile_twcc(context):
    """Forged transport-wide feedback: the session takes it from any address, and screamaux stays sound."""
    receiver = ends.TwccReceiver()
    bench = SenderBench(ends.TWCC_SENDER, receiver, rtcp_port=receiver.rtcp_to[1])
    rng = random.Random(context.random.random())
    # The RTP session extends its list by eight packets at a time. Under AddressSanitizer it would
    # need a minute for a list of 65,535 packets, so the reports cover fewer packets then.
    most = 0x1FFF if context.sanitized else 0xFFFF
    sent, until = 0, time.monotonic() + context.seconds
    while time.monotonic() < until:
        now, last = time.time(), receiver.newest
        ticks = int(now / wire.TWCC_TICK) // 256
        received, lost = 0x2000, 0x0000  # run-length chunks: of small deltas, and of lost packets
        hostile = [
            mutate(rng, receiver.report(now)),
            wire.twcc_packet(last, 9, ticks, sent, [], rng.randbytes(rng.randrange(99))),
            wire.twcc_packet(last + 20_000, 10, ticks, sent, [received | 10], bytes(10)),  # packets never sent
            wire.twcc_packet(last - 9, 10, ticks, sent, [received | 10], bytes(3)),  # deltas are missing
            # This report says that packets arrived long ago. The next one says that they will
            # arrive in the distant future.
            wire.twcc_packet(last - 9, 10, ticks - 10**6, sent, [received | 10], bytes(10)),
            wire.twcc_packet(last - 9, 10, 0xFF_FFFF, sent, [0x4000 | 10], b"\x7f\xff" * 10),
            wire.twcc_packet(last - 9, 10, ticks, sent, [0x4000 | 10], b"\x80\x00" * 10),  # each earlier than the last
            wire.twcc_packet(last - 9, 10, ticks, sent, [0x6000 | 10], bytes(40)),  # an invalid status symbol
            wire.twcc_packet(last, 0xFFFF, ticks, sent, [received | 0x1FFF] * 8, bytes(0x1FFF)),
            wire.twcc_packet(last - 9, 0, ticks, sent, [received | 10], bytes(10)),
            wire.twcc_packet(last - 9, 10, ticks, sent, [lost | 0] * 300 + [received | 10], bytes(10)),
            wire.twcc_packet(last - 9, 10, ticks, sent, [received | 10], bytes(10), media_ssrc=sent),
        ]
        # This report is sent rarely, because the session needs 30 ms for it.
        if rng.random() < 0.02:
            hostile.append(wire.twcc_packet(0, most, ticks, sent, [lost | 0x1FFF] * 8, b""))
        for report in hostile:
            bench.stranger.sendto(report, receiver.rtcp_to)
            sent += 1
        time.sleep(0.01)
    net = bench.net()
    assert net["packets-acked"] <= net["packets-sent"] and net["target-bitrate"] <= MOST_BITRATE, net
    bench.finish(context)
    return f"{sent} reports, {net['twcc-mismatched']:.0f} mismatched"


ALL = [forged_feedback, feedback_at_line_rate, hostile_feedback, hostile_twcc]
