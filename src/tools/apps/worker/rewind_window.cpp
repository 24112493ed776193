// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/rewind_window.h"

namespace lidar::worker {
namespace {

constexpr std::size_t kMostMessages = 65'536;
/// The longest pause of a server. If the stored times of two messages differ by more than this
/// although their capture times hardly differ, the robot's clock has stopped.
constexpr std::uint64_t kLongestPauseNs = 60'000'000'000;

/// Returns `to` - `from`, or 0 if the clock was set back between them.
std::uint64_t Between(std::uint64_t from, std::uint64_t to) { return to < from ? 0 : to - from; }

}  // namespace

/// Returns true if the message is more than `rewind` older than the newest message. If capture
/// times are known, both the stored time and the capture time must be older. One of them does not
/// suffice, because the stored time jumps after a pause of the server, and the capture time jumps
/// if the robot's clock is set.
bool RewindWindow::IsOld(const Message& message) const {
  const Message& now = messages_.back();
  const std::uint64_t age_ns = Between(message.stored_ns, now.stored_ns);
  const bool captured_lately = message.captured_ns && now.captured_ns &&
                               *message.captured_ns <= *now.captured_ns &&
                               *now.captured_ns - *message.captured_ns <= rewind_ns_;
  return age_ns > rewind_ns_ && !(captured_lately && age_ns <= rewind_ns_ + kLongestPauseNs);
}

void RewindWindow::Add(const Message& message) {
  if (!messages_.empty() && message.number <= messages_.back().number) messages_.clear();
  messages_.push_back(message);
  while (messages_.size() > kMostMessages || IsOld(messages_.front())) messages_.pop_front();
}

}  // namespace lidar::worker
