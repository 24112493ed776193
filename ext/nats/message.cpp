// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/message.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "ext/nats/stream_format.h"
#include "gst/common/buffer_map.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::nats {
namespace {

constexpr const char* kFormat = "Lidar-Caps";
constexpr const char* kPlace = "Lidar-Place";
constexpr const char* kCaptureTime = "Lidar-Capture-Time";
constexpr const char* kDuration = "Lidar-Duration";
constexpr const char* kSlice = "Lidar-Slice";
constexpr const char* kPose = "Lidar-Pose";
constexpr const char* kDiscont = "Lidar-Discont";
constexpr const char* kMessageId = "Nats-Msg-Id";  // JetStream stores one message per id

constexpr guint kMaxSlices = 4'096;
constexpr int kPoseNumbers = 29;         // 7 doubles, an integer and 21 floats
constexpr std::size_t kMaxHeader = 512;  // has room for the longest pose
constexpr std::size_t kMaxSubject = 200;

/// Writes numbers with blanks between them.
class NumberWriter {
 public:
  template <class T>
  NumberWriter& Add(T value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    if (!text_.empty()) text_ += ' ';
    text_.append(text, end);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : text_(text) {}

  template <class T>
  bool Get(T* value) {
    if (!first_) {
      if (text_.empty() || text_.front() != ' ') return false;
      text_.remove_prefix(1);
    }
    first_ = false;
    const auto result = std::from_chars(text_.data(), text_.data() + text_.size(), *value);
    if (result.ec != std::errc()) return false;
    text_.remove_prefix(static_cast<std::size_t>(result.ptr - text_.data()));
    return true;
  }
  bool done() const { return text_.empty(); }

 private:
  std::string_view text_;
  bool first_ = true;
};

/// A writer of the headers of a message. It writes no further headers after an error.
class HeaderWriter {
 public:
  explicit HeaderWriter(natsMsg* message) : message_(message) {}
  void Set(const char* name, const std::string& value) {
    if (status_ == NATS_OK) status_ = natsMsgHeader_Set(message_, name, value.c_str());
  }
  bool good() const { return status_ == NATS_OK; }

 private:
  natsMsg* message_;
  natsStatus status_ = NATS_OK;
};

/// Returns the finite float that is nearest to `v`. Returns the largest float for NaN, because a
/// variance that is NaN is unknown.
float ToFloat(double v) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(std::fmax(-kMost, std::fmin(v, kMost)));
}

void WriteMetas(GstBuffer* buffer, HeaderWriter* headers) {
  const GstClockTime capture_time = gst_lidar_buffer_get_capture_time(buffer);
  if (GST_CLOCK_TIME_IS_VALID(capture_time))
    headers->Set(kCaptureTime, NumberWriter().Add(capture_time).text());
  if (GST_BUFFER_DURATION_IS_VALID(buffer))
    headers->Set(kDuration, NumberWriter().Add(GST_BUFFER_DURATION(buffer)).text());
  GstLidarSlice s{};
  if (gst_lidar_buffer_get_slice(buffer, &s))
    headers->Set(kSlice, NumberWriter()
                             .Add(s.scan_id)
                             .Add(s.slice_index)
                             .Add(s.slice_count)
                             .Add(s.first_column)
                             .text());
  GstLidarPose pose{};
  if (gst_lidar_buffer_get_pose(buffer, &pose)) {
    NumberWriter w;
    for (const double v : pose.position) w.Add(v);
    for (const double v : pose.orientation) w.Add(v);
    w.Add(static_cast<guint>(pose.tracking));
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        w.Add(ToFloat(pose.covariance[row * 6 + column]));
    headers->Set(kPose, w.text());
  }
  if (GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_DISCONT)) headers->Set(kDiscont, "1");
}

/// Returns the value of a header. Returns nothing if the header is missing, and an empty text if
/// the value is too long.
std::optional<std::string_view> Header(natsMsg* message, const char* name) {
  const char* value = nullptr;
  if (natsMsgHeader_Get(message, name, &value) != NATS_OK || value == nullptr) return std::nullopt;
  const std::string_view text(value);
  return text.size() <= kMaxHeader ? text : std::string_view();
}

/// Reads the time in the header `name`, if the header exists. Returns false if the value is not a
/// time.
bool ReadTime(natsMsg* message, const char* name, GstClockTime* time) {
  const auto text = Header(message, name);
  if (!text) return true;
  NumberReader r(*text);
  return r.Get(time) && r.done() && *time <= static_cast<GstClockTime>(G_MAXINT64);
}

bool ReadSlice(natsMsg* message, GstBuffer* buffer) {
  const auto text = Header(message, kSlice);
  if (!text) return true;
  GstLidarSlice s{};
  NumberReader r(*text);
  if (!r.Get(&s.scan_id) || !r.Get(&s.slice_index) || !r.Get(&s.slice_count) ||
      !r.Get(&s.first_column) || !r.done() || s.slice_count > kMaxSlices ||
      s.slice_index >= s.slice_count)
    return false;
  gst_lidar_buffer_set_slice(buffer, &s);
  return true;
}

bool ReadPose(natsMsg* message, GstBuffer* buffer) {
  const auto text = Header(message, kPose);
  // Skips the pose of an older sender, which has another number of values. JetStream may still keep
  // its messages.
  if (!text || std::count(text->begin(), text->end(), ' ') != kPoseNumbers - 1) return true;
  GstLidarPose pose{};
  guint tracking = 0;
  NumberReader r(*text);
  for (double& v : pose.position)
    if (!r.Get(&v) || !std::isfinite(v)) return false;
  for (double& v : pose.orientation)
    if (!r.Get(&v) || !std::isfinite(v)) return false;
  if (!r.Get(&tracking) || tracking > GST_LIDAR_TRACKING_LOST) return false;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      float v = 0;
      if (!r.Get(&v) || !std::isfinite(v)) return false;
      pose.covariance[row * 6 + column] = pose.covariance[column * 6 + row] = double{v};
    }
  }
  if (!r.done()) return false;
  pose.tracking = static_cast<GstLidarTracking>(tracking);
  gst_lidar_buffer_set_pose(buffer, &pose);
  return true;
}

bool ReadPlace(natsMsg* message, Place* place) {
  const auto text = Header(message, kPlace);
  if (!text) return false;
  NumberReader r(*text);
  return r.Get(&place->run) && r.Get(&place->number) && r.done();
}

bool ReadMetas(natsMsg* message, GstBuffer* buffer) {
  GstClockTime capture_time = GST_CLOCK_TIME_NONE;
  GstClockTime duration = GST_CLOCK_TIME_NONE;
  if (!ReadTime(message, kCaptureTime, &capture_time) || !ReadTime(message, kDuration, &duration) ||
      !ReadSlice(message, buffer) || !ReadPose(message, buffer))
    return false;
  if (GST_CLOCK_TIME_IS_VALID(capture_time))
    gst_lidar_buffer_set_capture_time(buffer, capture_time);
  GST_BUFFER_DURATION(buffer) = duration;
  if (Header(message, kDiscont)) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);
  return true;
}

}  // namespace

std::string ConfigSubject(const std::string& subject, const std::string& format_id) {
  return subject + ".config." + format_id;
}

std::string AskSubject(const std::string& subject) { return subject + ".get-config"; }

std::string CheckSubject(const std::string& subject) {
  if (subject.empty() || subject.size() > kMaxSubject) return "it is empty or too long";
  if (subject.front() == '.' || subject.back() == '.' || subject.find("..") != std::string::npos)
    return "it begins or ends with a dot, or has two dots in a row";
  const auto is_bad = [](char c) { return c <= ' ' || c > '~' || c == '*' || c == '>'; };
  if (std::any_of(subject.begin(), subject.end(), is_bad))
    return "it has a blank, a wildcard or a character that is not ASCII";
  if (subject.front() == '$' || subject.front() == '_')
    return "names that begin with $ or _ belong to the server";
  return "";
}

std::string PlaceText(const Place& place) {
  return NumberWriter().Add(place.run).Add(place.number).text();
}

MessagePtr WriteMessage(const std::string& subject, const char* reply, const std::string& format_id,
                        const Place& place, GstBuffer* buffer) {
  const gst::BufferMap map(buffer, GST_MAP_READ);
  if (!map || map.size() > G_MAXINT) return nullptr;
  natsMsg* raw = nullptr;
  if (natsMsg_Create(&raw, subject.c_str(), reply, reinterpret_cast<const char*>(map.data()),
                     static_cast<int>(map.size())) != NATS_OK)
    return nullptr;
  MessagePtr message(raw);
  HeaderWriter headers(raw);
  headers.Set(kFormat, format_id);
  headers.Set(kPlace, PlaceText(place));
  if (reply != nullptr) headers.Set(kMessageId, PlaceText(place));
  WriteMetas(buffer, &headers);
  return headers.good() ? std::move(message) : nullptr;
}

std::optional<ReadMessage> Read(natsMsg* message) {
  ReadMessage read;
  const auto format_id = Header(message, kFormat);
  const int size = natsMsg_GetDataLength(message);
  if (!format_id || size <= 0 || !ReadPlace(message, &read.place)) return std::nullopt;
  read.format_id = *format_id;
  if (!IsFormatId(read.format_id)) return std::nullopt;
  read.buffer.reset(gst_buffer_new_memdup(natsMsg_GetData(message), static_cast<gsize>(size)));
  if (!ReadMetas(message, read.buffer.get())) return std::nullopt;
  return read;
}

}  // namespace lidar::nats
