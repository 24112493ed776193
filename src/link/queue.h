// SPDX-License-Identifier: LGPL-2.1-or-later
// Packets that wait for a link, and the order in which they leave.
#pragma once
#include <cstddef>
#include <deque>
#include <memory>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/link/aqm.h"
#include "src/link/packet.h"

namespace lidar::link {

struct Waiting {
  Packet packet;
  Time entered;
};

struct Leaving {
  Waiting waiting;
  Verdict verdict = Verdict::kPass;
};

class Queue {
 public:
  virtual ~Queue() = default;
  virtual void Push(const Waiting& waiting) = 0;
  /// Removes the next packet and returns it. The transmitter is free at `now`. The queue must not
  /// be empty.
  virtual Leaving Pop(Time now) = 0;
  /// Returns the arrival time of the oldest waiting packet, or Time::max() if the queue is empty.
  virtual Time Oldest() const = 0;
  virtual std::size_t packets() const = 0;
  virtual DataSize size() const = 0;

  bool empty() const { return packets() == 0; }
};

class FifoQueue final : public Queue {
 public:
  explicit FifoQueue(std::unique_ptr<Aqm> aqm) : aqm_(std::move(aqm)) {}
  void Push(const Waiting& waiting) override {
    waiting_.push_back(waiting);
    size_ += waiting.packet.size;
  }
  Leaving Pop(Time now) override {
    const Waiting head = waiting_.front();
    waiting_.pop_front();
    size_ -= head.packet.size;
    return {head, aqm_->OnDequeue(now, now - head.entered, head.packet)};
  }
  Time Oldest() const override { return waiting_.empty() ? Time::max() : waiting_.front().entered; }
  std::size_t packets() const override { return waiting_.size(); }
  DataSize size() const override { return size_; }

 private:
  std::unique_ptr<Aqm> aqm_;
  std::deque<Waiting> waiting_;
  DataSize size_;
};

}  // namespace lidar::link
