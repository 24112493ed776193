// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/queue.h"

namespace lidar::link {

void FifoQueue::Push(const Waiting& waiting) {
  waiting_.push_back(waiting);
  size_ += waiting.packet.size;
}

Leaving FifoQueue::Pop(Time now) {
  const Waiting head = waiting_.front();
  waiting_.pop_front();
  size_ -= head.packet.size;
  return {head, aqm_->OnDequeue(now, now - head.entered, head.packet)};
}

}  // namespace lidar::link
