// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/capture_timeline.h"

#include <utility>

namespace lidar::gst {

bool CaptureTimeline::ReadUntil(Duration time) {
  if (!index_) {
    std::string why;
    auto reader = ouster::PcapReader::Open(path_, &why);
    if (!reader) return false;
    index_.emplace(std::move(reader));
  }
  return index_->ReadUntil(time, [this] { return !cancelled_; });
}

std::optional<GstClockTime> CaptureTimeline::duration() {
  const std::lock_guard lock(mutex_);
  if (!ReadUntil(Duration::max()) || !index_->first()) return std::nullopt;
  return static_cast<GstClockTime>((index_->duration() + packet_interval_).count());
}

std::optional<CaptureTimeline::Place> CaptureTimeline::Find(Duration time) {
  const std::lock_guard lock(mutex_);
  if (!ReadUntil(time) || !index_->first()) return std::nullopt;
  return Place{*index_->first(), index_->OffsetBefore(time)};
}

}  // namespace lidar::gst
