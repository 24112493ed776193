// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the UDP payloads of one sensor to slices with times. It uses neither sockets nor clocks.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "src/base/time.h"
#include "src/ouster/clock_mapper.h"
#include "src/ouster/metadata.h"
#include "src/ouster/point_writer.h"
#include "src/ouster/scan_batcher.h"

namespace lidar::ouster {

/// An IPv4 or IPv6 address. It is all zeros if it is not known.
using Sender = std::array<std::uint8_t, 16>;

/// The arrival time and the sender of a packet.
struct Arrival {
  Time local{};  // by the clock that times the slices
  Time utc{};    // since the Unix epoch
  Sender sender{};
};

enum class TimeSource { kSensor, kArrival };

struct StreamOptions {
  PointOptions points;
  std::uint32_t slices_per_scan = 0;  // 0: chosen automatically
  TimeSource times = TimeSource::kSensor;
  ClockMapper::Mode clock = ClockMapper::Mode::kFollow;
  Duration ptp_utc_offset = std::chrono::seconds(-37);  // from the sensor's PTP time to UTC
};

struct TimedSlice {
  Slice slice;
  Time local{};  // time of the first column; never earlier than the last slice
  Time utc{};
  Time completed{};  // arrival of the packet that completed the slice, in UTC
};

enum class PacketVerdict {
  kLidar,
  kImu,
  kWrongSize,  // a packet of another profile, mode or sensor
  // The packet is from another sensor: it has another serial number, or no serial number and
  // another sender.
  kForeign,
  kDamaged,    // the CRC is wrong
  kNewInitId,  // the sensor restarted or was reconfigured: the metadata may be outdated
};

struct StreamStats {
  std::uint64_t wrong_size = 0;
  std::uint64_t foreign = 0;
  std::uint64_t damaged = 0;
  std::uint64_t imu_packets = 0;
  std::uint64_t clock_jumps = 0;  // jumps of the sensor's clock relative to arrival times
};

class SensorStream {
 public:
  /// Returns null and sets `error` if the sensor does not support the options.
  static std::unique_ptr<SensorStream> Create(Metadata metadata, const StreamOptions& options,
                                              std::string* error);

  /// Processes a packet. If it returns kNewInitId, the packet was not processed. The caller then
  /// either fetches new metadata, or calls AcceptNewInitId() and pushes the packet again.
  PacketVerdict Push(ByteView payload, const Arrival& arrival);
  /// Accepts packets of the restarted sensor from now on. Call this after Push() returned
  /// kNewInitId.
  void AcceptNewInitId() { metadata_.init_id = refused_init_id_; }
  std::optional<TimedSlice> Pop();
  /// Makes incomplete slices ready. The next packet may belong to any scan.
  void Flush();
  /// Makes incomplete slices ready and forgets the clock offsets. The next packet may have any
  /// time.
  void Restart();
  /// Drops incomplete and waiting slices, because the next packet is from another position in a
  /// recording. The clock offsets do not change, so a slice has the same time after any seek.
  void Reposition();
  /// Notes that from the next packet on, UTC is later by `step` at the same local time.
  void ShiftUtc(Duration step) { utc_.Shift(step); }
  /// Continues the scan numbers and times of `before`, the stream that a reconfiguration ended.
  void Continue(const SensorStream& before) {
    first_scan_id_ = before.next_scan_id_;
    last_local_ = before.last_local_;
  }
  /// Returns true if a packet has set the clock offsets since the stream was created or restarted.
  bool knows_time() const { return local_.is_set(); }
  Time LocalOf(std::uint64_t sensor_ns) const;
  /// Returns the sampling time of the first valid column of a lidar packet, without processing the
  /// packet. Returns nothing for other packets.
  std::optional<Time> SampledAt(ByteView payload) const;
  Time UtcOf(std::uint64_t sensor_ns) const;
  const StreamOptions& options() const { return options_; }

  const Metadata& metadata() const { return metadata_; }
  const PointWriter& writer() const { return writer_; }
  const ScanBatcher& batcher() const { return batcher_; }
  const StreamStats& stats() const { return stats_; }
  Duration slice_duration() const;
  /// Returns true if capture times are those of the sensor's own synchronised clock.
  bool has_synchronised_clock() const { return synchronised_; }

 private:
  SensorStream(Metadata metadata, PointWriter writer, const StreamOptions& options,
               std::uint32_t slices_per_scan);
  PacketVerdict Refuse(ByteView payload, const Arrival& arrival);
  bool IsForeign(const PacketHeader& header, const Arrival& arrival) const;
  void ObserveClocks(const LidarPacket& packet, const Arrival& arrival);
  void CollectSlices();

  Metadata metadata_;
  StreamOptions options_;
  PointWriter writer_;
  ScanBatcher batcher_;
  PacketCrcCheck crc_;
  ClockMapper local_;
  ClockMapper utc_;
  std::optional<Duration> sensor_to_utc_;  // only if the sensor claims to be synchronised
  bool synchronised_ = false;
  std::uint32_t refused_init_id_ = 0;
  std::optional<Time> last_local_;
  Time last_arrival_utc_{};
  Sender sender_{};  // sender of the last lidar packet
  std::deque<TimedSlice> ready_;
  std::uint32_t first_scan_id_ = 0;
  std::uint32_t next_scan_id_ = 0;
  StreamStats stats_;
};

}  // namespace lidar::ouster
