// SPDX-License-Identifier: LGPL-2.1-or-later
// The sometimes pad `imu` with the samples of a sensor's inertial measurement unit. It ends with
// the pad src.
#pragma once
#include <gst/gst.h>

#include <mutex>

#include "src/ouster/sensor_stream.h"

namespace lidar::gst {

/// A buffer holds one packet's samples, each the capture time [ns since the Unix epoch, U64],
/// acceleration [m/s^2, 3 x F32] and angular velocity [rad/s, 3 x F32] in the IMU's frame,
/// little-endian.
class ImuPad {
 public:
  explicit ImuPad(GstElement* element);
  ~ImuPad();
  ImuPad(const ImuPad&) = delete;
  ImuPad& operator=(const ImuPad&) = delete;

  /// Adds the pad with the first packet. An unlinked or flushing pad is no error.
  void Push(ByteView packet, const ouster::SensorStream& stream);

  /// Sets the segment of the next packets. Not while Push() runs.
  void SetSegment(const GstSegment& segment);
  /// Call them around a flushing seek of the clouds, from any thread.
  void StartFlush(guint32 seqnum);
  void StopFlush(guint32 seqnum);

 private:
  void Prepare(const ouster::Metadata& metadata);
  void AddPad();
  void SetCaps(const ouster::Metadata& metadata);

  GstPad* StartOrStopFlush(bool flushing);

  GstElement* element_;
  std::mutex mutex_;  // guards flushing_, and pad_ against other threads
  bool flushing_ = false;
  GstPad* pad_ = nullptr;  // owned by the element
  GstSegment segment_{};
  bool segment_pending_ = true;
  gulong end_of_clouds_ = 0;   // probe on the pad src, where pad_ is there
  Transform imu_to_sensor_{};  // of the caps
  GstClockTime last_pts_ = 0;
};

}  // namespace lidar::gst
