# SPDX-License-Identifier: LGPL-2.1-or-later
"""Attacks on ends that share a key."""
import time

import ends
import wire
from bench import MOST_PATIENCE, Bench, mutate


def path_with_key(context):
    """A relay between two ends with SRTP reads, changes and repeats packets, and later sends a recording."""
    key = "srtp-key=" + "5a" * 30
    bench = Bench(context, key, start=False)
    relay = ends.Relay(bench.port)
    rng = bench.random
    relay.on_media = lambda packet: [mutate(rng, packet), packet, packet, rng.choice(relay.media)]
    sender = ends.Victim(ends.SENDER.format(port=relay.port, seed=3, options=key))
    start = time.monotonic()
    while bench.receiver.ask()["clouds"] < 10:
        assert time.monotonic() - start < MOST_PATIENCE, "no clouds"
        time.sleep(0.05)
    bench.before = bench.receiver.last
    bench.expect_flow(context.seconds, counts=lambda: (sender.ask()["pay"]["slices-sent"], bench.receiver.ask()["clouds"]))
    last = bench.receiver.ask()
    # The sender is asked after the receiver, so each cloud belongs to a slice that is counted here.
    sent = sender.ask()["pay"]["slices-sent"]
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
    start = time.monotonic()
    while later.receiver.ask()["net"]["packets-old"] == 0:
        assert time.monotonic() - start < MOST_PATIENCE, "no packet of a recording was refused as old"
        time.sleep(0.05)
    assert later.receiver.ask()["clouds"] == 0, "a recording was shown as live"
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
    while took is None or time.monotonic() - start < context.seconds:
        assert time.monotonic() - start < MOST_PATIENCE, "the sender was never let in"
        flood(20)
        time.sleep(0.01)
        if took is None and bench.receiver.ask()["clouds"] > 0:
            took = time.monotonic() - start
    clouds = bench.receiver.ask()["clouds"]
    start = time.monotonic()
    while bench.receiver.ask()["clouds"] <= clouds + 20:
        assert time.monotonic() - start < MOST_PATIENCE, f"the stream does not go on: {bench.receiver.last['net']} {sender.ask()['net']}"
        time.sleep(0.05)
    after = time.monotonic() - start
    sender.close()
    bench.finish()
    stranger.close()
    refused = bench.receiver.last["net"]["srtp-refused"]
    return f"{refused:.0f} packets refused; the sender was let in after {1000 * took:.0f} ms, and went on within {after:.1f} s"


ALL = [path_with_key, flood_with_key]
