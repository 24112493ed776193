# SPDX-License-Identifier: LGPL-2.1-or-later
"""RTP units, RFC 8888 and transport-wide feedback, written from docs/wire-format.md, the RFCs and drafts alone."""
import dataclasses
import struct
import zlib

CONFIG, SLICE, SLICE_AFTER_SKIPPED = 0, 2, 3
WHOLE, AGGREGATE, FIRST, MIDDLE, LAST = range(5)
NTP_EPOCH = 2_208_988_800  # the seconds from 1900 to 1970
PAYLOAD_TYPE = 96


@dataclasses.dataclass(frozen=True)
class Slice:
    body: bytes
    config_id: int = 0
    scan_number: int = 0
    index: int = 0
    count: int = 1
    scan_id: int = 0
    first_column: int = 0
    duration: int = 0xFFFF_FFFF
    capture: int = 0  # as an NTP timestamp
    skipped: int = 0  # a mask of slices

    @property
    def unit(self):
        return SLICE_AFTER_SKIPPED if self.skipped else SLICE

    def place(self):
        return struct.pack(">IHH", self.scan_number & 0xFFFF_FFFF, self.index, self.count)

    def times(self):
        times = struct.pack(">IHIQ", self.scan_id & 0xFFFF_FFFF, self.first_column, self.duration, self.capture)
        return times + struct.pack(">Q", self.skipped) if self.skipped else times


def ntp(unix_seconds):
    return int((unix_seconds + NTP_EPOCH) * 2**32) & 0xFFFF_FFFF_FFFF_FFFF


def slice_crc(s):
    return zlib.crc32(bytes([s.unit, s.config_id]) + s.place() + s.times() + s.body)


def slice_unit(s, crc=None, kind=WHOLE, body=None):
    crc = slice_crc(s) if crc is None else crc
    head = bytes([kind << 5 | s.unit, s.config_id]) + struct.pack(">II", len(s.body), crc)
    return head + s.place() + s.times() + (s.body if body is None else body)


def slice_payloads(s, room):
    """The payloads of the packets of one slice, none longer than `room`."""
    whole = slice_unit(s)
    if len(whole) <= room:
        return [whole]
    head = len(whole) - len(s.body)
    at = room - head
    payloads = [slice_unit(s, kind=FIRST, body=s.body[:at])]
    while at < len(s.body):
        end = at + room - 10
        kind = MIDDLE if end < len(s.body) else LAST
        payloads.append(bytes([kind << 5 | s.unit, s.config_id]) + s.place() + s.body[at:end])
        at = end
    return payloads


def aggregate(slices, offsets):
    payload = b"\x20"
    for s, offset in zip(slices, offsets):
        unit = slice_unit(s)
        payload += struct.pack(">HH", offset, len(unit)) + unit
    return payload


def config_id(config, previous=None):
    own = zlib.crc32(config) & 0xFF
    return (own + 1) & 0xFF if own == previous else own


def config_unit(config, own_id=None, crc=None):
    own_id = config_id(config) if own_id is None else own_id
    crc = zlib.crc32(bytes([CONFIG, own_id]) + config) if crc is None else crc
    return bytes([WHOLE << 5 | CONFIG, own_id]) + struct.pack(">II", len(config), crc) + config


def build_config(fields, sensor_model=b"", geometry=1, coder=1, framerate=(10, 1), version=1):
    return (bytes([version, coder << 4 | geometry])
            + struct.pack(">IIHH", *framerate, len(fields), len(sensor_model)) + fields + sensor_model)


def sensor_model(beams, columns, unit_mm=1):
    """A made-up sensor whose beams spread over 40 degrees."""
    identity = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)
    model = struct.pack("<BBHHHff12f", 1, 0, beams, columns, unit_mm, 0.0, 0.0, *identity)
    return model + b"".join(struct.pack("<ffh", 0.0, 20.0 - 40.0 * b / beams, 0) for b in range(beams))


def rtp(payload, sequence, timestamp, ssrc, marker=False, payload_type=PAYLOAD_TYPE):
    return struct.pack(">BBHII", 0x80, marker << 7 | payload_type, sequence & 0xFFFF, timestamp & 0xFFFF_FFFF,
                       ssrc) + payload


@dataclasses.dataclass
class Rtp:
    sequence: int
    timestamp: int
    ssrc: int
    marker: bool
    payload_type: int
    payload: bytes


def is_rtcp(packet):
    return len(packet) >= 2 and 192 <= packet[1] <= 223


def parse_rtp(packet):
    """The fields of a packet without CSRC, extension or padding."""
    first, second, sequence, timestamp, ssrc = struct.unpack_from(">BBHII", packet)
    assert first == 0x80, f"RTP that begins with {first:#x}"
    return Rtp(sequence, timestamp, ssrc, bool(second >> 7), second & 0x7F, packet[12:])


class Reader:
    """Puts the units of one stream together again, and refuses all that the format does not allow."""

    def __init__(self):
        self.configs = {}  # the bytes of each configuration, by its id
        self.slices = []
        # For a slice in fragments: the slice so far, and its CRC and length, which the first
        # fragment contains.
        self.partial = None
        self.config_parts = None
        self.expected = None

    def push(self, packet):
        r = parse_rtp(packet)
        kind, unit = r.payload[0] >> 5, r.payload[0] & 31
        assert self.expected in (None, r.sequence), "a packet is missing"
        self.expected = (r.sequence + 1) & 0xFFFF
        if kind == AGGREGATE:
            self._aggregate(r.payload)
        elif unit == CONFIG:
            self._config(kind, r.payload)
        else:
            done = self._slice(kind, unit, r.payload)
            assert r.marker == done, "the marker stands at the last packet of a slice"

    def _aggregate(self, payload):
        at = 1
        while at < len(payload):
            _, size = struct.unpack_from(">HH", payload, at)
            unit = payload[at + 4:at + 4 + size]
            assert len(unit) == size and unit[0] >> 5 == WHOLE
            self._slice(WHOLE, unit[0] & 31, unit)
            at += 4 + size

    def _config(self, kind, payload):
        own_id = payload[1]
        if kind in (WHOLE, FIRST):
            length, crc = struct.unpack_from(">II", payload, 2)
            self.config_parts = [length, crc, payload[10:]]
        else:
            self.config_parts[2] += payload[2:]
        if kind in (WHOLE, LAST):
            length, crc, config = self.config_parts
            assert length == len(config) and crc == zlib.crc32(bytes([CONFIG, own_id]) + config)
            assert own_id in (config_id(config), (config_id(config) + 1) & 0xFF)
            self.configs[own_id] = config

    def _slice(self, kind, unit, payload):
        own_id = payload[1]
        if kind in (WHOLE, FIRST):
            length, crc, number, index, count, scan_id, column, duration, capture = struct.unpack_from(
                ">IIIHHIHIQ", payload, 2)
            skipped = struct.unpack_from(">Q", payload, 36)[0] if unit == SLICE_AFTER_SKIPPED else 0
            head = 44 if unit == SLICE_AFTER_SKIPPED else 36
            s = Slice(payload[head:], own_id, number, index, count, scan_id, column, duration, capture, skipped)
            self.partial = [s, crc, length]
        else:
            number, index, count = struct.unpack_from(">IHH", payload, 2)
            s = self.partial[0]
            assert (number, index, count, own_id) == (s.scan_number, s.index, s.count, s.config_id)
            self.partial[0] = dataclasses.replace(s, body=s.body + payload[10:])
        if kind not in (WHOLE, LAST):
            return False
        s, crc, length = self.partial
        assert len(s.body) == length and slice_crc(s) == crc, "a slice whose CRC does not fit"
        self.slices.append(s)
        return True


def ccfb(sender_ssrc, blocks, report_time):
    """RFC 8888: blocks of (SSRC, begin_seq, [(received, ecn, offset in 1/1024 s)]); the time in seconds."""
    body = struct.pack(">I", sender_ssrc)
    for ssrc, begin, metrics in blocks:
        body += struct.pack(">IHH", ssrc, begin & 0xFFFF, len(metrics))
        for received, ecn, offset in metrics:
            body += struct.pack(">H", 0x8000 | ecn << 13 | min(offset, 0x1FFF) if received else 0)
        body += bytes(2 * (len(metrics) % 2))
    body += struct.pack(">I", int((report_time + NTP_EPOCH) * 65536) & 0xFFFF_FFFF)
    return struct.pack(">BBH", 0x80 | 11, 205, len(body) // 4) + body


def transport_number(packet, extension_id):
    """The transport-wide number in an extension of one byte (RFC 8285); None if there is none."""
    profile, words = struct.unpack_from(">HH", packet, 12) if packet[0] & 0x10 else (0, 0)
    at, end = 16, 16 + 4 * words
    while profile == 0xBEDE and at < end:
        own_id, size = packet[at] >> 4, (packet[at] & 15) + 1
        if own_id == extension_id:
            return struct.unpack_from(">H", packet, at + 1)[0]
        at += 1 + size if packet[at] else 1
    return None


TWCC_TICK = 1 / 4000  # [s]; a reference time has a unit of 256 ticks


def twcc_packet(base, count, reference, number, chunks, deltas, media_ssrc=0):
    """draft-holmer-rmcat-transport-wide-cc-extensions-01 behind an empty receiver report; any field may be wrong."""
    fci = struct.pack(">HHI", base & 0xFFFF, count & 0xFFFF, (reference & 0xFF_FFFF) << 8 | number & 0xFF)
    fci += b"".join(struct.pack(">H", c) for c in chunks) + deltas
    padding = -len(fci) % 4
    fci += bytes(padding - 1) + bytes([padding]) if padding else b""
    head = struct.pack(">BBHII", 0x80 | bool(padding) << 5 | 15, 205, 2 + len(fci) // 4, 7, media_ssrc)
    return struct.pack(">BBHI", 0x80, 201, 1, 7) + head + fci


def twcc(base, arrivals, number):
    """Reports what a receiver saw from number `base` on: `arrivals` in seconds, or None."""
    first = next(a for a in arrivals if a is not None)
    reference = int(first / TWCC_TICK) // 256
    before, deltas, symbols = 256 * reference, b"", []
    for arrival in arrivals:
        if arrival is None:
            symbols.append(0)
            continue
        delta, before = int(arrival / TWCC_TICK) - before, int(arrival / TWCC_TICK)
        symbols.append(1 if 0 <= delta < 256 else 2)
        deltas += struct.pack(">B" if symbols[-1] == 1 else ">h", max(-32768, min(delta, 32767)))
    chunks = []
    for i in range(0, len(symbols), 7):
        part = symbols[i:i + 7]
        chunks.append(0xC000 | sum(symbol << 12 - 2 * n for n, symbol in enumerate(part)))
    return twcc_packet(base, len(symbols), reference, number, chunks, deltas)


def bye(ssrc):
    return struct.pack(">BBHI", 0x81, 203, 1, ssrc)
