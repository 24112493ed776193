// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidarcodec/lidarenc_coder.h"

#include <algorithm>
#include <utility>

namespace lidar::gst {
namespace {

Time Now() { return Time{std::chrono::microseconds(g_get_monotonic_time())}; }

}  // namespace

bool LidarEncCoder::SetFormat(const CloudInfo& info, bool with_intensity,
                              const codec::cloud::ExactChoice& exact) {
  MeasureEffort();
  LidarEncCoder next;
  next.control_ = control_;
  if (info.framerate_n > 0)
    next.scans_per_second_ = static_cast<double>(info.framerate_n) / info.framerate_d;
  next.format_ = {{info.fields, info.point_step}, info.height, info.sensor_model};
  next.with_intensity_ = with_intensity;
  next.exact_ = exact;
  next.encoder_ = codec::SliceEncoder::Create(next.format_);
  if (next.encoder_ && info.width > info.sensor_model->columns_per_scan) next.encoder_.reset();
  const bool stays = cloud_ && next.format_.layout == format_.layout && exact == exact_;
  if (!next.encoder_)
    next.cloud_ =
        stays ? std::move(cloud_) : codec::cloud::CloudEncoder::Create(next.format_.layout, exact);
  *this = std::move(next);
  return encoder_ || cloud_;
}

rate::ErrorBound LidarEncCoder::Bound() const {
  return encoder_ ? rate::ErrorBound::Range(encoder_->range_unit_mm()) : rate::ErrorBound::Xyz();
}

void LidarEncCoder::Thin(const std::vector<bool>& kept) {
  encoder_ ? encoder_->Thin(kept) : cloud_->Thin(kept);
}

void LidarEncCoder::Load(const GstLidarRawSlice& raw, std::optional<unsigned> effort) {
  KeepBlocks();
  ChooseEffort(raw, effort);
  const ByteView points{raw.data, raw.size};
  encoder_ ? encoder_->Load(points, raw.first_column, with_intensity_)
           : cloud_->Load(points, with_intensity_);
}

/// Keeps the blocks of the last encoding, which is the encoding that was sent. Must be called when
/// the slice will not be encoded again.
void LidarEncCoder::KeepBlocks() {
  keeper_.OnEncoded(std::move(slice_.blocks));
  slice_.blocks.clear();
}

/// Reports to `control_` how long the encoding of the last slice took. Must be called before the
/// coder of this slice is replaced.
void LidarEncCoder::MeasureEffort() {
  if (automatic_ && spent_ > Duration{0}) control_.OnSlice(sweep_, returns(), spent_);
  spent_ = {};
}

void LidarEncCoder::ChooseEffort(const GstLidarRawSlice& raw, std::optional<unsigned> effort) {
  MeasureEffort();
  const double part = encoder_
                          ? static_cast<double>(raw.width) / format_.sensor_model->columns_per_scan
                          : 1.0 / std::max(raw.slice_count, 1U);
  sweep_ = FromSeconds(part / scans_per_second_);
  automatic_ = !effort;
  const unsigned chosen = effort.value_or(control_.effort());
  encoder_ ? encoder_->set_effort(chosen) : cloud_->set_effort(chosen);
}

void LidarEncCoder::Link(const GstLidarRawSlice& raw, bool remembers, Duration key_interval) {
  if (!encoder_) return;
  keeper_.set_key_interval(key_interval);
  const bool begun =
      remembers && keeper_.Begin(Now(), {raw.scan_id, raw.slice_index, raw.slice_count});
  encoder_->LinkBy(begun ? &keeper_ : nullptr);
}

void LidarEncCoder::Describe(GstLidarLoadedSlice* loaded) {
  mode_ = encoder_ ? encoder_->Mode() : cloud_->Mode();
  loaded->returns = static_cast<guint>(returns());
  loaded->extent = encoder_ ? encoder_->extent_m() : cloud_->extent_m();
  loaded->rows = static_cast<guint>(encoder_ ? encoder_->rows() : cloud_->returns());
  loaded->has_intensity = encoder_ ? encoder_->has_intensity() : cloud_->has_intensity();
  loaded->mode = mode_.c_str();
}

GstLidarEncodeResult LidarEncCoder::Encode(const GstLidarEncodeSettings& settings,
                                           GByteArray* bytes, GstLidarCodedSlice* coded) {
  const codec::SliceSettings slice{settings.max_error, settings.step, settings.intensity_bits};
  const Time start = Now();
  if (encoder_) encoder_->set_threads(settings.threads);
  const auto result = encoder_ ? encoder_->Encode(slice, &slice_) : cloud_->Encode(slice, &slice_);
  spent_ += Now() - start + std::chrono::microseconds(1);
  if (result == codec::SliceResult::kEmpty) return GST_LIDAR_ENCODE_EMPTY;
  if (result == codec::SliceResult::kOutOfReach) return GST_LIDAR_ENCODE_OUT_OF_REACH;
  g_byte_array_append(bytes, slice_.bytes.data(), static_cast<guint>(slice_.bytes.size()));
  *coded = {static_cast<guint>(slice_.returns), slice_.step_m, slice_.error_m};
  return GST_LIDAR_ENCODE_OK;
}

bool LidarEncCoder::Decode(ByteView stream, GArray* points) {
  auto format = format_;
  format.layout = {*PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,range:U32:12"),
                   sizeof(GstLidarPoint)};
  if (!encoder_) {
    codec::cloud::ExactDecoder decoder(exact_.fields, static_cast<std::uint32_t>(returns()));
    if (!decoder.Decode(stream) || !cloud_->HasComeBack(decoder.part())) return false;
    g_array_set_size(points, static_cast<guint>(decoder.size()));
    decoder.Write(format.layout, reinterpret_cast<guint8*>(points->data));
    return true;
  }
  if (!decoder_) {
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
