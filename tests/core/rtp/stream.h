// SPDX-License-Identifier: LGPL-2.1-or-later
// A sender of synthetic slices. A test may drop, repeat, damage and reorder its packets.
#pragma once
#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/cloud/sensor_model.h"
#include "src/rtp/packetizer.h"
#include "src/rtp/receiver.h"

namespace lidar::rtp::test {

using std::chrono::milliseconds;

constexpr milliseconds kReorder{100};  // the time for which receivers wait for late packets

inline std::vector<std::uint8_t> SliceBytes(std::uint32_t scan, std::uint32_t index,
                                            std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  std::uint32_t x = scan * 2654435761U + index * 40503U + 1;
  for (auto& b : bytes) {
    x = x * 1664525U + 1013904223U;
    b = static_cast<std::uint8_t>(x >> 24);
  }
  return bytes;
}

inline StreamConfig SmallConfig() {
  SensorModel model;
  model.columns_per_scan = 512;
  model.beams = {{1, 10, 0}, {-1, -10, 4}};
  StreamConfig c;
  c.geometry = Geometry::kRange;
  c.framerate_n = 10;
  c.fields = "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16";
  c.sensor_model = model.Serialise();
  return c;
}

/// A packet as it is sent, with the scan and the slice that it belongs to.
struct Wire {
  std::vector<std::uint8_t> payload;
  std::uint32_t ssrc = 0;
  std::uint16_t sequence = 0;
  bool marker = false;
  bool config = false;
  std::uint32_t scan = 0;
  std::uint32_t index = 0;
  Time sent;
};

template <class Predicate>
void Lose(std::vector<Wire>* packets, Predicate lost) {
  packets->erase(std::remove_if(packets->begin(), packets->end(), lost), packets->end());
}

struct SenderOptions {
  std::uint32_t ssrc = 0x11223344;
  std::uint16_t sequence = 65'000;  // This value wraps early.
  std::uint32_t scan_number = 0xFFFF'FFFE;
  std::uint16_t slices = 4;
  std::size_t slice_size = 2'500;
  std::size_t max_payload = 1'000;
  std::uint8_t config_id = 9;
  StreamConfig config = SmallConfig();
};

class Sender {
 public:
  explicit Sender(SenderOptions o = {}) : o_(std::move(o)), sequence_(o_.sequence) {}

  void Config(std::vector<Wire>* out) {
    Unit unit;
    unit.unit = UnitType::kStreamConfig;
    unit.config_id = o_.config_id;
    Emit(unit, o_.config.Serialise(), out);
  }
  /// Appends the packets of a slice to `out`. With `counter`, the slice names the skipped slices
  /// before it.
  void Slice(std::uint32_t scan, std::uint16_t index, std::vector<Wire>* out,
             ScanCounter* counter = nullptr) {
    Unit unit;
    unit.config_id = o_.config_id;
    unit.slice = {o_.scan_number + scan, index, o_.slices};
    unit.info = {scan, static_cast<std::uint16_t>(index * 100), 25'000'000, 7, 0};
    if (counter != nullptr) counter->Place(&unit);
    time_ = Time{milliseconds(100 * scan) + milliseconds(100) * index / o_.slices};
    Emit(unit, SliceBytes(scan, index, o_.slice_size), out);
  }
  /// Returns the config and `scans` whole scans. The first scan has the id `first`.
  std::vector<Wire> Scans(std::uint32_t first, std::uint32_t scans) {
    std::vector<Wire> out;
    time_ = Time{milliseconds(100 * first)};
    Config(&out);
    for (std::uint32_t s = first; s < first + scans; ++s)
      for (std::uint16_t i = 0; i < o_.slices; ++i) Slice(s, i, &out);
    return out;
  }
  /// Returns the config and `scans` scans. The slices for which `left_out` returns true are
  /// skipped.
  template <class LeftOut>
  std::vector<Wire> ScansWithout(std::uint32_t scans, LeftOut&& left_out) {
    std::vector<Wire> out;
    ScanCounter counter(o_.scan_number);
    Config(&out);
    for (std::uint32_t s = 0; s < scans; ++s)
      for (std::uint16_t i = 0; i < o_.slices; ++i)
        if (!left_out(s, i)) Slice(s, i, &out, &counter);
    return out;
  }

 private:
  void Emit(const Unit& unit, const std::vector<std::uint8_t>& bytes, std::vector<Wire>* out) {
    for (const Packet& p : Packetize(unit, {bytes.data(), bytes.size()}, o_.max_payload)) {
      Wire w;
      w.payload = p.header;
      w.payload.insert(w.payload.end(), bytes.begin() + static_cast<std::ptrdiff_t>(p.body_offset),
                       bytes.begin() + static_cast<std::ptrdiff_t>(p.body_offset + p.body_size));
      w.ssrc = o_.ssrc;
      w.sequence = sequence_++;
      w.marker = p.marker;
      w.config = unit.unit == UnitType::kStreamConfig;
      w.scan = unit.info.scan_id;
      w.index = unit.slice.index;
      w.sent = time_;
      out->push_back(std::move(w));
    }
  }

  SenderOptions o_;
  std::uint16_t sequence_;
  Time time_;
};

inline std::vector<ReceivedSlice> Deliver(Receiver* receiver, const Wire& w) {
  RtpPacket p;
  p.ssrc = w.ssrc;
  p.sequence = w.sequence;
  p.arrival = w.sent;
  p.pts = w.sent;
  p.payload = {w.payload.data(), w.payload.size()};
  return receiver->Push(p);
}

/// Delivers the packets. Returns the names "scan.index" of the slices in the order in which the
/// receiver returned them. If the contents of a slice are wrong, its name ends with " differs".
inline std::vector<std::string> DeliverAll(Receiver* receiver, const std::vector<Wire>& packets,
                                           std::size_t slice_size = SenderOptions{}.slice_size) {
  std::vector<std::string> names;
  for (const Wire& w : packets) {
    for (const ReceivedSlice& s : Deliver(receiver, w)) {
      const bool equal = s.bytes == SliceBytes(s.info.scan_id, s.id.index, slice_size);
      names.push_back(std::to_string(s.info.scan_id) + "." + std::to_string(s.id.index) +
                      (equal ? "" : " differs"));
    }
  }
  return names;
}

/// Returns the names of all slices of `scans` scans in order. The first scan is `first`.
inline std::vector<std::string> AllSlices(std::uint32_t first, std::uint32_t scans,
                                          std::uint32_t slices = SenderOptions{}.slices) {
  std::vector<std::string> names;
  for (std::uint32_t s = first; s < first + scans; ++s)
    for (std::uint32_t i = 0; i < slices; ++i)
      names.push_back(std::to_string(s) + "." + std::to_string(i));
  return names;
}

}  // namespace lidar::rtp::test
