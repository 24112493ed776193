# SPDX-License-Identifier: LGPL-2.1-or-later
"""What attacks on a receiver need: an honest sender, a receiver, and checks of what must hold after an attack."""
import random
import struct
import time

import ends

MOST_BITRATE = 20_000_000  # the largest bitrate of a sender [bit/s]
MOST_PATIENCE = 180  # the longest wait on a busy machine [s]
# The largest growth of the victim's memory [kB]. It is the sum of the limits of all queues in
# docs/security.md.
MOST_GROWTH_KB = 96 * 1024


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
        """Waits until the stream runs, and notes its memory."""
        self.await_more_slices()
        time.sleep(0.3)
        self.before = self.receiver.ask()

    def await_report(self, holds, promise):
        start = time.monotonic()
        while not holds(self.receiver.ask()):
            assert time.monotonic() - start < MOST_PATIENCE, promise
            time.sleep(0.02)

    def await_more_slices(self, more=3):
        """Waits until `more` slices of the sender were shown."""
        count = self.count_true() + more
        self.await_report(lambda _: self.count_true() >= count, f"fewer than {count} slices were shown")

    def await_packets(self, count):
        """Waits until `count` packets arrived: the kernel keeps only a few hundred for a busy receiver."""
        self.await_report(
            lambda report: report["net"]["packets-received"] >= count, f"fewer than {count} packets arrived"
        )

    def count_true(self):
        self.receiver.ask()
        return sum(c in self.true_crcs for c in self.receiver.shown)

    def expect_flow(self, seconds=0.6, part=0.7, counts=None):
        """Expects that the receiver shows new slices. Tries several times, because the machine may be busy. `counts`
        returns how many slices were sent and shown, if the bench's sender does not send them."""
        counts = counts or (lambda: (self.sender.sent, self.count_true()))
        for tries in range(8):
            before = counts()
            time.sleep(seconds)
            sent, shown = (now - then for now, then in zip(counts(), before))
            if sent > 0 and shown >= part * sent - 3:
                return
            time.sleep(tries)
        raise AssertionError(f"{shown:.0f} of {sent:.0f} slices were shown")

    def expect_only_true(self):
        strange = sum(c not in self.true_crcs for c in self.receiver.shown)
        assert strange == 0, f"{strange} slices were shown that nobody sent"

    def expect_bounded(self):
        grown = self.receiver.ask()["rss_kb"] - self.before["rss_kb"]
        most = MOST_GROWTH_KB * self.context.memory_factor
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
