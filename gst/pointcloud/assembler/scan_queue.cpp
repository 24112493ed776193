// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/assembler/scan_queue.h"

#include "src/base/sequence.h"

namespace lidar::gst {
namespace {

constexpr std::size_t kMaxOpen = 2;
// If the id of a scan is this far below the newest id, the sender has restarted, because no network
// reorders scans by so much.
constexpr int kRestart = 16;

}  // namespace

ScanQueue::Open* ScanQueue::Find(const SliceView& slice) {
  for (Open& open : open_)
    if (open.builder.Fits(slice)) return &open;
  return nullptr;
}

/// Compares the scan with the scans that are open or finished. If the sender has restarted,
/// finishes all open scans.
ScanQueue::Age ScanQueue::AgeOf(guint scan_id, Finished* finished) {
  const auto newest = open_.empty() ? newest_left_ : open_.back().builder.scan_id();
  if (!newest) return Age::kNew;
  const int distance = SequenceDistance(scan_id, *newest);
  if (distance > 0) return Age::kNew;
  if (distance == 0 && !open_.empty()) return Age::kRecut;
  if (distance > -kRestart) return Age::kLate;
  FinishAll(finished);
  newest_left_.reset();
  return Age::kNew;
}

ScanQueue::Open* ScanQueue::MakeRoomAndOpen(const SliceView& slice, GstClockTime deadline,
                                            Finished* finished) {
  while (open_.size() >= kMaxOpen ||
         (!open_.empty() && !GST_CLOCK_TIME_IS_VALID(open_.front().deadline)))
    FinishFront(finished);
  open_.push_back({ScanBuilder(slice), deadline});
  return &open_.back();
}

void ScanQueue::Add(const SliceView& slice, GstClockTime deadline, Finished* finished) {
  if (!ScanBuilder::IsSane(slice)) {
    ++counters_.invalid;
    return;
  }
  Open* open = Find(slice);
  if (open == nullptr) {
    const Age age = AgeOf(slice.meta.scan_id, finished);
    if (age != Age::kNew) {
      ++(age == Age::kLate ? counters_.late : counters_.invalid);
      return;
    }
    open = MakeRoomAndOpen(slice, deadline, finished);
  }
  if (!open->builder.Add(slice)) {
    ++counters_.duplicates;
    return;
  }
  if (!open->builder.complete()) return;
  const guint id = open->builder.scan_id();
  // Once a newer scan is complete, older scans no longer wait for their missing slices.
  while (newest_left_ != id) FinishFront(finished);
}

void ScanQueue::FinishFront(Finished* finished) {
  ScanBuilder& front = open_.front().builder;
  newest_left_ = front.scan_id();
  ++counters_.scans;
  counters_.incomplete += front.complete() ? 0U : 1U;
  finished->push_back(front.Finish());
  open_.pop_front();
}

void ScanQueue::FinishDue(GstClockTime now, Finished* finished) {
  while (!open_.empty() && GST_CLOCK_TIME_IS_VALID(open_.front().deadline) &&
         open_.front().deadline <= now) {
    FinishFront(finished);
  }
}

void ScanQueue::FinishAll(Finished* finished) {
  while (!open_.empty()) FinishFront(finished);
}

void ScanQueue::Clear() {
  open_.clear();
  newest_left_.reset();
}

GstClockTime ScanQueue::NextDeadline() const {
  return open_.empty() ? GST_CLOCK_TIME_NONE : open_.front().deadline;
}

}  // namespace lidar::gst
