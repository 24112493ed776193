// SPDX-License-Identifier: LGPL-2.1-or-later
// The two ends of a stream as pipelines. They compare the slices that the receiver gets with the
// slices that were sent.
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

/// The hashes of the slices that all senders of a test have sent most recently.
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

/// A pipeline. The destructor stops it.
class Pipeline {
 public:
  explicit Pipeline(const std::string& description);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void SetState(GstState state);
  /// Sends EOS, and waits until EOS has reached all sinks. Returns false if that takes longer than
  /// `limit`.
  bool Finish(std::chrono::milliseconds limit);
  bool AwaitEnd(std::chrono::milliseconds limit);
  /// Returns the number `name` of the property `stats` of an element. Returns a number with all
  /// bits set if there is no such number.
  std::uint64_t Stat(const char* element, const char* name) const;
  gst::ElementPtr Child(const char* name) const;
  /// Returns the text of the first error on the bus, or an empty text if there is no error.
  std::string Error() const;
  unsigned Messages(GstMessageType type) const;
  GstElement* get() const { return pipeline_.get(); }

 private:
  gst::ElementPtr pipeline_;
};

/// A sender with the pipeline: lidartestsrc ! dracoenc ! rtplidarpay ! screamsink
class SendingEnd {
 public:
  SendingEnd(SentSlices* sent, std::uint16_t port, const std::string& sink_options = "");
  Pipeline& pipeline() { return pipeline_; }
  std::uint64_t slices_sent() const { return pipeline_.Stat("pay", "slices-sent"); }
  /// Returns how many slices the sensor can have captured at most since this object was made. It
  /// captures 80 slices per second.
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

/// A receiver with the pipeline: screamsrc ! rtplidardepay ! dracodec ! fakesink
class ReceivingEnd {
 public:
  /// If `sent` is null, slices are not compared with sent slices, and foreign() remains 0.
  ReceivingEnd(const SentSlices* sent, std::uint16_t port, const std::string& source_options = "");
  Pipeline& pipeline() { return pipeline_; }
  Accounts accounts() const;
  /// clouds() returns the number of decoded clouds. foreign() returns the number of received slices
  /// that no sender has sent.
  std::uint64_t clouds() const { return clouds_; }
  std::uint64_t foreign() const { return foreign_; }
  /// Waits for the next cloud, and returns how long that took. Returns max() if it took longer than
  /// `limit`.
  std::chrono::milliseconds NextCloud(std::chrono::milliseconds limit) const;

 private:
  const SentSlices* sent_;
  std::atomic<std::uint64_t> clouds_{0};
  std::atomic<std::uint64_t> foreign_{0};
  Pipeline pipeline_;
};

/// Returns the memory that this process has allocated and not freed [bytes]. The resident memory
/// would not show a leak, because it grows for hours without one: each arena of malloc() keeps
/// freed memory.
std::uint64_t AllocatedBytes();
/// Returns the CPU time that this process has used.
std::chrono::milliseconds CpuTime();

}  // namespace lidar::test
