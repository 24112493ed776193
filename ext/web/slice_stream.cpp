// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/slice_stream.h"

#include <pthread.h>

#include <optional>
#include <system_error>

#include "ext/web/file_archive.h"
#include "ext/web/recording.h"
#include "src/codec/cloud/exact_decoder.h"
#include "src/codec/slice_decoder.h"
#include "src/foxglove/messages.h"
#include "src/viewer/recoder.h"

namespace lidar::web {
namespace {

/// This is enough for 30 s at 4 Mbit/s.
constexpr std::size_t kMostWaiting = 16U << 20;
/// Decoding continues for this time after a viewer last needed it, because a viewer often needs it
/// again.
constexpr gint64 kLinger_us = 15 * gint64{G_USEC_PER_SEC};
constexpr std::uint32_t kMostPoints = 1U << 20;

codec::CloudFormat FormatOf(const gst::CloudInfo& info) {
  return {{info.fields, info.point_step}, info.height, info.sensor_model};
}

}  // namespace

/// The decoder and the encoder of the stream.
class SliceStream::Decoding {
 public:
  Decoding(const gst::CloudInfo& info, bool has_ranges) : format_(FormatOf(info)) {
    if (!has_ranges) {
      cloud_.emplace(codec::ExactFields(info.fields), kMostPoints);
      return;
    }
    slices_.emplace(format_, kMostPoints);
    recoder_ = viewer::Recoder::Create(format_);
  }

  /// Decodes a slice. Returns false if that is impossible.
  bool Decode(const SliceMessage& slice) {
    const ByteView bytes{slice.payload.data(), slice.payload.size()};
    if (cloud_) {
      if (!cloud_->Decode(bytes)) return false;
      shape_ = {static_cast<std::uint32_t>(cloud_->size()), 1, 0, true};
    } else {
      const auto shape = slices_->Decode(bytes);
      if (!shape) return false;
      shape_ = *shape;
    }
    coded_size_ = bytes.size;
    points_.resize(std::size_t{shape_.width} * shape_.height * format_.layout.point_step);
    if (cloud_)
      cloud_->Write(format_.layout, points_.data());
    else
      slices_->Write(points_.data());
    return true;
  }
  bool lacks_reference() const { return slices_ && slices_->lacks_reference(); }

  /// Encodes the last decoded slice.
  foxglove::EncodedCloud Cloud(const foxglove::Header& header, guint max_points) const {
    return foxglove::EncodePointCloud(header,
                                      {format_.layout.fields,
                                       format_.layout.point_step,
                                       shape_.width,
                                       shape_.height,
                                       {points_.data(), points_.size()}},
                                      max_points);
  }
  bool Recode(std::vector<std::uint8_t>* out) {
    return recoder_ &&
           recoder_->Encode(
               {{points_.data(), points_.size()}, shape_, slices_->quality(), coded_size_}, out);
  }

 private:
  const codec::CloudFormat format_;
  std::optional<codec::SliceDecoder> slices_;
  std::optional<codec::cloud::ExactDecoder> cloud_;
  std::optional<viewer::Recoder> recoder_;
  codec::SliceDecoder::Shape shape_;
  std::size_t coded_size_ = 0;
  std::vector<std::uint8_t> points_;
};

SliceStream::SliceStream(Server* server, Settings settings, Counters counters)
    : server_(server),
      settings_(std::move(settings)),
      counters_(counters),
      backlog_(kMostWaiting) {}

std::unique_ptr<SliceStream> SliceStream::Open(Server* server, const GstCaps* caps,
                                               Settings settings, Counters counters,
                                               std::string* why) {
  const auto parsed = SliceCaps::Parse(caps, why);
  if (!parsed) return nullptr;
  std::unique_ptr<SliceStream> stream(new SliceStream(server, std::move(settings), counters));
  if (!stream->OpenTopics(*parsed, why)) return nullptr;
  stream->decoding_ = std::make_unique<Decoding>(parsed->info, stream->has_ranges_);
  try {
    stream->thread_ = std::thread([self = stream.get()] { self->Run(); });
  } catch (const std::system_error& e) {
    *why = e.what();
    return nullptr;
  }
  for (const SharedTopic& topic : {stream->slices_, stream->clouds_})
    topic->set_on_wish([self = stream.get()] { self->Wake(); });
  return stream;
}

bool SliceStream::OpenTopics(SliceCaps caps, std::string* why) {
  foxglove::SliceStreamInfo about = caps.about;
  has_ranges_ = about.has_ranges;
  about.frame_id = settings_.frame_id;
  about.clouds = settings_.topic;
  std::shared_ptr<Recording> recording;
  if (auto archive = MakeArchive(std::move(caps)))
    recording = std::make_shared<Recording>(std::move(archive));
  about.recording = recording != nullptr;
  clouds_ = server_->Open(settings_.topic, foxglove::Schema::kPointCloud);
  if (clouds_)
    slices_ = server_->Open(settings_.topic + kSlicesEnding, foxglove::Schema::kSlice,
                            foxglove::DescribeSlices(about), std::move(recording));
  if (slices_) return true;
  *why = TopicInUse(settings_.topic + (clouds_ ? kSlicesEnding : ""));
  return false;
}

/// Returns the archive for replays, or null if the stream has neither a recording nor a history.
std::unique_ptr<Archive> SliceStream::MakeArchive(SliceCaps caps) const {
  if (!settings_.recording.empty())
    return std::make_unique<FileArchive>(settings_.recording, std::move(caps));
  if (!UpstreamArchive::IsThere(settings_.ask_upstream)) return nullptr;
  return std::make_unique<UpstreamArchive>(settings_.ask_upstream, std::move(caps),
                                           settings_.frame_id);
}

SliceStream::~SliceStream() {
  for (const SharedTopic& topic : {slices_, clouds_})
    if (topic) topic->set_on_wish(nullptr);
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  change_.notify_one();
  if (thread_.joinable()) thread_.join();
  for (const SharedTopic& topic : {slices_, clouds_})
    if (topic) server_->Close(topic);
}

bool SliceStream::Push(SliceMessage slice) {
  if (!slice.ReadLinks(has_ranges_)) return false;
  clouds_->set_depth(std::min<std::size_t>(slice.count, 64));
  const auto shared = std::make_shared<const SliceMessage>(std::move(slice));
  server_->PublishSlice(slices_, shared);
  {
    const std::lock_guard lock(mutex_);
    backlog_.Push(shared);
  }
  change_.notify_one();
  return true;
}

void SliceStream::Wake() {
  // The lock ensures that the thread is not between its check and its sleep, where it would miss
  // the wake-up.
  const std::lock_guard lock(mutex_);
  change_.notify_one();
}

bool SliceStream::IsWanted() {
  const gint64 now_us = g_get_monotonic_time();
  if (slices_->wants_recoded()) recoded_wanted_us_ = now_us;
  recodes_ = recoded_wanted_us_ != 0 && now_us - recoded_wanted_us_ < kLinger_us;
  return recodes_ || clouds_->wanted() || backlog_.is_full();
}

void SliceStream::Run() {
  pthread_setname_np(pthread_self(), "foxglove-slices");
  codec::PrepareMixing();
  for (;;) {
    viewer::SharedSlice next;
    bool is_recent = false;
    bool recodes = false;
    {
      std::unique_lock lock(mutex_);
      change_.wait(lock, [this] { return stopping_ || (!backlog_.empty() && IsWanted()); });
      if (stopping_) return;
      next = backlog_.Pop();
      is_recent = backlog_.IsRecent(*next);
      recodes = recodes_;
    }
    if (!decoding_->Decode(static_cast<const SliceMessage&>(*next))) {
      if (!decoding_->lacks_reference()) ++counters_.malformed;
    } else if (is_recent) {
      Publish(static_cast<const SliceMessage&>(*next), recodes);
    }
  }
}

/// Publishes the decoded slice in all forms to which clients have subscribed.
void SliceStream::Publish(const SliceMessage& slice, bool recodes) {
  if (clouds_->wanted()) {
    auto cloud = decoding_->Cloud({slice.unix_ns, settings_.frame_id}, settings_.max_points);
    counters_.points += cloud.points;
    server_->Publish(clouds_, {slice.unix_ns, std::move(cloud.message)});
  }
  if (!recodes) return;
  SliceMessage recoded;
  recoded.id = slice.id;
  recoded.count = slice.count;
  recoded.is_recoded = true;
  recoded.unix_ns = slice.unix_ns;
  recoded.first_column = slice.first_column;
  if (!decoding_->Recode(&recoded.payload)) return;
  recoded.size = DataSize::Bytes(static_cast<std::int64_t>(recoded.payload.size()));
  server_->PublishSlice(slices_, std::make_shared<const SliceMessage>(std::move(recoded)));
}

}  // namespace lidar::web
