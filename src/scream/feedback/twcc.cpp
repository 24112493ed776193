// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/feedback/twcc.h"

#include <algorithm>

#include "src/base/byte_writer.h"

namespace lidar::scream {
namespace {

constexpr std::uint8_t kVersion2 = 0x80;
constexpr std::uint8_t kVersionMask = 0xC0;
constexpr std::uint8_t kPaddingBit = 0x20;
constexpr std::uint8_t kFormatMask = 0x1F;
constexpr std::uint8_t kFormatTwcc = 15;
constexpr std::uint8_t kTypeRtpfb = 205;
constexpr std::size_t kHeaders = 20;  // RTCP's, both SSRCs, and what stands before the chunks
constexpr Duration kReferenceUnit = std::chrono::milliseconds(64);
constexpr unsigned kReferenceMask = 0xFFFFFF;

constexpr std::uint16_t kVectorChunk = 0x8000;
constexpr std::uint16_t kTwoBitSymbols = 0x4000;
constexpr unsigned kRunMask = 0x1FFF;
constexpr unsigned kOneBitSymbolsInChunk = 14;
constexpr unsigned kTwoBitSymbolsInChunk = 7;

enum Symbol : std::uint8_t { kNotReceived, kSmallDelta, kLargeDelta, kReserved };

/// Appends the symbols of one chunk, up to `count` in all.
void ReadChunk(unsigned chunk, std::size_t count, std::vector<std::uint8_t>* symbols) {
  const auto add = [&](unsigned symbol) {
    if (symbols->size() < count) symbols->push_back(static_cast<std::uint8_t>(symbol));
  };
  if ((chunk & kVectorChunk) == 0) {
    const std::size_t run = std::min<std::size_t>(chunk & kRunMask, count - symbols->size());
    symbols->insert(symbols->end(), run, static_cast<std::uint8_t>(chunk >> 13 & 3));
  } else if ((chunk & kTwoBitSymbols) == 0) {
    for (unsigned i = kOneBitSymbolsInChunk; i > 0; --i) add(chunk >> (i - 1) & 1U);
  } else {
    for (unsigned i = kTwoBitSymbolsInChunk; i > 0; --i) add(chunk >> (2 * (i - 1)) & 3U);
  }
}

/// The symbols of `count` packets; nothing where the chunks end before or say nothing.
std::optional<std::vector<std::uint8_t>> ReadChunks(ByteReader* reader, std::size_t count) {
  std::vector<std::uint8_t> symbols;
  while (symbols.size() < count) {
    const std::size_t before = symbols.size();
    const std::uint16_t chunk = reader->Be16();
    if (!reader->ok()) return std::nullopt;
    ReadChunk(chunk, count, &symbols);
    if (symbols.size() == before) return std::nullopt;  // an empty run
  }
  return symbols;
}

/// Without RTCP padding; empty where the padding is malformed.
ByteView WithoutPadding(ByteView packet) {
  if ((packet.data[0] & kPaddingBit) == 0) return packet;
  const std::size_t padding = packet.data[packet.size - 1];
  if (padding == 0 || padding + kHeaders > packet.size) return {};
  return packet.Sub(0, packet.size - padding);
}

/// A delta in ticks, of the size that the symbol says.
std::int64_t ReadDelta(ByteReader* reader, std::uint8_t symbol) {
  return symbol == kSmallDelta ? reader->U8() : static_cast<std::int16_t>(reader->Be16());
}

std::int64_t Ticks(Duration d) {
  const std::int64_t half = d < Duration{0} ? -1 : 1;
  return (d + half * kTwccTick / 2) / kTwccTick;
}

struct Deltas {
  std::vector<std::uint8_t> symbols;
  std::vector<std::int16_t> ticks;  // of what was received
};

/// Nothing where a delta does not fit.
std::optional<Deltas> MakeDeltas(const TwccFeedback& feedback, std::int64_t reference) {
  Deltas deltas;
  std::int64_t last = reference * (kReferenceUnit / kTwccTick);
  for (const auto& arrival : feedback.arrivals) {
    if (!arrival) {
      deltas.symbols.push_back(kNotReceived);
      continue;
    }
    const std::int64_t delta = Ticks(*arrival) - last;
    if (delta < INT16_MIN || delta > INT16_MAX) return std::nullopt;
    deltas.symbols.push_back(delta >= 0 && delta <= 255 ? kSmallDelta : kLargeDelta);
    deltas.ticks.push_back(static_cast<std::int16_t>(delta));
    last += delta;
  }
  return deltas;
}

/// Runs where they say more than a vector of two-bit symbols would.
void WriteChunks(const std::vector<std::uint8_t>& symbols, ByteWriter* writer) {
  for (std::size_t i = 0; i < symbols.size();) {
    std::size_t run = 1;
    while (i + run < symbols.size() && symbols[i + run] == symbols[i] && run < kRunMask) ++run;
    if (run >= kTwoBitSymbolsInChunk || i + run == symbols.size()) {
      writer->Be16(static_cast<std::uint16_t>(unsigned{symbols[i]} << 13 | run));
      i += run;
      continue;
    }
    unsigned chunk = kVectorChunk | kTwoBitSymbols;
    for (unsigned k = kTwoBitSymbolsInChunk; k > 0; --k, ++i)
      if (i < symbols.size()) chunk |= unsigned{symbols[i]} << (2 * (k - 1));
    writer->Be16(static_cast<std::uint16_t>(chunk));
  }
}

/// Before the first arrival, so that its delta is small.
std::int64_t ReferenceOf(const TwccFeedback& feedback) {
  for (const auto& arrival : feedback.arrivals) {
    if (!arrival) continue;
    const std::int64_t ticks = Ticks(*arrival);
    const std::int64_t unit = kReferenceUnit / kTwccTick;
    return ticks >= 0 ? ticks / unit : -((-ticks + unit - 1) / unit);
  }
  return 0;
}

}  // namespace

bool IsTwcc(ByteView packet) {
  return packet.size >= 4 && (packet.data[0] & kVersionMask) == kVersion2 &&
         (packet.data[0] & kFormatMask) == kFormatTwcc && packet.data[1] == kTypeRtpfb;
}

std::optional<TwccFeedback> ParseTwcc(ByteView packet) {
  if (!IsTwcc(packet)) return std::nullopt;
  const std::size_t words = ByteReader(packet.Sub(2)).Be16();
  if (4 * (words + 1) != packet.size) return std::nullopt;
  ByteReader reader(WithoutPadding(packet));
  reader.Skip(4);
  TwccFeedback feedback;
  feedback.sender_ssrc = reader.Be32();
  feedback.media_ssrc = reader.Be32();
  feedback.base_number = reader.Be16();
  const std::size_t count = reader.Be16();
  Duration arrival = kReferenceUnit * static_cast<std::int64_t>(reader.Be24());
  feedback.report_number = reader.U8();
  if (!reader.ok() || count == 0 || count > kMaxTwccPackets) return std::nullopt;
  const auto symbols = ReadChunks(&reader, count);
  if (!symbols) return std::nullopt;
  for (const std::uint8_t symbol : *symbols) {
    if (symbol == kReserved) return std::nullopt;
    if (symbol == kNotReceived) {
      feedback.arrivals.emplace_back();
      continue;
    }
    arrival += ReadDelta(&reader, symbol) * kTwccTick;
    feedback.arrivals.emplace_back(arrival);
  }
  // What is left fills the last word, where the padding bit did not do so.
  if (!reader.ok() || reader.remaining() > 3) return std::nullopt;
  return feedback;
}

std::optional<std::vector<std::uint8_t>> BuildTwcc(const TwccFeedback& feedback) {
  const std::size_t count = feedback.arrivals.size();
  if (count == 0 || count > kMaxTwccPackets) return std::nullopt;
  const std::int64_t reference = ReferenceOf(feedback);
  const auto deltas = MakeDeltas(feedback, reference);
  if (!deltas) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  ByteWriter writer(&bytes);
  writer.U8(kVersion2 | kFormatTwcc);
  writer.U8(kTypeRtpfb);
  writer.Be16(0);  // the length, once it is known
  writer.Be32(feedback.sender_ssrc);
  writer.Be32(feedback.media_ssrc);
  writer.Be16(feedback.base_number);
  writer.Be16(static_cast<std::uint16_t>(count));
  writer.Be24(static_cast<std::uint32_t>(reference) & kReferenceMask);
  writer.U8(feedback.report_number);
  WriteChunks(deltas->symbols, &writer);
  std::size_t next = 0;
  for (const std::uint8_t symbol : deltas->symbols) {
    if (symbol == kSmallDelta) writer.U8(static_cast<std::uint8_t>(deltas->ticks[next++]));
    if (symbol == kLargeDelta) writer.Be16(static_cast<std::uint16_t>(deltas->ticks[next++]));
  }
  if (bytes.size() % 4 != 0) {
    const std::size_t padding = 4 - bytes.size() % 4;
    bytes[0] |= kPaddingBit;
    writer.Zeros(padding - 1);
    writer.U8(static_cast<std::uint8_t>(padding));
  }
  const std::size_t words = bytes.size() / 4 - 1;
  bytes[2] = static_cast<std::uint8_t>(words >> 8);
  bytes[3] = static_cast<std::uint8_t>(words);
  return bytes;
}

}  // namespace lidar::scream
