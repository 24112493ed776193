# SPDX-License-Identifier: LGPL-2.1-or-later
"""Attacks by a sender that writes what a receiver decodes.

Like all attacks they assert what docs/security.md promises, and return a line on what they saw.
"""
import dataclasses
import pathlib
import re
import struct
import time

import wire
from bench import Bench, mutate


def another_writer(context):
    """Units of every shape, written from docs/wire-format.md alone, are all shown."""
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
        # The last slice of these scans announces the other slices as skipped.
        if scan % 4 == 3:
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
    bench.await_report(lambda report: report["clouds"] >= sent, "every slice is a cloud")
    depay = bench.receiver.ask()["depay"]
    assert depay["slices-received"] == sent, f"{depay['slices-received']} of {sent} slices came"
    assert depay["slices-lost"] + depay["slices-damaged"] + depay["packets-invalid"] == 0, depay
    assert bench.receiver.last["clouds"] == sent, "a slice is one cloud"
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
    bench.await_more_slices()
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
    bench.await_more_slices()
    bench.expect_flow()
    bench.finish()
    dropped = bench.receiver.last["dec"]["slices-dropped"]
    assert dropped > 0, "nothing was refused"
    return f"{sent} units, {dropped:.0f} refused by the decoder"


def hostile_configs(context):
    """Configs that no decoder can take are refused by the depayloader."""
    bench = Bench(context)
    bench.settle()
    bench.sender.pause()
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
        arrived = bench.receiver.ask()["net"]["packets-received"]
        bench.sender.send(bench.sender.pack(wire.config_unit(config, own_id)))
        s = dataclasses.replace(bench.sender.next_slice(), config_id=own_id)
        bench.sender.send(bench.sender.pack(wire.slice_unit(s)))
        bench.await_packets(arrived + 2)

    def refused(report):
        return report["depay"]["configs-damaged"] + report["depay"]["packets-invalid"]

    most = 3 * len(hostile)
    bench.await_report(lambda report: refused(report) >= most - 3, f"fewer than {most - 3} configs were refused")
    bench.sender.pause(False)
    bench.await_more_slices()
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    return f"{most} configs, {refused(bench.receiver.last):.0f} refused"


def varint(n):
    out = b""
    while n > 127:
        out, n = out + bytes([n & 127 | 128]), n >> 7
    return out + bytes([n])


def table_version():
    """Returns the version of tables with which payloads of the mixing coder begin."""
    source = pathlib.Path(__file__).parents[3] / "src/codec/mixing/start_states.h"
    return int(re.search(r"kTableVersion = (\d+)", source.read_text(encoding="utf-8"))[1])


# The largest number of pixels that the mixing coder accepts for a payload of 60 bytes.
DEAR_BEAMS, DEAR_COLUMNS = 64, 300
DEAR_CONFIG = wire.build_config(b"x:F32:0,y:F32:4,z:F32:8,range:U32:12", wire.sensor_model(DEAR_BEAMS, DEAR_COLUMNS))


def dear_slice(n):
    """Returns a slice of dozens of bytes that claims as many pixels as it may."""
    # The payload has the current version of the tables, because a payload of an old version would
    # be refused before it costs processor time.
    payload = bytes([table_version() << 4 | 3 | (n & 1) << 2]) + b"\xff" * (60 + n % 4)
    block = bytes([0x34, (n & 1) << 7]) + b"".join(map(varint, (DEAR_BEAMS, 0, DEAR_COLUMNS, 1, 256, len(payload))))
    return wire.Slice(block + payload, wire.config_id(DEAR_CONFIG), n, 0, 1, n)


def dear_slices(context):
    """Slices that cost the mixing coder as much processor time as their bytes allow."""
    bench = Bench(context)
    bench.settle()
    for unit in split_unit(wire.config_unit(DEAR_CONFIG), bench.sender.room):
        bench.sender.send(bench.sender.pack(unit))
    cpu, count = bench.receiver.ask()["cpu"], 40
    for n in range(count):
        dear = dear_slice(n)
        s = dataclasses.replace(bench.sender.next_slice(), body=dear.body, config_id=dear.config_id)
        bench.sender.send(bench.sender.pack(wire.slice_unit(s)))
        time.sleep(0.005)
    time.sleep(0.3)
    used = bench.receiver.ask()["cpu"] - cpu
    bench.expect_flow()
    bench.finish()
    assert used < 0.05 * count * (4 if context.sanitized else 1), f"{1000 * used / count:.0f} ms a slice"
    return f"{count} slices, {1000 * used / count:.1f} ms of CPU time each"


def split_unit(unit, room):
    """Splits a config unit into fragments."""
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
    bench.await_more_slices()
    bench.expect_flow()
    bench.expect_only_true()
    bench.finish()
    return f"{sent} fragments"


ALL = [another_writer, mutated_packets, repaired_slices, hostile_configs, dear_slices, unfinished_slices]
