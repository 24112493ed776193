// SPDX-License-Identifier: LGPL-2.1-or-later
// All that one sensor sends, from UDP payloads to slices with times: what a driver is without
// sockets and clocks.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "base/time.h"
#include "ouster/clock_mapper.h"
#include "ouster/metadata.h"
#include "ouster/point_writer.h"
#include "ouster/scan_batcher.h"

namespace lidar::ouster {

/// When a packet came.
struct Arrival {
  Time local{};  // of the clock that the slices' times are wanted in
  Time utc{};    // since the Unix epoch
};

enum class TimeSource { kSensor, kArrival };

struct StreamOptions {
  PointOptions points;
  std::uint32_t slices_per_scan = 0;  // 0: automatic
  TimeSource times = TimeSource::kSensor;
  ClockMapper::Mode clock = ClockMapper::Mode::kFollow;
  Duration ptp_utc_offset = std::chrono::seconds(-37);  // what turns the sensor's PTP time into UTC
};

struct TimedSlice {
  Slice slice;
  Time local{};  // of the first column; never before that of the slice before
  Time utc{};
};

enum class PacketVerdict {
  kLidar,
  kImu,
  kWrongSize,  // of another profile, mode or sensor
  kForeign,    // of another sensor, by its serial number
  kDamaged,    // by its CRC
  kNewInitId,  // the sensor restarted or was reconfigured: its metadata may be out of date
};

struct StreamStats {
  std::uint64_t wrong_size = 0;
  std::uint64_t foreign = 0;
  std::uint64_t damaged = 0;
  std::uint64_t imu_packets = 0;
};

class SensorStream {
 public:
  /// Null and `error` where the options do not fit the sensor.
  static std::unique_ptr<SensorStream> Create(Metadata metadata, const StreamOptions& options,
                                              std::string* error);

  /// The first three verdicts that are no error need no action; on kNewInitId the packet was left
  /// out: refresh the metadata, or Accept() what the sensor now sends.
  PacketVerdict Push(ByteView payload, const Arrival& arrival);
  /// From now on packets of any init id are taken, each new one as a restart.
  void AcceptAnyInitId() { any_init_id_ = true; }
  std::optional<TimedSlice> Pop();
  /// Makes the slices that are not complete ready. The next packet may be of any scan.
  void Flush();
  /// Flush(), and the next packet may be of any time.
  void Restart();
  /// Where this scan counter goes on from: for the stream that follows a reconfiguration.
  void StartScansAt(std::uint32_t scan_id) { first_scan_id_ = scan_id; }
  std::uint32_t next_scan_id() const { return next_scan_id_; }

  const Metadata& metadata() const { return metadata_; }
  const PointWriter& writer() const { return writer_; }
  const ScanBatcher& batcher() const { return batcher_; }
  const StreamStats& stats() const { return stats_; }
  Duration slice_duration() const;
  /// True where capture times come from the sensor's own synchronised clock.
  bool has_synchronised_clock() const { return synchronised_; }

 private:
  SensorStream(Metadata metadata, PointWriter writer, const StreamOptions& options,
               std::uint32_t slices_per_scan);
  void ObserveClocks(const LidarPacket& packet, const Arrival& arrival);
  Time UtcOf(std::uint64_t sensor_ns) const;
  void CollectSlices();

  Metadata metadata_;
  StreamOptions options_;
  PointWriter writer_;
  ScanBatcher batcher_;
  PacketCrcCheck crc_;
  ClockMapper local_;
  ClockMapper utc_;
  std::optional<Duration> sensor_to_utc_;  // where the sensor claims to be synchronised
  bool synchronised_ = false;
  bool any_init_id_ = false;
  std::optional<Time> last_local_;
  std::deque<TimedSlice> ready_;
  std::uint32_t first_scan_id_ = 0;
  std::uint32_t next_scan_id_ = 0;
  StreamStats stats_;
};

}  // namespace lidar::ouster
