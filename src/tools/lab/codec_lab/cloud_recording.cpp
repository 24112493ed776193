// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/cloud_recording.h"

#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "src/cdr/coded_slice.h"
#include "src/cdr/point_cloud2.h"
#include "src/cdr/ros_types.h"
#include "src/cloud/field_number.h"
#include "src/tools/lab/codec_lab/message_reader.h"

namespace lidar::tools {
namespace {

/// The duration of a scan if the stamps of the scans do not give it.
constexpr Duration kUsualPeriod = std::chrono::milliseconds(100);
constexpr Duration kLongestPeriod = std::chrono::seconds(1);
constexpr std::uint32_t kMostRings = 1024;
constexpr std::uint64_t kLatest_ns = INT64_MAX;

/// Returns the names of the topics that have messages of this type.
std::set<std::string> TopicsOf(const MessageReader& reader, std::string_view type) {
  std::set<std::string> topics;
  for (const RecordedTopic& topic : reader.Topics())
    if (topic.type == type) topics.insert(topic.name);
  return topics;
}

std::string Join(const std::set<std::string>& topics) {
  std::string text;
  for (const std::string& topic : topics) text += (text.empty() ? "" : ", ") + topic;
  return text;
}

std::string ChooseTopic(const std::string& path, const std::string& wanted,
                        const MessageReader& reader) {
  const auto clouds = TopicsOf(reader, cdr::InfoOf(cdr::RosType::kPointCloud2).name);
  const auto slices = TopicsOf(reader, cdr::CodedSlice::kName);
  if (clouds.empty() && !slices.empty())
    throw std::runtime_error(path + ": has coded slices, not clouds; decode them: " +
                             "gst-launch-1.0 -e mcapsrc location=" + path +
                             " ! lidardec ! scanassembler ! mcapsink location=clouds.mcap");
  if (clouds.empty()) throw std::runtime_error(path + ": no topic of PointCloud2 messages in it");
  if (wanted.empty() && clouds.size() == 1) return *clouds.begin();
  if (wanted.empty())
    throw std::runtime_error(
        path + ": has clouds on several topics; choose one as FILE,TOPIC: " + Join(clouds));
  if (clouds.count(wanted) > 0) return wanted;
  throw std::runtime_error(path + ": no clouds on " + wanted + "; there are clouds on " +
                           Join(clouds));
}

/// Reads one number of a converted point.
struct NumberAt {
  const PointField* field = nullptr;
  float Of(const std::uint8_t* point) const {
    return static_cast<float>(ReadNumber(point + field->offset, field->type));
  }
};

class Recording final : public ScanStream {
 public:
  Recording(std::string path, std::string topic, std::unique_ptr<MessageReader> reader)
      : ScanStream(1 / Seconds(kUsualPeriod)),
        path_(std::move(path)),
        topic_(std::move(topic)),
        reader_(std::move(reader)) {
    reader_->Select(topic_);
    next_ = ReadCloud();
    if (!next_)
      throw std::runtime_error(path_ + ": no cloud on " + topic_ +
                               (why_.empty() ? "" : " that can be read: " + why_));
    after_ = ReadCloud();
    UpdatePeriod();
    SetPeriod(period_);
  }

  std::optional<TimedScan> Next() override {
    if (!next_) return std::nullopt;
    UpdatePeriod();
    TimedScan timed = *std::exchange(next_, std::move(after_));
    timed.duration = period_;
    after_ = next_ ? ReadCloud() : std::nullopt;
    return timed;
  }

 private:
  /// Sets the period to the time from `next_` to `after_`. Keeps the old period if this time is so
  /// long that scans must be missing.
  void UpdatePeriod() {
    if (!next_ || !after_ || after_->start <= next_->start) return;
    const Duration period = after_->start - next_->start;
    const Duration longest = known_ ? period_ * 3 / 2 : kLongestPeriod;
    if (period > longest) return;
    period_ = period;
    known_ = true;
  }

  std::optional<TimedScan> ReadCloud() {
    while (const auto message = reader_->Next()) {
      const auto cloud = cdr::ReadPointCloud2(message->data, &why_);
      if (!cloud) continue;
      TimedScan timed;
      timed.start = cloud->header.stamp;
      if (timed.start < Time{}) {
        why_ = "a cloud is stamped before the year 1970";
        continue;
      }
      if (timed.start == Time{}) {
        if (message->log_time_ns > kLatest_ns) {
          why_ = "a cloud was logged after the year 2262";
          continue;
        }
        timed.start += Duration{static_cast<std::int64_t>(message->log_time_ns)};
      }
      if (TakePoints(*cloud, &timed.scan)) return timed;
    }
    return std::nullopt;
  }

  bool TakePoints(const cdr::PointCloud2& cloud, Scan* scan) {
    // Checks the claimed size before any memory is allocated for it.
    if (!cdr::RowStride(cloud)) {
      why_ = "the length of a cloud's data does not match its width and height";
      return false;
    }
    if (!converter_ || !(converter_->layout() == cloud.layout))
      converter_ = cdr::PointConverter::Make(cloud.layout, {}, &why_);
    if (!converter_) return false;
    const PointFields& fields = converter_->points().fields;
    if (!fields.Find("x") || !fields.Find("y") || !fields.Find("z")) {
      why_ = "a cloud has no fields x, y and z";
      return false;
    }
    bytes_.assign(converter_->size(), 0);
    if (!converter_->Convert(cloud, bytes_.data())) return false;
    AddPoints(cloud.layout.width, cloud.layout.height, scan);
    return true;
  }

  /// Adds the points of the converted cloud. In an organised cloud, each row belongs to one beam,
  /// and the columns were sampled one after the other.
  void AddPoints(std::uint32_t width, std::uint32_t height, Scan* scan) const {
    const PointFields& fields = converter_->points().fields;
    const NumberAt x{fields.Find("x")}, y{fields.Find("y")}, z{fields.Find("z")};
    const NumberAt intensity{fields.Find("intensity")}, ring{fields.Find("ring")};
    const bool organised = height > 1 && height <= kMostRings;
    const std::size_t step = converter_->points().point_step;
    for (std::size_t i = 0; i < std::size_t{width} * height; ++i) {
      const std::uint8_t* point = &bytes_[i * step];
      const float xyz[3] = {x.Of(point), y.Of(point), z.Of(point)};
      if (!std::isfinite(xyz[0]) || !std::isfinite(xyz[1]) || !std::isfinite(xyz[2])) continue;
      if (xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0) continue;
      scan->xyz.insert(scan->xyz.end(), xyz, xyz + 3);
      if (intensity.field != nullptr) scan->intensity.push_back(intensity.Of(point));
      if (organised) {
        scan->rings.push_back(static_cast<std::uint16_t>(i / width));
        scan->phases.push_back(static_cast<float>(i % width) / static_cast<float>(width));
      } else if (ring.field != nullptr) {
        const float number = ring.Of(point);
        const bool known = number >= 0 && number < static_cast<float>(kMostRings);
        scan->rings.push_back(known ? static_cast<std::uint16_t>(number) : std::uint16_t{0});
      }
    }
  }

  std::string path_;
  std::string topic_;
  std::unique_ptr<MessageReader> reader_;
  std::optional<cdr::PointConverter> converter_;
  std::vector<std::uint8_t> bytes_;
  std::string why_;  // why the last cloud could not be read
  Duration period_ = kUsualPeriod;
  bool known_ = false;
  std::optional<TimedScan> next_;
  std::optional<TimedScan> after_;
};

}  // namespace

std::unique_ptr<ScanStream> OpenRecording(const std::string& path, const std::string& topic) {
  auto reader = OpenMessages(path);
  const std::string chosen = ChooseTopic(path, topic, *reader);
  return std::make_unique<Recording>(path, chosen, std::move(reader));
}

}  // namespace lidar::tools
