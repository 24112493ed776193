// SPDX-License-Identifier: LGPL-2.1-or-later
// A session that reads a capture file, at full speed or at the speed of the capture.
#pragma once
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "ext/ouster/capture_timeline.h"
#include "ext/ouster/pcap_feed.h"
#include "ext/ouster/session.h"

namespace lidar::gst {

class FileSession : public Session {
 public:
  FileSession(GstBaseSrc* element, const OusterSettings& settings) : Session(element, settings) {}

  bool Open() override;
  void Unlock() override;
  void UnlockStop() override;
  void Resume() override { utc_offset_ = UtcNow() - ToTime(RunningTime()); }
  bool seekable() const override { return !settings().is_live && !settings().loop; }
  void Seek(const GstSegment& segment) override;
  std::optional<GstClockTime> duration() override;

 protected:
  GstFlowReturn Poll() override;

 private:
  GstFlowReturn GoToTarget();
  bool IsBeforeTarget(const PcapFeed::Packet& packet) const;
  GstFlowReturn Take(const PcapFeed::Packet& packet);
  bool WaitUntil(GstClockTime running_time);
  GstFlowReturn EndOfCapture();
  void WarnIfCutShort();

  std::unique_ptr<PcapFeed> pcap_;
  std::optional<CaptureTimeline> timeline_;
  bool begun_ = false;           // true once a packet was read
  std::optional<Time> target_;   // time of a pending seek
  std::optional<Time> skip_to_;  // packets sampled before this time are dropped
  bool restart_reported_ = false;
  bool cut_reported_ = false;
  GstClockTime pace_start_ = GST_CLOCK_TIME_NONE;  // running time of the capture's first packet
  Duration taken_utc_offset_{0};                   // UTC offset that the packets so far have used
  // The offset from running time to UTC, measured when the pipeline last began to play.
  std::atomic<Duration> utc_offset_{Duration{0}};

  std::mutex wait_mutex_;  // guards all members below
  GstClockID wait_ = nullptr;
  bool flushing_ = false;
};

}  // namespace lidar::gst
