// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/imu_input.h"

#include <cstring>
#include <utility>

#include "src/cdr/motion_samples.h"

namespace lidar::gst {
namespace {

/// Reads the rotation of the caps field `imu-to-sensor`, a row-major transform. Returns false if it
/// is not a rotation.
bool ReadRotation(const GstStructure* caps, Eigen::Matrix3d* rotation) {
  const GValue* list = gst_structure_get_value(caps, "imu-to-sensor");
  rotation->setIdentity();
  if (list == nullptr) return true;
  if (!GST_VALUE_HOLDS_ARRAY(list) || gst_value_array_get_size(list) != 16) return false;
  for (guint i = 0; i < 16; ++i) {
    const GValue* number = gst_value_array_get_value(list, i);
    if (!G_VALUE_HOLDS_DOUBLE(number)) return false;
    if (i / 4 < 3 && i % 4 < 3) (*rotation)(i / 4, i % 4) = g_value_get_double(number);
  }
  return rotation->isUnitary(1e-3);
}

}  // namespace

bool ImuInput::SetCaps(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  const gchar* fields = gst_structure_get_string(s, "fields");
  Eigen::Matrix3d rotation;
  const bool known =
      fields != nullptr && std::strcmp(fields, kImuFields) == 0 && ReadRotation(s, &rotation);
  std::lock_guard lock(mutex_);
  known_ = known;
  if (known) to_sensor_ = rotation;
  return known;
}

bool ImuInput::Add(ByteView bytes) {
  std::lock_guard lock(mutex_);
  if (!known_ || bytes.size % kImuSampleSize != 0) return false;
  for (const cdr::Imu& imu : cdr::ReadImuSamples(bytes)) {
    const auto& g = imu.angular_velocity;
    const auto& a = imu.linear_acceleration;
    samples_.push_back({imu.header.stamp, to_sensor_ * Eigen::Vector3d(g[0], g[1], g[2]),
                        to_sensor_ * Eigen::Vector3d(a[0], a[1], a[2])});
  }
  if (samples_.size() > kMostSamples)
    samples_.erase(samples_.begin(), samples_.end() - static_cast<std::ptrdiff_t>(kMostSamples));
  return true;
}

std::vector<MotionSample> ImuInput::Take() {
  std::lock_guard lock(mutex_);
  return std::exchange(samples_, {});
}

void ImuInput::Clear() {
  std::lock_guard lock(mutex_);
  samples_.clear();
}

}  // namespace lidar::gst
