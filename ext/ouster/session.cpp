// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/session.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <utility>

#include "ext/ouster/file_session.h"
#include "ext/ouster/live_session.h"
#include "ext/ouster/slice_buffer.h"
#include "gst/common/latency.h"
#include "gst/common/refs.h"
#include "gst/common/source_caps.h"
#include "src/ouster/imu_packet.h"

#include "ext/ouster/debug.h"

namespace lidar::gst {
namespace {

// This is larger than a mask for the largest scan: a header, and 8 bits per pixel.
constexpr std::size_t kMaxMaskSize = 32U << 20;

/// Returns the content of the file, or nothing if it cannot be read. Stops reading once the text
/// has more than `max_size` bytes.
std::optional<std::string> ReadFile(const std::string& path, std::size_t max_size) {
  constexpr std::size_t kPiece = 1U << 16;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  while (file && text.size() <= max_size) {
    const std::size_t size = text.size();
    text.resize(size + kPiece);
    file.read(&text[size], kPiece);
    text.resize(size + static_cast<std::size_t>(file.gcount()));
  }
  // A folder can be opened, but not read: reading it sets bad(). The end of a file does not set
  // bad().
  if (!file.is_open() || file.bad()) return std::nullopt;
  return text;
}

using C = Counters;
using B = ouster::BatcherStats;
using D = ouster::StreamStats;  // counters of datagrams

}  // namespace

const std::array<Stat<Counters>, 17> kOusterStats = {{
    {"packets", At<&C::batcher, &B::packets>},
    {"packets-lost", At<&C::batcher, &B::lost_packets>},
    {"packets-late", At<&C::batcher, &B::late_packets>},
    {"packets-duplicate", At<&C::batcher, &B::duplicate_packets>},
    {"packets-stray", At<&C::batcher, &B::stray_packets>},
    {"packets-wrong-size", At<&C::stream, &D::wrong_size>},
    {"packets-foreign", At<&C::stream, &D::foreign>},
    {"packets-damaged", At<&C::stream, &D::damaged>},
    {"packets-imu", At<&C::stream, &D::imu_packets>},
    {"clock-jumps", At<&C::stream, &D::clock_jumps>},
    {"dropped-by-kernel", &C::kernel_drops},
    {"restarts", At<&C::batcher, &B::restarts>},
    {"reconnects", &C::reconnects},
    {"slices", At<&C::batcher, &B::slices>},
    {"slices-incomplete", At<&C::batcher, &B::incomplete_slices>},
    {"receive-buffer", &C::receive_buffer},
    {"clock-synchronised", &C::synchronised},
}};

std::shared_ptr<Session> Session::Create(GstBaseSrc* element, const OusterSettings& settings) {
  if (settings.from_file()) return std::make_shared<FileSession>(element, settings);
  return std::make_shared<LiveSession>(element, settings);
}

Session::Session(GstBaseSrc* element, OusterSettings settings)
    : element_(element), settings_(std::move(settings)), imu_(element) {}

std::optional<ouster::Metadata> Session::LoadMetadata() {
  const std::string path = settings_.MetadataPath();
  if (path.empty()) {
    GST_ELEMENT_ERROR(element_, RESOURCE, SETTINGS,
                      ("None of hostname, metadata and location is set."),
                      ("set hostname to the sensor, or metadata to what "
                       "'curl http://SENSOR/api/v1/sensor/metadata' prints"));
    return std::nullopt;
  }
  const auto text = ReadFile(path, ouster::Metadata::kMaxJsonSize);
  if (!text && settings_.from_file() && access(settings_.location.c_str(), R_OK) != 0) {
    GST_ELEMENT_ERROR(
        element_, RESOURCE, NOT_FOUND,
        ("Cannot read the capture %s: %s.", settings_.location.c_str(), g_strerror(errno)),
        (nullptr));
    return std::nullopt;
  }
  if (!text) {
    GST_ELEMENT_ERROR(element_, RESOURCE, NOT_FOUND, ("Cannot read the metadata %s.", path.c_str()),
                      ("set the property metadata to the sensor's JSON file"));
    return std::nullopt;
  }
  std::string why;
  auto metadata = ouster::ParseMetadata(*text, &why);
  if (!metadata)
    GST_ELEMENT_ERROR(
        element_, STREAM, WRONG_TYPE,
        ("%s is not the metadata of an Ouster sensor: %s.", path.c_str(), why.c_str()),
        ("'curl http://SENSOR/api/v1/sensor/metadata' prints the metadata of a sensor"));
  return metadata;
}

bool Session::SetMetadata(ouster::Metadata metadata) {
  std::string why;
  auto options = ToStreamOptions(settings_, &why);
  if (options && !settings_.mask_location.empty()) {
    const auto image = ReadFile(settings_.mask_location, kMaxMaskSize);
    if (image) {
      options->points.mask_image.assign(image->begin(), image->end());
    } else {
      why = "cannot read the mask " + settings_.mask_location;
      options.reset();
    }
  }
  auto next = options ? ouster::SensorStream::Create(std::move(metadata), *options, &why) : nullptr;
  if (!next) {
    GST_ELEMENT_ERROR(element_, RESOURCE, SETTINGS,
                      ("The settings cannot be used: %s.", why.c_str()), (nullptr));
    return false;
  }
  if (stream_) {
    base_ = Total();
    next->Continue(*stream_);
    discont_ = true;
  }
  stream_ = std::move(next);
  caps_pending_ = true;
  const auto duration = static_cast<GstClockTime>(stream_->slice_duration().count());
  std::unique_lock lock(mutex_);
  const bool changed = std::exchange(slice_duration_, duration) != duration;
  lock.unlock();
  if (changed) PostNewLatency(element_);
  return true;
}

ouster::PacketVerdict Session::Push(ByteView payload, const ouster::Arrival& arrival) {
  const auto verdict = stream_->Push(payload, arrival);
  if (verdict == ouster::PacketVerdict::kImu && settings_.imu && stream_->knows_time())
    PushImu(payload);
  return verdict;
}

void Session::PushImu(ByteView packet) {
  const auto packed = ouster::ParseImuPacket(packet, stream_->metadata());
  if (!packed || packed->empty()) return;
  std::vector<ImuSample> samples;
  for (const ouster::ImuSample& s : *packed) {
    ImuSample& sample = samples.emplace_back();
    sample.time = stream_->UtcOf(s.timestamp);
    std::copy(s.acceleration.begin(), s.acceleration.end(), sample.acceleration.begin());
    std::copy(s.angular_velocity.begin(), s.angular_velocity.end(),
              sample.angular_velocity.begin());
  }
  imu_.Push(samples, stream_->metadata().imu_to_sensor,
            ToClockTime(stream_->LocalOf(packed->front().timestamp)));
}

GstFlowReturn Session::SendCaps() {
  const CapsPtr caps(CapsOf(*stream_));
  const CapsPtr current(gst_pad_get_current_caps(GST_BASE_SRC_PAD(element_)));
  const bool is_known = current && gst_caps_is_equal(current.get(), caps.get());
  const GstFlowReturn flow = is_known ? GST_FLOW_OK : SetSourceCaps(element_, caps.get());
  caps_pending_ = flow != GST_FLOW_OK;
  return flow;
}

GstFlowReturn Session::Next(GstBuffer** out) {
  for (;;) {
    if (auto slice = stream_ ? stream_->Pop() : std::nullopt) {
      const Time end = slice->local + stream_->slice_duration();
      if (start_ > 0 && end <= ToTime(start_)) continue;
      const GstFlowReturn flow = caps_pending_ ? SendCaps() : GST_FLOW_OK;
      if (flow != GST_FLOW_OK) return flow;
      if (std::exchange(discont_, false)) slice->slice.after_gap = true;
      GST_LOG_OBJECT(element_,
                     "slice %u of scan %u leaves %" G_GINT64_FORMAT
                     " us after the packet that completed it",
                     slice->slice.index, slice->slice.scan_id,
                     static_cast<gint64>((UtcNow() - slice->completed).count() / 1000));
      *out = ToBuffer(*std::move(slice), stream_->slice_duration());
      return GST_FLOW_OK;
    }
    if (ended_) return GST_FLOW_EOS;
    const GstFlowReturn flow = Poll();
    if (flow != GST_FLOW_OK) return flow;
    UpdateCounters();
  }
}

GstClockTime Session::RunningTime() const {
  const std::unique_ptr<GstClock, Unref> clock(gst_element_get_clock(gst_element()));
  if (!clock) return 0;
  const GstClockTime now = gst_clock_get_time(clock.get());
  const GstClockTime base_time = gst_element_get_base_time(gst_element());
  return now > base_time ? now - base_time : 0;
}

/// Returns the sum of the counters of all streams so far.
Counters Session::Total() const {
  Counters now;
  now.batcher = stream_->batcher().stats();
  now.stream = stream_->stats();
  AddCounts(kOusterStats, base_, &now);
  return now;
}

void Session::UpdateCounters() {
  if (!stream_) return;
  Counters now = Total();
  now.synchronised = stream_->has_synchronised_clock();
  AddCounters(&now);
  {
    std::lock_guard lock(mutex_);
    counters_ = now;
  }
  PostLoss(now);
}

void Session::PostLoss(const Counters& now) {
  const guint64 total = now.batcher.lost_packets;
  const auto time = static_cast<GstClockTime>(g_get_monotonic_time()) * GST_USECOND;
  const auto lost = loss_report_.Take(total, time);
  if (!lost) return;
  gst_element_post_message(
      gst_element(),
      gst_message_new_element(GST_OBJECT(element_),
                              gst_structure_new("ouster-packet-loss", "lost", G_TYPE_UINT64, *lost,
                                                "total", G_TYPE_UINT64, total, "dropped-by-kernel",
                                                G_TYPE_UINT64, now.kernel_drops, nullptr)));
}

Counters Session::counters() const {
  std::lock_guard lock(mutex_);
  return counters_;
}

GstClockTime Session::slice_duration() const {
  std::lock_guard lock(mutex_);
  return slice_duration_;
}

}  // namespace lidar::gst
