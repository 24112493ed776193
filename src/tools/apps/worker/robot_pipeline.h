// SPDX-License-Identifier: LGPL-2.1-or-later
// The pipeline that follows one robot. It decodes the robot's slices from JetStream, computes the
// poses by odometry, and sends the poses to NATS.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <cstdint>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ext/nats/connection.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/time.h"
#include "src/tools/apps/fleet/exposition.h"
#include "src/tools/apps/worker/lease_record.h"
#include "src/tools/apps/worker/rewind_window.h"

namespace lidar::worker {

struct PipelineSettings {
  nats::ConnectionSettings connection;
  std::string prefix = "fleet";
  std::string stream = "fleet";
  std::string decoder = "lidardec";
  /// Properties of lidarodometry, as pairs of name and value.
  std::vector<std::pair<std::string, std::string>> odometry;
  /// The duration of the part of the stream that a decoder must read before a slice. This is the
  /// robot's key-interval.
  Duration rewind = std::chrono::milliseconds(1'200);
};

class RobotPipeline {
 public:
  /// `robot` is "robot.sensor", and `stream` is the creation time of its JetStream stream. If
  /// `begin` belongs to another stream, only its pose is used. Throws std::runtime_error if an
  /// element is missing or refuses a setting.
  RobotPipeline(const PipelineSettings& settings, const std::string& robot, std::uint64_t stream,
                const std::optional<Progress>& begin);
  /// Waits until Play() has completed, which may take seconds if the network is gone.
  ~RobotPipeline();
  RobotPipeline(const RobotPipeline&) = delete;
  RobotPipeline& operator=(const RobotPipeline&) = delete;

  /// Starts the pipeline in a thread of its own, because elements wait for servers.
  void Play();
  /// Sets the end of the lease. No pose is sent after `end`, even if the thread that ends the
  /// pipeline hangs.
  void SetEnd(Time end) { end_ = end.time_since_epoch().count(); }
  std::uint64_t stream() const { return stream_; }
  /// Returns the progress from which the pipeline began.
  const std::optional<Progress>& begin() const { return begin_; }
  /// Returns true if the pipeline waits for a message after `last`, which was the newest message of
  /// the stream at the time `asked_at`. Then the record is wrong.
  bool IsAheadOf(std::uint64_t last, Time asked_at) const {
    return begin_scan_ > last && asked_at > made_at_;
  }
  /// Returns true if the pipeline has dropped a pose because the lease had ended (see SetEnd()).
  bool has_dropped() const { return dropped_; }
  /// Returns the progress up to the newest pose, or nothing before the first pose.
  std::optional<Progress> progress() const;
  /// Adds the statistics of the elements, as fleet::AddStats() does. Does not wait.
  void AddStats(const std::string& labels, fleet::Exposition* exposition,
                nlohmann::json* report) const;
  /// Prints the pipeline's warnings. Returns the error that has ended the pipeline, or an empty
  /// text.
  std::string Poll();

 private:
  /// A scan whose pose lidarodometry has not sent yet.
  struct Scan {
    guint id = 0;
    guint next_index = 0;
    std::uint64_t first = 0;  // message numbers in the stream, as in Progress
    std::uint64_t from = 0;
  };

  void Watch(GstElement* element, const char* pad,
             GstPadProbeReturn (RobotPipeline::*on_buffer)(GstBuffer*));
  GstPadProbeReturn OnMessage(GstBuffer* buffer);
  GstPadProbeReturn OnCloud(GstBuffer* buffer);
  GstPadProbeReturn OnPose(GstBuffer* buffer);
  void NoteLateBegin(GstClockTime captured);

  const Time made_at_;
  const std::uint64_t stream_;
  const std::optional<Progress> begin_;
  // The number of the first message of the scan of `begin_`. If it is 0, begins with new messages.
  const std::uint64_t begin_scan_;
  const std::string decoder_;
  gst::ElementPtr pipeline_;
  std::future<void> start_;
  std::atomic<std::int64_t> end_{0};
  std::atomic<bool> dropped_{false};
  std::atomic<std::uint64_t> late_ns_{0};  // time from the record's pose to the first scan [ns]

  // Only the streaming thread uses the following members.
  std::uint64_t number_ = 0;  // number of the message in the pipeline
  RewindWindow window_;       // its newest message is number_
  bool begun_ = false;
  bool begun_late_ = false;  // the first scan came after the scan of the record's pose
  std::optional<Scan> open_;
  std::optional<Scan> closed_;  // complete, but its pose has not arrived yet

  mutable std::mutex mutex_;  // guards progress_
  std::optional<Progress> progress_;
};

}  // namespace lidar::worker
