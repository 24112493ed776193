// SPDX-License-Identifier: LGPL-2.1-or-later
// The work for one robot: decodes its slices from JetStream, follows them with odometry, and sends
// poses to NATS.
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
  /// Properties of lidarodometry: name and value.
  std::vector<std::pair<std::string, std::string>> odometry;
  /// Part of the stream that a decoder must read before a slice: the robot's key-interval.
  Duration rewind = std::chrono::milliseconds(1'200);
};

class RobotPipeline {
 public:
  /// `robot` is "robot.sensor", `stream` the creation time of its JetStream stream. A `begin` of
  /// another stream gives only its pose. Throws std::runtime_error if an element is missing or
  /// refuses a setting.
  RobotPipeline(const PipelineSettings& settings, const std::string& robot, std::uint64_t stream,
                const std::optional<Progress>& begin);
  /// Waits for a start that is under way, which may take seconds if the network is gone.
  ~RobotPipeline();
  RobotPipeline(const RobotPipeline&) = delete;
  RobotPipeline& operator=(const RobotPipeline&) = delete;

  /// Starts in a thread of its own, as elements wait for servers.
  void Play();
  /// Poses go out only before this time, even if the thread that ends the pipeline hangs.
  void SetEnd(Time end) { end_ = end.time_since_epoch().count(); }
  std::uint64_t stream() const { return stream_; }
  /// Returns the progress from which it began.
  const std::optional<Progress>& begin() const { return begin_; }
  /// Returns true if the pipeline begins after `last`, the stream's newest message at `asked_at`.
  /// Then the record is wrong.
  bool IsAheadOf(std::uint64_t last, Time asked_at) const {
    return begin_scan_ > last && asked_at > made_at_;
  }
  /// Returns true once it has dropped a pose, because the time of SetEnd() had passed.
  bool has_dropped() const { return dropped_; }
  /// Returns nothing before the first pose.
  std::optional<Progress> progress() const;
  /// Adds the statistics of its elements, as fleet::AddStats() does. Does not wait.
  void AddStats(const std::string& labels, fleet::Exposition* exposition,
                nlohmann::json* report) const;
  /// Returns the error that has ended the pipeline, or an empty text. Prints warnings.
  std::string Poll();

 private:
  /// A scan that lidarodometry has not aligned yet.
  struct Scan {
    guint id = 0;
    guint next_index = 0;
    std::uint64_t first = 0;  // numbers in the stream, as in Progress
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
  const std::uint64_t begin_scan_;  // 0: begin with new messages
  const std::string decoder_;
  gst::ElementPtr pipeline_;
  std::future<void> start_;
  std::atomic<std::int64_t> end_{0};
  std::atomic<bool> dropped_{false};
  std::atomic<std::uint64_t> late_ns_{0};  // from the record's pose to the first scan [ns]

  // Only the streaming thread uses what follows.
  std::uint64_t number_ = 0;  // of the message in the pipeline
  RewindWindow window_;       // its last message is number_
  bool begun_ = false;
  bool begun_late_ = false;  // began after the scan of the record's pose
  std::optional<Scan> open_;
  std::optional<Scan> closed_;  // waits for its pose

  mutable std::mutex mutex_;  // guards progress_
  std::optional<Progress> progress_;
};

}  // namespace lidar::worker
