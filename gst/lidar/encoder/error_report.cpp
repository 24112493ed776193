// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/encoder/error_report.h"

#include <vector>

namespace lidar::gst {

ErrorReport::ErrorReport(GstLidarEncoder* encoder)
    : encoder_(encoder), points_(g_array_new(FALSE, TRUE, sizeof(GstLidarPoint))) {}

bool ErrorReport::IsDue(guint every) {
  if (every == 0 || GST_LIDAR_ENCODER_GET_CLASS(encoder_)->decode == nullptr) return false;
  if (left_out_ > 0) {
    left_out_ = MIN(left_out_, every) - 1;
    return false;
  }
  left_out_ = every - 1;
  return true;
}

std::optional<PointErrors> ErrorReport::Measure(const CloudInfo& info, ByteView raw, ByteView coded,
                                                bool thinned) {
  g_array_set_size(points_.get(), 0);
  auto order = GST_LIDAR_ORDER_ANY;
  if (!GST_LIDAR_ENCODER_GET_CLASS(encoder_)->decode(encoder_, coded.data, coded.size,
                                                     points_.get(), &order)) {
    return std::nullopt;
  }
  std::vector<DecodedPoint> decoded(points_->len);
  for (guint i = 0; i < points_->len; ++i) {
    const auto& p = g_array_index(points_.get(), GstLidarPoint, i);
    decoded[i] = {{p.x, p.y, p.z}, p.range};
  }
  return MeasureErrors(raw, info.fields, info.point_step, decoded, static_cast<PointOrder>(order),
                       thinned);
}

void ErrorReport::Warn(const CheckedSlice& slice, const std::optional<PointErrors>& errors) {
  if (!errors) {
    GST_ELEMENT_WARNING(
        encoder_, STREAM, ENCODE,
        ("An encoded slice cannot be decoded. Use another coder, and report this as a bug."),
        ("slice %u of scan %u", slice.slice_index, slice.scan_id));
    return;
  }
  GST_ELEMENT_WARNING(
      encoder_, STREAM, ENCODE,
      ("Decoded points are farther from the original points than max-error. If an element has "
       "moved the points, set geometry=xyz; otherwise report this as a bug."),
      ("slice %u of scan %u: %f m where %f m are allowed; %" G_GUINT64_FORMAT " points missing",
       slice.slice_index, slice.scan_id, errors->max_m, slice.max_error_m, errors->missing));
}

void ErrorReport::Post(const CheckedSlice& slice, const Outcome& outcome) {
  const PointErrors& e = outcome.errors;
  GstStructure* s = gst_structure_new(
      "lidar-error-check", "scan-id", G_TYPE_UINT, slice.scan_id, "slice-index", G_TYPE_UINT,
      slice.slice_index, "holds", G_TYPE_BOOLEAN, gboolean{outcome.holds}, "points", G_TYPE_UINT64,
      e.points, "points-missing", G_TYPE_UINT64, e.missing, "largest-error", G_TYPE_DOUBLE, e.max_m,
      "mean-error", G_TYPE_DOUBLE, e.mean_m, "error-bound", G_TYPE_DOUBLE, slice.bound_m,
      "max-error", G_TYPE_DOUBLE, slice.max_error_m, nullptr);
  gst_element_post_message(GST_ELEMENT(encoder_), gst_message_new_element(GST_OBJECT(encoder_), s));
}

std::optional<ErrorReport::Outcome> ErrorReport::OnSlice(guint every, const CloudInfo& info,
                                                         ByteView raw, ByteView coded,
                                                         const CheckedSlice& slice) {
  if (!IsDue(every)) return std::nullopt;
  const auto errors = Measure(info, raw, coded, slice.thinned);
  const bool holds = errors && errors->max_m <= slice.max_error_m + errors->rounding_m &&
                     (slice.thinned || errors->missing == 0);
  if (!holds && !warned_) Warn(slice, errors);
  warned_ = !holds;
  const Outcome outcome{errors.value_or(PointErrors{}), holds};
  Post(slice, outcome);
  return outcome;
}

}  // namespace lidar::gst
