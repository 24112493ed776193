// SPDX-License-Identifier: LGPL-2.1-or-later
// The state of ouster_src between start and stop. It receives packets from a sensor or a file, and
// returns buffers.
#pragma once
#include <gst/base/gstbasesrc.h>

#include <array>
#include <memory>
#include <mutex>
#include <optional>

#include "ext/ouster/loss_report.h"
#include "ext/ouster/settings.h"
#include "gst/common/imu_pad.h"
#include "gst/common/stats.h"
#include "src/ouster/sensor_stream.h"

namespace lidar::gst {

/// The counters of ouster_src, which its property `stats` shows.
struct Counters {
  ouster::BatcherStats batcher;
  ouster::StreamStats stream;
  guint64 kernel_drops = 0;
  guint reconnects = 0;
  guint receive_buffer = 0;  // bytes
  bool synchronised = false;
};
extern const std::array<Stat<Counters>, 17> kOusterStats;

/// Methods are called in the streaming thread, except where a comment says otherwise. The session
/// posts its own error messages.
class Session {
 public:
  static std::shared_ptr<Session> Create(GstBaseSrc* element, const OusterSettings& settings);
  virtual ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Opens the file or the sockets. Called by the thread that starts the element. If it fails,
  /// posts an error message and returns false.
  virtual bool Open() = 0;
  GstFlowReturn Next(GstBuffer** out);
  /// Unlock() makes Next() return FLUSHING until UnlockStop() is called. Any thread may call both.
  virtual void Unlock() = 0;
  virtual void UnlockStop() = 0;
  /// Called when the pipeline starts to play, also after a pause. Any thread may call it.
  virtual void Resume() {}

  /// Returns true if Seek() is supported.
  virtual bool seekable() const { return false; }
  /// Makes Next() return the slices of `segment`. Must not be called while Next() runs.
  virtual void Seek(const GstSegment& segment) {
    start_ = segment.start;
    ended_ = false;
    imu_.SetSegment(segment);
  }
  /// Returns the duration if it is known. May read a file. Any thread may call it.
  virtual std::optional<GstClockTime> duration() { return std::nullopt; }

  /// Any thread may call the following methods.
  ImuPad& imu() { return imu_; }
  Counters counters() const;
  GstClockTime slice_duration() const;

 protected:
  Session(GstBaseSrc* element, OusterSettings settings);

  /// Waits for packets and processes them. If it returns OK, Next() looks for slices and then calls
  /// Poll() again.
  virtual GstFlowReturn Poll() = 0;
  virtual void AddCounters(Counters*) const {}

  /// Loads the metadata file. If it fails, posts an error message and returns nothing.
  std::optional<ouster::Metadata> LoadMetadata();
  /// Uses `metadata` from now on. If it fails, posts an error message and returns false.
  bool SetMetadata(ouster::Metadata metadata);
  ouster::PacketVerdict Push(ByteView payload, const ouster::Arrival& arrival);
  void UpdateCounters();
  void End() { ended_ = true; }

  GstBaseSrc* element() const { return element_; }
  GstElement* gst_element() const { return GST_ELEMENT(element_); }
  const OusterSettings& settings() const { return settings_; }
  ouster::SensorStream* stream() const { return stream_.get(); }
  /// Returns 0 before the pipeline runs.
  GstClockTime RunningTime() const;

 private:
  Counters Total() const;
  void PushImu(ByteView packet);
  GstFlowReturn SendCaps();
  void PostLoss(const Counters& now);

  GstBaseSrc* const element_;
  const OusterSettings settings_;
  std::unique_ptr<ouster::SensorStream> stream_;
  ImuPad imu_;
  bool caps_pending_ = false;
  bool discont_ = false;
  bool ended_ = false;
  GstClockTime start_ = 0;  // slices that end before this time are dropped
  Counters base_;           // counters of earlier streams
  LossReport loss_report_;

  mutable std::mutex mutex_;  // guards all below; never held while waiting, pushing or posting
  Counters counters_;
  GstClockTime slice_duration_ = GST_CLOCK_TIME_NONE;
};

inline Time ToTime(GstClockTime time) { return Time(Duration(static_cast<gint64>(time))); }
inline Time UtcNow() { return Time(std::chrono::microseconds(g_get_real_time())); }

}  // namespace lidar::gst
