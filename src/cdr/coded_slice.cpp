// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/coded_slice.h"

#include <algorithm>

namespace lidar::cdr {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMaxDuration = INT32_MAX * kSecond;

/// Writes a builtin_interfaces/msg/Duration. A missing duration is written as a negative duration.
void WriteDuration(const std::optional<Duration>& duration, CdrWriter* w) {
  const std::int64_t ns =
      duration ? std::clamp<std::int64_t>(duration->count(), 0, kMaxDuration) : -kSecond;
  w->I32(static_cast<std::int32_t>(ns / kSecond));
  w->U32(static_cast<std::uint32_t>(ns % kSecond));
}

std::optional<Duration> ReadDuration(CdrReader* r) {
  const std::int64_t seconds = r->I32();
  const std::int64_t ns = r->U32();
  if (seconds < 0 || ns >= kSecond) return std::nullopt;
  return Duration{seconds * kSecond + ns};
}

}  // namespace

std::optional<CodedSlice> ReadCodedSlice(ByteView message) {
  CdrReader r(message);
  CodedSlice slice;
  slice.header = ReadHeader(&r);
  slice.duration = ReadDuration(&r);
  slice.scan_id = r.U32();
  slice.slice_index = r.U32();
  slice.slice_count = r.U32();
  slice.first_column = r.U32();
  slice.discontinuity = r.Bool();
  slice.data = r.Octets();
  if (!r.ok()) return std::nullopt;
  return slice;
}

std::vector<std::uint8_t> WriteCodedSlice(const CodedSlice& slice) {
  std::vector<std::uint8_t> out;
  out.reserve(slice.data.size + slice.header.frame_id.size() + 64);
  CdrWriter w(&out);
  WriteHeader(slice.header, &w);
  WriteDuration(slice.duration, &w);
  w.U32(slice.scan_id);
  w.U32(slice.slice_index);
  w.U32(slice.slice_count);
  w.U32(slice.first_column);
  w.Bool(slice.discontinuity);
  w.Octets(slice.data);
  return out;
}

}  // namespace lidar::cdr
