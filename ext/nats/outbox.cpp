// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/outbox.h"

#include <algorithm>
#include <utility>

namespace lidar::nats {

/// Returns the memory of a message, with an estimate for the headers and metas.
std::size_t Outbox::SizeOf(const Outgoing& item) {
  constexpr std::size_t kOverhead = 512;
  return gst_buffer_get_size(item.buffer.get()) + kOverhead;
}

/// Counts the memory of a message and of its format. A format can be larger than its messages,
/// which share it. It is therefore counted once, with the first message that has it.
void Outbox::Count(const Outgoing& item) {
  bytes_ += SizeOf(item);
  if (item.format && ++formats_[item.format] == 1) bytes_ += item.format->memory();
}

void Outbox::Uncount(const Outgoing& item) {
  bytes_ -= SizeOf(item);
  const auto format = formats_.find(item.format);
  if (format == formats_.end() || --format->second > 0) return;
  bytes_ -= item.format->memory();
  formats_.erase(format);
}

std::size_t Outbox::Push(Outgoing item) {
  Count(item);
  const std::uint64_t number = item.number;
  waiting_.emplace(number, std::move(item));
  std::size_t dropped = 0;
  for (; bytes_ > max_bytes_ && !waiting_.empty(); ++dropped) {
    Uncount(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
  }
  return dropped;
}

std::optional<Outgoing> Outbox::Take(Clock::time_point now) {
  if (waiting_.empty()) return std::nullopt;
  auto first = waiting_.extract(waiting_.begin());
  Outgoing& item = first.mapped();
  Outgoing copy{item.number, gst::BufferPtr(gst_buffer_ref(item.buffer.get())), item.format};
  in_flight_.emplace(copy.number, Sent{std::move(item), now});
  return copy;
}

bool Outbox::Remove(std::uint64_t number) {
  const auto found = in_flight_.find(number);
  if (found == in_flight_.end()) return false;
  Uncount(found->second.item);
  in_flight_.erase(found);
  return true;
}

std::size_t Outbox::Retry(std::uint64_t number) {
  const auto found = in_flight_.find(number);
  if (found == in_flight_.end()) return 0;
  waiting_.emplace(number, std::move(found->second.item));
  in_flight_.erase(found);
  return 1;
}

std::size_t Outbox::RetryAll() {
  const std::size_t count = in_flight_.size();
  while (!in_flight_.empty()) Retry(in_flight_.begin()->first);
  return count;
}

std::size_t Outbox::Clear() {
  const std::size_t count = waiting_.size() + in_flight_.size();
  waiting_.clear();
  in_flight_.clear();
  formats_.clear();
  bytes_ = 0;
  return count;
}

StreamFormat::Ptr Outbox::NextFormat() const {
  return waiting_.empty() ? nullptr : waiting_.begin()->second.format;
}

std::optional<Outbox::Clock::time_point> Outbox::OldestInFlight() const {
  const auto oldest =
      std::min_element(in_flight_.begin(), in_flight_.end(),
                       [](const auto& a, const auto& b) { return a.second.at < b.second.at; });
  if (oldest == in_flight_.end()) return std::nullopt;
  return oldest->second.at;
}

}  // namespace lidar::nats
