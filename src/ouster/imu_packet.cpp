// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/imu_packet.h"

namespace lidar::ouster {
namespace {

constexpr std::size_t kHeaderSize = 32;
constexpr std::size_t kNmeaSize = 100;
constexpr std::size_t kMeasurementSize = 36;
constexpr float kGravity = 9.80665F;  // LEGACY packets use g and degrees per second
constexpr float kRadiansPerSecond = 3.14159265F / 180;

std::array<float, 3> ReadVector(ByteReader* r, float scale) {
  std::array<float, 3> v{};
  for (float& component : v) component = r->LeF32() * scale;
  return v;
}

std::vector<ImuSample> ReadLegacy(ByteView bytes) {
  ByteReader r(bytes);
  ImuSample sample;
  r.Skip(16);                   // times of the packet and of the accelerometer
  sample.timestamp = r.Le64();  // time of the gyroscope
  sample.acceleration = ReadVector(&r, kGravity);
  sample.angular_velocity = ReadVector(&r, kRadiansPerSecond);
  return {sample};
}

std::vector<ImuSample> ReadAccelGyro(ByteView bytes, std::uint32_t measurements) {
  std::vector<ImuSample> samples;
  ByteReader r(bytes);
  r.Skip(kHeaderSize + kNmeaSize);
  for (std::uint32_t i = 0; i < measurements; ++i) {
    ImuSample sample;
    sample.timestamp = r.Le64();
    r.Skip(2);  // measurement id
    const bool valid = (r.Le16() & 1U) != 0;
    sample.acceleration = ReadVector(&r, 1);
    sample.angular_velocity = ReadVector(&r, 1);
    if (valid) samples.push_back(sample);
  }
  return samples;
}

}  // namespace

bool IsImuPacket(ByteView bytes, const Metadata& metadata) {
  return !bytes.empty() && bytes.size == metadata.imu_packet_size();
}

std::optional<std::vector<ImuSample>> ParseImuPacket(ByteView bytes, const Metadata& metadata) {
  if (!IsImuPacket(bytes, metadata)) return std::nullopt;
  if (metadata.imu_profile == ImuProfile::kLegacy) return ReadLegacy(bytes);
  return ReadAccelGyro(bytes, metadata.imu_measurements_per_packet);
}

std::vector<std::size_t> ImuTimestamps(const Metadata& metadata) {
  if (metadata.imu_profile == ImuProfile::kLegacy) return {0, 8, 16};
  std::vector<std::size_t> places;
  for (std::uint32_t i = 0; i < metadata.imu_measurements_per_packet; ++i)
    places.push_back(kHeaderSize + kNmeaSize + i * kMeasurementSize);
  return places;
}

}  // namespace lidar::ouster
