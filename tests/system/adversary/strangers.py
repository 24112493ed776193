# SPDX-License-Identifier: LGPL-2.1-or-later
"""Attacks on a receiver from addresses that are not the sender's."""
import dataclasses
import time

import ends
import wire
from bench import MOST_PATIENCE, Bench


def come_first(context, junk, before, after, pause, ask_every=1):
    """A stranger's packets `junk(bench, n)`: those of `before` come before the sender's first, and those of `after`
    during its stream. Asks after every `ask_every` of them whether the sender was let in."""
    bench = Bench(context)
    bench.sender.pause()
    stranger = ends.udp_socket()
    for n in before:
        stranger.sendto(junk(bench, n), bench.sender.to)
        time.sleep(pause)
    bench.sender.pause(False)
    start = time.monotonic()
    took = None
    for n in after:
        stranger.sendto(junk(bench, n), bench.sender.to)
        time.sleep(pause)
        if took is None and n % ask_every == 0 and bench.count_true() > 0:
            took = time.monotonic() - start
    assert took is not None and took < 2, f"the sender was let in after {took} s"
    bench.settle()
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    stranger.close()
    return f"the sender was let in after {1000 * took:.0f} ms"


def stranger_first(context):
    """A stranger's packet before the sender's first, and one every 0.1 s."""
    return come_first(context, lambda _, n: wire.rtp(b"\0\0", n * 1000, 0, 99), range(3),
                      range(int(10 * max(1, context.seconds))), 0.1)


def stream_of_garbage(context):
    """A stranger's whole stream of garbage comes first."""
    return come_first(context, lambda bench, n: wire.rtp(bench.random.randbytes(300), n, 0, 99), range(100),
                      range(100, 100 + int(200 * max(1, context.seconds))), 0.005, ask_every=10)


def forged_from_elsewhere(context):
    """Media, a goodbye and another stream from another address, with the sender's SSRC."""
    bench = Bench(context)
    bench.settle()
    stranger = ends.udp_socket()
    other = context.other
    until, sent, foreign = time.monotonic() + context.seconds, 0, 0
    # The kernel drops packets when the receiver is busy. So the attack continues until the receiver
    # has got enough of them.
    while time.monotonic() < until or foreign < 100:
        assert time.monotonic() < until + MOST_PATIENCE, f"{foreign:.0f} of {sent} packets were refused as foreign"
        stranger.sendto(wire.bye(bench.sender.ssrc), bench.sender.to)
        s = dataclasses.replace(other.slices[sent % len(other.slices)], config_id=wire.config_id(other.config))
        for unit in [wire.config_unit(other.config)] + wire.slice_payloads(s, 1188):
            stranger.sendto(wire.rtp(unit, sent, 0, bench.sender.ssrc, True), bench.sender.to)
            sent += 1
        time.sleep(0.005)
        foreign = bench.receiver.ask()["net"]["packets-foreign"]
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    stranger.close()
    net = bench.receiver.last["net"]
    assert net["peer-moves"] == 0, net
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


ALL = [stranger_first, stream_of_garbage, forged_from_elsewhere, moved_sender, locked_out, replayed_stream,
       no_amplifier]
