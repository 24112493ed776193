// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/sensor_stream.h"

#include <algorithm>
#include <utility>

#include "src/ouster/imu_packet.h"

namespace lidar::ouster {
namespace {

// If the sensor's clock is off by more than this, it is not synchronised, even if the sensor claims
// so.
constexpr Duration kMaxSyncError = std::chrono::seconds(1);
// A sensor without serial numbers in its packets is recognised by its address. If no packet arrived
// for this long, packets from another address are accepted.
constexpr Duration kSenderKept = std::chrono::seconds(1);

/// Returns the offset from the sensor's time to UTC, or nothing if the sensor's clock is not
/// synchronised.
std::optional<Duration> SensorToUtc(const Metadata& metadata, const StreamOptions& options) {
  if (metadata.timestamp_mode == "TIME_FROM_PTP_1588") return options.ptp_utc_offset;
  // The NMEA messages that accompany the pulse contain UTC.
  if (metadata.timestamp_mode == "TIME_FROM_SYNC_PULSE_IN") return Duration{0};
  return std::nullopt;
}

}  // namespace

std::unique_ptr<SensorStream> SensorStream::Create(Metadata metadata, const StreamOptions& options,
                                                   std::string* error) {
  auto writer = PointWriter::Create(metadata, options.points, error);
  if (!writer) return nullptr;
  // A scan must be a single slice, because destaggering moves points to other columns, which may be
  // in another slice.
  const std::uint32_t slices =
      options.points.destagger ? 1 : SlicesPerScan(options.slices_per_scan, metadata.shape());
  return std::unique_ptr<SensorStream>(
      new SensorStream(std::move(metadata), *std::move(writer), options, slices));
}

SensorStream::SensorStream(Metadata metadata, PointWriter writer, const StreamOptions& options,
                           std::uint32_t slices_per_scan)
    : metadata_(std::move(metadata)),
      options_(options),
      writer_(std::move(writer)),
      batcher_(metadata_, writer_, {slices_per_scan, 4}),
      crc_(metadata_.format),
      local_(options.clock),
      utc_(options.clock),
      sensor_to_utc_(SensorToUtc(metadata_, options)) {}

void SensorStream::Flush() {
  batcher_.Flush();
  CollectSlices();
}

void SensorStream::Restart() {
  Flush();
  local_.Reset();
  utc_.Reset();
}

void SensorStream::Reposition() {
  Flush();
  ready_.clear();
  last_local_.reset();
  last_arrival_utc_ = {};
}

Duration SensorStream::slice_duration() const {
  return metadata_.scan_period() / batcher_.slices_per_scan();
}

void SensorStream::ObserveClocks(const LidarPacket& packet, const Arrival& arrival) {
  const bool hold = options_.clock == ClockMapper::Mode::kHold;
  for (std::uint32_t i = 0; i < packet.columns(); ++i) {
    // If the mode is kHold, the first valid column sets the offset, so that the first slice of a
    // file starts at 0.
    const PacketColumn column = packet.Column(hold ? i : packet.columns() - 1 - i);
    if (!column.valid()) continue;
    if (local_.WouldJump(column.timestamp, arrival.local)) {
      ++stats_.clock_jumps;
      Restart();
    }
    local_.Observe(column.timestamp, arrival.local);
    utc_.Observe(column.timestamp, arrival.utc);
    if (sensor_to_utc_) {
      const Time claimed(SinceSensorEpoch(column.timestamp) + *sensor_to_utc_);
      synchronised_ =
          claimed < arrival.utc + kMaxSyncError && claimed > arrival.utc - kMaxSyncError;
    }
    return;
  }
}

/// Counts a packet that does not have the size of this sensor's lidar packets, and returns its
/// kind.
PacketVerdict SensorStream::Refuse(ByteView payload, const Arrival& arrival) {
  if (IsImuPacket(payload, metadata_)) {
    const bool first = batcher_.stats().packets == 0;
    if (first || arrival.sender == sender_) {
      ++stats_.imu_packets;
      return PacketVerdict::kImu;
    }
    ++stats_.foreign;
    return PacketVerdict::kForeign;
  }
  const auto header = PeekHeader(payload, metadata_.format);
  const bool foreign = header && header->type == kLidarPacketType && metadata_.serial != 0 &&
                       header->serial != 0 && header->serial != metadata_.serial;
  ++(foreign ? stats_.foreign : stats_.wrong_size);
  return foreign ? PacketVerdict::kForeign : PacketVerdict::kWrongSize;
}

bool SensorStream::IsForeign(const PacketHeader& header, const Arrival& arrival) const {
  if (metadata_.serial != 0 && header.serial != 0) return header.serial != metadata_.serial;
  const bool first = batcher_.stats().packets == 0;
  return header.serial == 0 && !first && arrival.sender != sender_ &&
         arrival.utc < last_arrival_utc_ + kSenderKept;
}

PacketVerdict SensorStream::Push(ByteView payload, const Arrival& arrival) {
  const auto packet = LidarPacket::Parse(payload, metadata_.format);
  if (!packet) return Refuse(payload, arrival);
  const PacketHeader& header = packet->header();
  if (IsForeign(header, arrival)) {
    ++stats_.foreign;
    return PacketVerdict::kForeign;
  }
  // The CRC is checked after IsForeign(). Otherwise, if this sensor sends no CRC, a foreign packet
  // with a valid CRC would make the sensor's own packets count as damaged.
  if (!crc_.Accept(payload)) {
    ++stats_.damaged;
    return PacketVerdict::kDamaged;
  }
  if (metadata_.init_id != 0 && header.init_id != 0 && header.init_id != metadata_.init_id) {
    refused_init_id_ = header.init_id;
    return PacketVerdict::kNewInitId;
  }
  // Old metadata have no serial number. If the packet has the init id of the metadata, it was sent
  // by the metadata's sensor, so its serial number is known from here on.
  if (metadata_.serial == 0 && metadata_.init_id != 0 && header.init_id == metadata_.init_id)
    metadata_.serial = header.serial;
  ObserveClocks(*packet, arrival);
  last_arrival_utc_ = arrival.utc;
  sender_ = arrival.sender;
  // No time is known before the first valid column, because timestamps of invalid columns mean
  // nothing.
  if (!knows_time()) return PacketVerdict::kLidar;
  batcher_.Push(*packet, arrival.local);
  CollectSlices();
  return PacketVerdict::kLidar;
}

Time SensorStream::LocalOf(std::uint64_t sensor_ns) const { return local_.Map(sensor_ns); }

std::optional<Time> SensorStream::SampledAt(ByteView payload) const {
  const auto packet = LidarPacket::Parse(payload, metadata_.format);
  if (!packet) return std::nullopt;
  for (std::uint32_t i = 0; i < packet->columns(); ++i)
    if (packet->Column(i).valid()) return LocalOf(packet->Column(i).timestamp);
  return std::nullopt;
}

Time SensorStream::UtcOf(std::uint64_t sensor_ns) const {
  if (synchronised_) return Time(SinceSensorEpoch(sensor_ns) + *sensor_to_utc_);
  return utc_.Map(sensor_ns);
}

/// Takes the finished slices from the batcher and sets their times. Must be called before the
/// clocks change.
void SensorStream::CollectSlices() {
  while (auto slice = batcher_.Pop()) {
    TimedSlice timed;
    timed.local =
        options_.times == TimeSource::kSensor ? local_.Map(slice->start) : slice->first_arrival;
    if (last_local_) timed.local = std::max(timed.local, *last_local_);
    last_local_ = timed.local;
    timed.utc = UtcOf(slice->start);
    timed.completed = last_arrival_utc_;
    slice->scan_id += first_scan_id_;
    next_scan_id_ = slice->scan_id + 1;
    timed.slice = *std::move(slice);
    ready_.push_back(std::move(timed));
  }
}

std::optional<TimedSlice> SensorStream::Pop() {
  if (ready_.empty()) return std::nullopt;
  TimedSlice timed = std::move(ready_.front());
  ready_.pop_front();
  return timed;
}

}  // namespace lidar::ouster
