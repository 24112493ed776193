// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/enc_error_report.h"

namespace lidar::gst {
namespace {

void Warn(GstElement* element, const CheckedSlice& slice,
          const std::optional<PointErrors>& errors) {
  if (!errors) {
    GST_ELEMENT_WARNING(element, STREAM, ENCODE, ("An encoded slice cannot be decoded."),
                        ("slice %u of scan %u", slice.slice_index, slice.scan_id));
    return;
  }
  GST_ELEMENT_WARNING(
      element, STREAM, ENCODE, ("Points came back farther from where they were than max-error."),
      ("slice %u of scan %u: %f m where %f m are allowed; %" G_GUINT64_FORMAT " points missing",
       slice.slice_index, slice.scan_id, errors->max_m, slice.max_error_m, errors->missing));
}

}  // namespace

bool PostErrors(GstElement* element, const CheckedSlice& slice,
                const std::optional<PointErrors>& errors, bool warn) {
  const bool holds = errors && errors->max_m <= slice.max_error_m + errors->rounding_m &&
                     (slice.thinned || errors->missing == 0);
  if (!holds && warn) Warn(element, slice, errors);
  const PointErrors e = errors.value_or(PointErrors{});
  GstStructure* s = gst_structure_new(
      "dracoenc-error-check", "scan-id", G_TYPE_UINT, slice.scan_id, "slice-index", G_TYPE_UINT,
      slice.slice_index, "holds", G_TYPE_BOOLEAN, gboolean{holds}, "points", G_TYPE_UINT64,
      e.points, "points-missing", G_TYPE_UINT64, e.missing, "largest-error", G_TYPE_DOUBLE, e.max_m,
      "mean-error", G_TYPE_DOUBLE, e.mean_m, "error-bound", G_TYPE_DOUBLE, slice.bound_m,
      "max-error", G_TYPE_DOUBLE, slice.max_error_m, nullptr);
  gst_element_post_message(element, gst_message_new_element(GST_OBJECT(element), s));
  return holds;
}

}  // namespace lidar::gst
