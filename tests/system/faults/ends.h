// SPDX-License-Identifier: LGPL-2.1-or-later
// The two ends of a stream as pipelines. They keep what was sent and shown for comparison.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "gst/common/refs.h"

namespace lidar::test {

/// Hashes of the last slices that all senders of a test sent.
class SentSlices {
 public:
  void Add(std::uint32_t hash);
  bool Has(std::uint32_t hash) const;

 private:
  mutable std::mutex mutex_;
  std::multiset<std::uint32_t> hashes_;
  std::deque<std::uint32_t> order_;
};

std::uint32_t Hash(GstBuffer* buffer);

/// A pipeline that is stopped when it is destroyed.
class Pipeline {
 public:
  explicit Pipeline(const std::string& description);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void SetState(GstState state);
  /// Sends EOS and waits for its message. Returns false if that takes longer than `limit`.
  bool Finish(std::chrono::milliseconds limit);
  bool AwaitEnd(std::chrono::milliseconds limit);
  /// Returns a number of the property `stats` of an element; all bits are set if it lacks the
  /// number.
  std::uint64_t Stat(const char* element, const char* name) const;
  gst::ElementPtr Child(const char* name) const;
  /// The first error on the bus, or empty.
  std::string Error() const;
  unsigned Messages(GstMessageType type) const;
  GstElement* get() const { return pipeline_.get(); }

 private:
  gst::ElementPtr pipeline_;
};

/// lidartestsrc ! dracoenc ! rtplidarpay ! screamsink
class SendingEnd {
 public:
  SendingEnd(SentSlices* sent, std::uint16_t port, const std::string& sink_options = "");
  Pipeline& pipeline() { return pipeline_; }
  std::uint64_t slices_sent() const { return pipeline_.Stat("pay", "slices-sent"); }
  /// Returns the largest number of slices that the sensor can have captured: 80 a second.
  std::uint64_t slices_captured() const {
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - made_;
    return static_cast<std::uint64_t>(80 * time.count()) + 1;
  }

 private:
  std::chrono::steady_clock::time_point made_ = std::chrono::steady_clock::now();
  Pipeline pipeline_;
};

struct Accounts {
  std::uint64_t received = 0, lost = 0, damaged = 0, mismatch = 0, skipped = 0;
  std::uint64_t complete = 0, incomplete = 0, scans_lost = 0;
  std::uint64_t restarts = 0, outages = 0;
  std::uint64_t slices() const { return received + lost + damaged + mismatch; }
};

/// screamsrc ! rtplidardepay ! dracodec ! fakesink
class ReceivingEnd {
 public:
  /// Counts no slice as foreign if `sent` is null.
  ReceivingEnd(const SentSlices* sent, std::uint16_t port, const std::string& source_options = "");
  Pipeline& pipeline() { return pipeline_; }
  Accounts accounts() const;
  /// Decoded clouds so far, and slices that no sender sent.
  std::uint64_t clouds() const { return clouds_; }
  std::uint64_t foreign() const { return foreign_; }
  /// Time until the next cloud; max() if that takes longer than `limit`.
  std::chrono::milliseconds NextCloud(std::chrono::milliseconds limit) const;

 private:
  const SentSlices* sent_;
  std::atomic<std::uint64_t> clouds_{0};
  std::atomic<std::uint64_t> foreign_{0};
  Pipeline pipeline_;
};

/// Memory that this process has allocated [bytes]. The resident memory grows for hours, too, as
/// each arena of malloc() keeps what was freed.
std::uint64_t AllocatedBytes();
/// CPU time of this process.
std::chrono::milliseconds CpuTime();

}  // namespace lidar::test
