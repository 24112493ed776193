// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the UDP payloads of one sensor to slices with times: a driver without sockets and
// clocks.
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

/// An IP address; zeros: not known.
using Sender = std::array<std::uint8_t, 16>;

/// Time and source of a packet.
struct Arrival {
  Time local{};  // by the clock of the slices' times
  Time utc{};    // since the Unix epoch
  Sender sender{};
};

enum class TimeSource { kSensor, kArrival };

struct StreamOptions {
  PointOptions points;
  std::uint32_t slices_per_scan = 0;  // 0: automatic
  TimeSource times = TimeSource::kSensor;
  ClockMapper::Mode clock = ClockMapper::Mode::kFollow;
  Duration ptp_utc_offset = std::chrono::seconds(-37);  // from the sensor's PTP time to UTC
};

struct TimedSlice {
  Slice slice;
  Time local{};  // of the first column; never earlier than the last slice's
  Time utc{};
  Time completed{};  // arrival of the packet that completed it, in UTC
};

enum class PacketVerdict {
  kLidar,
  kImu,
  kWrongSize,  // of another profile, mode or sensor
  kForeign,    // of another sensor, by its serial number or, without one, by its sender
  kDamaged,    // by its CRC
  kNewInitId,  // the sensor restarted or was reconfigured: its metadata may be outdated
};

struct StreamStats {
  std::uint64_t wrong_size = 0;
  std::uint64_t foreign = 0;
  std::uint64_t damaged = 0;
  std::uint64_t imu_packets = 0;
  std::uint64_t clock_jumps = 0;  // of the sensor's clock against the arrivals
};

class SensorStream {
 public:
  /// Returns null and sets `error` if the options do not fit the sensor.
  static std::unique_ptr<SensorStream> Create(Metadata metadata, const StreamOptions& options,
                                              std::string* error);

  /// Takes a packet. A packet with kNewInitId is left out: refresh the metadata, or call
  /// AcceptNewInitId() and push the packet again.
  PacketVerdict Push(ByteView payload, const Arrival& arrival);
  /// Call this after kNewInitId: the sensor restarted, and packets with that init id are accepted
  /// from now on.
  void AcceptNewInitId() { metadata_.init_id = refused_init_id_; }
  std::optional<TimedSlice> Pop();
  /// Makes incomplete slices ready. The next packet may be of any scan.
  void Flush();
  /// Calls Flush(); the next packet may have any time.
  void Restart();
  /// Drops incomplete and waiting slices: the next packet is from another place of a recording. The
  /// offsets of the clocks stay, so a slice has the same time after any seek.
  void Reposition();
  /// Notes that UTC is later by `step` at the same local time, from the next packet on.
  void ShiftUtc(Duration step) { utc_.Shift(step); }
  /// Continues after the last slice of the stream before a reconfiguration.
  void Continue(const SensorStream& before) {
    first_scan_id_ = before.next_scan_id_;
    last_local_ = before.last_local_;
  }
  /// Returns true once a packet has set the clocks, also after Restart().
  bool knows_time() const { return local_.is_set(); }
  Time LocalOf(std::uint64_t sensor_ns) const;
  /// Returns the sampling time of a lidar packet's first column without taking the packet; nothing
  /// for other packets.
  std::optional<Time> SampledAt(ByteView payload) const;
  Time UtcOf(std::uint64_t sensor_ns) const;
  const StreamOptions& options() const { return options_; }

  const Metadata& metadata() const { return metadata_; }
  const PointWriter& writer() const { return writer_; }
  const ScanBatcher& batcher() const { return batcher_; }
  const StreamStats& stats() const { return stats_; }
  Duration slice_duration() const;
  /// Returns true if capture times come from the sensor's own synchronised clock.
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
  std::optional<Duration> sensor_to_utc_;  // if the sensor claims to be synchronised
  bool synchronised_ = false;
  std::uint32_t refused_init_id_ = 0;
  std::optional<Time> last_local_;
  Time last_arrival_utc_{};
  Sender sender_{};  // of the last lidar packet
  std::deque<TimedSlice> ready_;
  std::uint32_t first_scan_id_ = 0;
  std::uint32_t next_scan_id_ = 0;
  StreamStats stats_;
};

}  // namespace lidar::ouster
