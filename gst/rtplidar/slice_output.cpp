// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/rtplidar/slice_output.h"

#include <string>
#include <utility>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "gst/rtplidar/config_caps.h"
#include "src/rtp/ntp_time.h"

namespace lidar::gst {
namespace {

GstBuffer* ToBuffer(rtp::ReceivedSlice* slice) {
  auto* bytes = new std::vector<std::uint8_t>(std::move(slice->bytes));
  GstBuffer* buffer = gst_buffer_new_wrapped_full(
      static_cast<GstMemoryFlags>(0), bytes->data(), bytes->size(), 0, bytes->size(), bytes,
      [](gpointer p) { delete static_cast<std::vector<std::uint8_t>*>(p); });
  if (slice->pts) {
    GST_BUFFER_PTS(buffer) = static_cast<GstClockTime>(slice->pts->time_since_epoch().count());
  }
  if (slice->info.duration_ns != rtp::SliceInfo::kUnknownDuration)
    GST_BUFFER_DURATION(buffer) = slice->info.duration_ns;
  const GstLidarSlice meta{slice->info.scan_id, slice->id.index, slice->id.count,
                           slice->info.first_column};
  gst_lidar_buffer_set_slice(buffer, &meta);
  if (slice->info.capture_ntp != 0)
    gst_lidar_buffer_set_capture_time(buffer, rtp::FromNtp(slice->info.capture_ntp));
  if (slice->discont) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_DISCONT);
  if (slice->id.index + 1 == slice->id.count) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_MARKER);
  return buffer;
}

/// Warns that the next element does not accept slices of this coder.
void WarnOfCoder(GstRTPBaseDepayload* base, const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  const std::string type = gst_structure_get_name(s);
  const std::string decoder = type == GST_LIDAR_SLICE_MEDIA_TYPE   ? "lidardec"
                              : type == GST_LIDAR_DRACO_MEDIA_TYPE ? "dracodec"
                                                                   : "a decoder of " + type;
  GST_ELEMENT_WARNING(base, STREAM, WRONG_TYPE,
                      ("The slices of this stream need %s, but the next element does not accept "
                       "them. They are dropped.",
                       decoder.c_str()),
                      ("caps are %" GST_PTR_FORMAT, static_cast<const void*>(caps)));
}

}  // namespace

bool SliceOutput::SetCapsOf(const rtp::StreamConfig& config) {
  GstPad* src = element_->srcpad;
  const CapsPtr caps(StreamConfigToCaps(config));
  if (gst_pad_peer_query_accept_caps(src, caps.get())) {
    gst_pad_set_caps(src, caps.get());
    return true;
  }
  // This is only a warning, because another sender may use another coder.
  if (!GST_PAD_IS_FLUSHING(src) && !std::exchange(warned_of_coder_, true))
    WarnOfCoder(element_, caps.get());
  return false;
}

bool SliceOutput::MayChangeTo(const Config& config, Time now) {
  if (asked_ == config || changes_.Take(now)) return true;
  ++format_changes_;
  if (std::exchange(warned_of_changes_, true)) return false;
  GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                      ("The stream changes its format more than once a second. Slices whose format "
                       "differs from the last one are dropped meanwhile; check the sender."),
                      (nullptr));
  return false;
}

void SliceOutput::Push(std::vector<rtp::ReceivedSlice> slices, Time now) {
  BufferListPtr list;
  const auto flush = [&] {
    if (list) gst_rtp_base_depayload_push_list(element_, list.release());
  };
  for (rtp::ReceivedSlice& slice : slices) {
    if (config_ != slice.config) {
      if (!MayChangeTo(slice.config, now)) {
        discont_ = true;
        continue;
      }
      flush();
      asked_ = slice.config;
      // If the caps were refused, they are offered again with the next slice, because a pad that is
      // flushing refuses any caps.
      config_ = SetCapsOf(*slice.config) ? slice.config : nullptr;
    }
    if (!config_) {
      discont_ = true;
      ++not_accepted_;
      continue;
    }
    slice.discont |= std::exchange(discont_, false);
    if (!list) list.reset(gst_buffer_list_new());
    gst_buffer_list_add(list.get(), ToBuffer(&slice));
  }
  flush();
}

void SliceOutput::Reset() {
  config_.reset();
  asked_.reset();
  ResetTime();
  discont_ = warned_of_coder_ = warned_of_changes_ = false;
  not_accepted_ = format_changes_ = 0;
}

}  // namespace lidar::gst
