// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidarcodec/lidarenc_coder.h"

namespace lidar::gst {
namespace {

Time Now() { return Time{std::chrono::microseconds(g_get_monotonic_time())}; }

}  // namespace

bool LidarEncCoder::SetFormat(const CloudInfo& info, bool with_intensity) {
  const codec::EffortControl control = control_;
  *this = LidarEncCoder();
  control_ = control;
  if (info.framerate_n > 0)
    scans_per_second_ = static_cast<double>(info.framerate_n) / info.framerate_d;
  format_ = {{info.fields, info.point_step}, info.height, info.sensor_model};
  with_intensity_ = with_intensity;
  encoder_ = codec::SliceEncoder::Create(format_);
  return encoder_ && info.width <= info.sensor_model->columns_per_scan;
}

void LidarEncCoder::Load(const GstLidarRawSlice& raw, std::optional<unsigned> effort) {
  KeepBlocks();
  ChooseEffort(raw.width, effort);
  encoder_->Load({raw.data, raw.size}, raw.first_column, with_intensity_);
}

/// What the last slice left is known from now on; which of several encodings was sent is known only
/// when the next slice comes.
void LidarEncCoder::KeepBlocks() {
  keeper_.OnEncoded(std::move(slice_.blocks));
  slice_.blocks.clear();
}

/// Learns from the slice before, and chooses for the next one.
void LidarEncCoder::ChooseEffort(guint columns, std::optional<unsigned> effort) {
  if (automatic_ && spent_ > Duration{0}) control_.OnSlice(sweep_, encoder_->returns(), spent_);
  sweep_ = FromSeconds(columns / (scans_per_second_ * format_.sensor_model->columns_per_scan));
  spent_ = {};
  automatic_ = !effort;
  encoder_->set_effort(effort.value_or(control_.effort()));
}

void LidarEncCoder::Link(const GstLidarRawSlice& raw, bool remembers, Duration key_interval) {
  keeper_.set_key_interval(key_interval);
  const bool begun =
      remembers && keeper_.Begin(Now(), {raw.scan_id, raw.slice_index, raw.slice_count});
  encoder_->LinkBy(begun ? &keeper_ : nullptr);
}

void LidarEncCoder::Describe(GstLidarLoadedSlice* loaded) {
  mode_ = encoder_->Mode();
  loaded->returns = static_cast<guint>(encoder_->returns());
  loaded->extent = encoder_->extent_m();
  loaded->rows = static_cast<guint>(encoder_->rows());
  loaded->has_intensity = encoder_->has_intensity();
  loaded->mode = mode_.c_str();
}

GstLidarEncodeResult LidarEncCoder::Encode(const GstLidarEncodeSettings& settings,
                                           GByteArray* bytes, GstLidarCodedSlice* coded) {
  encoder_->set_threads(settings.threads);
  const Time start = Now();
  const auto result =
      encoder_->Encode({settings.max_error, settings.step, settings.intensity_bits}, &slice_);
  spent_ += Now() - start + std::chrono::microseconds(1);
  if (result == codec::SliceResult::kEmpty) return GST_LIDAR_ENCODE_EMPTY;
  if (result == codec::SliceResult::kOutOfReach) return GST_LIDAR_ENCODE_OUT_OF_REACH;
  g_byte_array_append(bytes, slice_.bytes.data(), static_cast<guint>(slice_.bytes.size()));
  *coded = {static_cast<guint>(slice_.returns), slice_.step_m, slice_.error_m};
  return GST_LIDAR_ENCODE_OK;
}

bool LidarEncCoder::Decode(ByteView stream, GArray* points) {
  if (!decoder_) {
    auto format = format_;
    format.layout = {*PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,range:U32:12"),
                     sizeof(GstLidarPoint)};
    decoder_.emplace(format, format.height * format.sensor_model->columns_per_scan);
  }
  for (const auto& block : keeper_.references()) decoder_->Know(block);
  const auto shape = decoder_->Decode(stream);
  if (!shape) return false;
  g_array_set_size(points, shape->width * shape->height);
  decoder_->Write(reinterpret_cast<guint8*>(points->data));
  return true;
}

void LidarEncCoder::OnAcknowledged(guint receiver, guint scan_id, guint slice_index) {
  KeepBlocks();
  keeper_.OnAcknowledged(Now(), receiver, scan_id, slice_index);
}

void LidarEncCoder::OnKeyRequest() {
  KeepBlocks();
  keeper_.OnKeyRequest();
}

}  // namespace lidar::gst
