// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/synth_stream.h"

#include <algorithm>
#include <stdexcept>

#include "src/base/byte_writer.h"
#include "src/synth/imu.h"

namespace lidar::tools {
namespace {

using namespace std::chrono_literals;
using ouster::Channel;

constexpr Duration kImuPeriod = 10ms;
constexpr std::uint64_t kSerial = 122999000001;

struct Mode {
  std::uint32_t columns = 0;
  std::uint32_t rate = 0;
};

Mode ParseMode(const std::string& text) {
  for (const std::uint32_t columns : {512U, 1024U, 2048U, 4096U})
    for (const std::uint32_t rate : {5U, 10U, 20U})
      if (text == std::to_string(columns) + "x" + std::to_string(rate)) return {columns, rate};
  throw std::runtime_error("there is no mode \"" + text +
                           "\"; modes are 512, 1024, 2048 and 4096 columns x 5, 10 and 20");
}

synth::Sensor MakeSensor(const std::string& model, std::uint32_t columns) {
  auto sensor = synth::MakeSensor(model, columns);
  if (!sensor)
    throw std::runtime_error("there is no model \"" + model + "\" with " + std::to_string(columns) +
                             " columns");
  return *std::move(sensor);
}

synth::ScannerConfig MakeScanner(const SynthOptions& options, const ouster::Metadata& m) {
  synth::ScannerConfig config;
  config.sensor = MakeSensor(options.model, m.model.columns_per_scan);
  config.period = m.scan_period();
  config.scene = options.scene;
  config.speed_mps = options.speed_mps;
  config.seed = options.seed;
  config.second_returns = m.format.has_second_return();
  return config;
}

/// Converts a model to a product line, such as "os1-128" to "OS-1-128".
std::string ProductLine(const std::string& model) { return "OS-" + model.substr(2); }

}  // namespace

ouster::Metadata MakeSynthMetadata(const SynthOptions& options, const SynthFormat& format) {
  const Mode mode = ParseMode(format.mode);
  ouster::Metadata m;
  m.model = MakeSensor(options.model, mode.columns).model;
  m.product_line = ProductLine(options.model);
  m.serial = kSerial + options.seed;
  m.serial_text = std::to_string(m.serial);
  m.firmware = "v3.1.0";
  m.init_id = 1;
  m.lidar_mode = format.mode;
  m.timestamp_mode = "TIME_FROM_INTERNAL_OSC";
  m.scans_per_second = mode.rate;
  m.format = {format.profile, format.header, static_cast<std::uint32_t>(m.model.beams.size()),
              format.columns_per_packet};
  m.model.range_unit_mm = m.format.range_unit_mm();
  m.window = {0, mode.columns};
  m.imu_to_sensor = {1, 0, 0, 0.006253, 0, 1, 0, -0.011775, 0, 0, 1, 0.007645, 0, 0, 0, 1};
  m.lidar_port = 7502;
  m.imu_port = 7503;
  if (m.format.packet_size() == 0) throw std::runtime_error("profile OFF sends no packets");
  if (format.columns_per_packet == 0 || mode.columns % format.columns_per_packet != 0)
    throw std::runtime_error("the columns of a packet must divide those of a scan");
  if (m.format.packet_size() > ouster::PacketFormat::kMaxPacketSize)
    throw std::runtime_error("packets of " + std::to_string(m.format.packet_size()) +
                             " bytes are larger than UDP carries: set fewer columns a packet");
  return m;
}

SynthStream::SynthStream(const SynthOptions& options, const ouster::Metadata& metadata)
    : metadata_(metadata), scanner_(MakeScanner(options, metadata)) {
  Restart({metadata.init_id, 0});
}

void SynthStream::Restart(const Start& start) {
  start_ = start;
  writer_ = std::make_unique<ouster::PacketWriter>(
      metadata_.format, ouster::PacketIdentity{start.init_id, metadata_.serial});
  // The car continues its drive. Only the counters of the sensor restart.
  scan_ = 0;
  column_ = 0;
  imu_ = 0;
}

/// Returns the time at which the next lidar packet is sent. Its last column is then complete.
Duration SynthStream::LidarDue() const {
  return scanner_.ColumnTime(scan_, 0) + metadata_.scan_period() *
                                             (column_ + metadata_.format.columns_per_packet) /
                                             metadata_.model.columns_per_scan;
}

std::optional<OutPacket> SynthStream::Next() {
  for (;;) {
    if (kImuPeriod * static_cast<std::int64_t>(imu_) < LidarDue()) return ImuPacket();
    auto packet = LidarPacket();
    column_ += metadata_.format.columns_per_packet;
    if (column_ >= metadata_.model.columns_per_scan) {
      column_ = 0;
      ++scan_;
    }
    if (packet) return packet;
  }
}

void SynthStream::WritePixel(ouster::PacketWriter* writer, std::uint32_t column, std::uint32_t beam,
                             std::size_t at) const {
  const std::uint32_t unit = metadata_.model.range_unit_mm;
  const ouster::PacketWriter::Pixel pixel{column, beam};
  const std::uint32_t reflectivity = returns_.reflectivity[at];
  writer->SetPixel(pixel, Channel::kRange, returns_.range_mm[at] / unit * unit);
  writer->SetPixel(pixel, Channel::kReflectivity, reflectivity);
  writer->SetPixel(pixel, Channel::kSignal, returns_.signal[at]);
  writer->SetPixel(pixel, Channel::kNearIr, 200 + reflectivity * 4);
  if (returns_.range2_mm.empty()) return;
  writer->SetPixel(pixel, Channel::kRange2, returns_.range2_mm[at] / unit * unit);
  writer->SetPixel(pixel, Channel::kReflectivity2, returns_.reflectivity2[at]);
  writer->SetPixel(pixel, Channel::kSignal2, returns_.signal2[at]);
}

std::optional<OutPacket> SynthStream::LidarPacket() {
  const std::uint32_t n = metadata_.format.columns_per_packet;
  const std::uint32_t columns = metadata_.model.columns_per_scan;
  const auto in_window = [&](std::uint32_t m) {
    return m < columns && (m + columns - metadata_.window.first) % columns < metadata_.window.count;
  };
  bool any = false;
  for (std::uint32_t i = 0; i < n; ++i) any = any || in_window(column_ + i);
  if (!any) return std::nullopt;
  scanner_.Cast(scan_, {column_, n}, &returns_);
  writer_->Begin(static_cast<std::uint32_t>(scan_));
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t m = column_ + i;
    const auto time = static_cast<std::uint64_t>(scanner_.ColumnTime(scan_, m).count());
    writer_->SetColumn(i,
                       {start_.sensor_time_ns + time, static_cast<std::uint16_t>(m), in_window(m)});
    if (!in_window(m)) continue;
    for (std::uint32_t beam = 0; beam < metadata_.format.beams; ++beam)
      WritePixel(writer_.get(), i, beam, std::size_t{beam} * n + i);
  }
  return OutPacket{LidarDue(), false, writer_->Finish()};
}

OutPacket SynthStream::ImuPacket() {
  constexpr double kGravity = 9.80665;
  constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;
  const Duration t = kImuPeriod * static_cast<std::int64_t>(imu_++);
  const ImuSample sample = synth::TrueMotion(scanner_.trajectory(), t);
  OutPacket packet{t, true, {}};
  ByteWriter w(&packet.bytes);
  const std::uint64_t time = start_.sensor_time_ns + static_cast<std::uint64_t>(t.count());
  for (int i = 0; i < 3; ++i) w.Le64(time);
  for (const double a : sample.acceleration) w.LeF32(static_cast<float>(a / kGravity));
  for (const double rate : sample.angular_velocity)
    w.LeF32(static_cast<float>(rate * kDegreesPerRadian));
  return packet;
}

}  // namespace lidar::tools
