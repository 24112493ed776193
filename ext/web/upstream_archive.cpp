// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/upstream_archive.h"

#include <utility>

#include "ext/web/poses.h"
#include "gst/common/buffer_map.h"

namespace lidar::web {
namespace {

constexpr guint64 kAnswer = 512U << 10;  // bytes
constexpr const char* kNoAnswer = "the server that keeps it does not answer";

/// Returns the pose of the buffer as a message, or null if the buffer has no pose.
std::shared_ptr<SliceMessage> ReadPose(GstBuffer* buffer, std::uint64_t unix_ns,
                                       const std::string& child) {
  GstLidarPose meta;
  if (!gst_lidar_buffer_get_pose(buffer, &meta)) return nullptr;
  return PoseMessage({unix_ns, kFixedFrame}, child, PoseOf(meta));
}

/// Returns the slice in the buffer, or null if the slice is damaged.
std::shared_ptr<SliceMessage> ReadSlice(GstBuffer* buffer, std::uint64_t unix_ns, bool has_ranges) {
  const gst::BufferMap map(buffer, GST_MAP_READ);
  if (!map || map.size() == 0) return nullptr;
  GstLidarSlice place;
  gst_lidar_buffer_get_slice(buffer, &place);
  auto slice = std::make_shared<SliceMessage>();
  slice->id = {place.scan_id, place.slice_index};
  slice->count = place.slice_count;
  slice->first_column = place.first_column;
  slice->unix_ns = unix_ns;
  slice->payload.assign(map.data(), map.data() + map.size());
  return slice->ReadLinks(has_ranges) ? slice : nullptr;
}

}  // namespace

bool UpstreamArchive::IsThere(const Ask& ask) {
  const gst::QueryPtr query = gst::NewHistoryQuery({});
  return ask && ask(query.get());
}

bool UpstreamArchive::Answers(GstQuery* query, gst::HistoryAnswer* answer) const {
  if (!ask_(query)) return false;
  *answer = gst::ParseHistoryAnswer(query);
  return !answer->unanswered;
}

std::optional<Archive::Times> UpstreamArchive::Look(std::string* why) {
  const gst::QueryPtr query = gst::NewHistoryQuery({});
  *why = kNoAnswer;
  gst::HistoryAnswer answer;
  if (!Answers(query.get(), &answer)) return std::nullopt;
  *why = answer.to == 0 ? "it is empty" : "";
  if (answer.to == 0) return std::nullopt;
  return Times{answer.from, answer.to};
}

void UpstreamArchive::Seek(std::uint64_t time_ns) {
  items_.clear();
  question_ = {time_ns, 0, kAnswer};
  from_ns_ = time_ns;
  ended_ = false;
}

void UpstreamArchive::GoOn(std::uint64_t position) {
  items_.clear();
  question_ = {GST_CLOCK_TIME_NONE, position, kAnswer};
  from_ns_ = 0;
  ended_ = false;
}

std::optional<Archive::Item> UpstreamArchive::Next() {
  while (items_.empty()) {
    if (ended_ || cancelled_) return std::nullopt;
    Read();
  }
  Item item = std::move(items_.front());
  items_.pop_front();
  return item;
}

void UpstreamArchive::Read() {
  const gst::QueryPtr query = gst::NewHistoryQuery(question_);
  gst::HistoryAnswer answer;
  ended_ = true;
  error_ = kNoAnswer;
  if (!Answers(query.get(), &answer)) return;
  error_.clear();
  damaged_ += answer.damaged;
  ended_ = answer.ended;
  question_ = {GST_CLOCK_TIME_NONE, answer.position, kAnswer};
  for (const gst::SamplePtr& sample : answer.samples) Take(sample.get());
}

void UpstreamArchive::Take(GstSample* sample) {
  GstBuffer* buffer = gst_sample_get_buffer(sample);
  GstCaps* caps = gst_sample_get_caps(sample);
  Item item;
  item.time_ns = gst_lidar_buffer_get_capture_time(buffer);
  item.position = GST_BUFFER_OFFSET(buffer) + 1;
  if (item.time_ns < from_ns_ || !IsOurs(caps)) {
    items_.push_back(std::move(item));
    return;
  }
  // The position of the pose is the buffer itself. If a piece ends with the pose, the next piece
  // therefore begins with the slice of the same buffer.
  Item pose = item;
  pose.position = GST_BUFFER_OFFSET(buffer);
  pose.slice = ReadPose(buffer, item.time_ns, frame_id_);
  if (pose.slice) items_.push_back(std::move(pose));
  item.read = gst_buffer_get_size(buffer);
  item.slice = ReadSlice(buffer, item.time_ns, caps_.about.has_ranges);
  item.is_damaged = !item.slice;
  items_.push_back(std::move(item));
}

bool UpstreamArchive::IsOurs(GstCaps* caps) {
  if (known_caps_.get() == caps) return are_ours_;
  std::string why;
  const auto parsed = SliceCaps::Parse(caps, &why);
  known_caps_.reset(gst_caps_ref(caps));
  are_ours_ = parsed && parsed->HasSameDecoder(caps_);
  return are_ours_;
}

}  // namespace lidar::web
