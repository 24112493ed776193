// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/enc_error_report.h"

#include "gst/common/buffer_map.h"

namespace lidar::gst {
namespace {

void Warn(GstElement* element, const CheckedSlice& slice,
          const std::optional<PointErrors>& errors) {
  if (!errors) {
    GST_ELEMENT_WARNING(element, STREAM, ENCODE,
                        ("An encoded slice cannot be decoded. Use range-coder=draco or "
                         "geometry=xyz, and report it."),
                        ("slice %u of scan %u", slice.slice_index, slice.scan_id));
    return;
  }
  GST_ELEMENT_WARNING(
      element, STREAM, ENCODE,
      ("Points came back farther from where they were than max-error. If the cloud was moved after "
       "the sensor, use geometry=xyz; else report it."),
      ("slice %u of scan %u: %f m where %f m are allowed; %" G_GUINT64_FORMAT " points missing",
       slice.slice_index, slice.scan_id, errors->max_m, slice.max_error_m, errors->missing));
}

void Post(GstElement* element, const CheckedSlice& slice, const ErrorReport::Outcome& outcome) {
  const PointErrors& e = outcome.errors;
  GstStructure* s = gst_structure_new(
      "dracoenc-error-check", "scan-id", G_TYPE_UINT, slice.scan_id, "slice-index", G_TYPE_UINT,
      slice.slice_index, "holds", G_TYPE_BOOLEAN, gboolean{outcome.holds}, "points", G_TYPE_UINT64,
      e.points, "points-missing", G_TYPE_UINT64, e.missing, "largest-error", G_TYPE_DOUBLE, e.max_m,
      "mean-error", G_TYPE_DOUBLE, e.mean_m, "error-bound", G_TYPE_DOUBLE, slice.bound_m,
      "max-error", G_TYPE_DOUBLE, slice.max_error_m, nullptr);
  gst_element_post_message(element, gst_message_new_element(GST_OBJECT(element), s));
}

}  // namespace

std::optional<ErrorReport::Outcome> ErrorReport::OnSlice(GstElement* element, guint every,
                                                         GstBuffer* input,
                                                         const std::vector<std::uint8_t>& bytes,
                                                         const CheckedSlice& slice) {
  if (every == 0) return std::nullopt;
  if (left_out_ > 0) {
    left_out_ = MIN(left_out_, every) - 1;
    return std::nullopt;
  }
  left_out_ = every - 1;
  const BufferMap map(input, GST_MAP_READ);
  if (!map) return std::nullopt;
  const auto errors = check_.Measure(map.view(), bytes);
  const bool holds = errors && errors->max_m <= slice.max_error_m + errors->rounding_m &&
                     (slice.thinned || errors->missing == 0);
  if (!holds && !warned_) Warn(element, slice, errors);
  warned_ = !holds;
  const Outcome outcome{errors.value_or(PointErrors{}), holds};
  Post(element, slice, outcome);
  return outcome;
}

}  // namespace lidar::gst
