// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/encoder/vtable_coder.h"

#include <cmath>

namespace lidar::gst {

using rate::CodingResult;

VtableCoder::VtableCoder(GstLidarEncoder* encoder)
    : encoder_(encoder), class_(GST_LIDAR_ENCODER_GET_CLASS(encoder)), bytes_(g_byte_array_new()) {}

void VtableCoder::Load(const GstLidarRawSlice& raw) {
  GstLidarLoadedSlice loaded{};
  class_->load(encoder_, &raw, &loaded);
  loaded_.returns = loaded.returns;
  loaded_.extent_m = loaded.extent;
  loaded_.rows = class_->thin != nullptr ? loaded.rows : 0;
  loaded_.has_intensity = loaded.has_intensity != FALSE;
  loaded_.level = loaded.level;
  loaded_.mode = loaded.mode != nullptr ? loaded.mode : "xyz-other";
}

rate::StepRange VtableCoder::Steps(double max_error_m) const {
  // The centre of a cube is sqrt(3)/2 steps away from the corners of the cube.
  GstLidarStepRange steps{0.001, 2 / std::sqrt(3.0) * max_error_m, 0};
  if (class_->get_steps != nullptr) class_->get_steps(encoder_, max_error_m, &steps);
  return {steps.finest, steps.coarsest, steps.unit};
}

void VtableCoder::Thin(const std::vector<bool>& kept) {
  const std::vector<guint8> flags(kept.begin(), kept.end());
  class_->thin(encoder_, flags.data(), static_cast<guint>(flags.size()));
}

CodingResult VtableCoder::Encode(double max_error_m, const rate::Settings& settings,
                                 rate::CodedSlice* slice) {
  const GstLidarEncodeSettings wanted{max_error_m, settings.step_m, settings.intensity_bits,
                                      settings.level, threads_};
  GstLidarCodedSlice coded{};
  g_byte_array_set_size(bytes_.get(), 0);
  const auto result = class_->encode(encoder_, &wanted, bytes_.get(), &coded);
  *slice = {bytes_->len, coded.returns, coded.step, coded.error_bound};
  if (result == GST_LIDAR_ENCODE_OUT_OF_REACH) return CodingResult::kOutOfReach;
  // Returns kEmpty if there are no bytes, because receivers would count a slice without bytes as
  // lost.
  return result == GST_LIDAR_ENCODE_OK && bytes_->len > 0 ? CodingResult::kEncoded
                                                          : CodingResult::kEmpty;
}

}  // namespace lidar::gst
