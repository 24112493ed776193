// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds of a spinning sensor that nobody described, with the ranges that its beams measured.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "gst/lidar/cloud_info.h"
#include "src/base/byte_reader.h"
#include "src/cloud/beam_fit.h"
#include "src/cloud/range_projection.h"

namespace lidar::gst {

/// Clouds of one layout. The points that come out stand exactly where range and beam put them.
class CloudOrganizer {
 public:
  /// Returns nothing where the layout has no rows of beams, no x, y and z as F32 side by side, or
  /// no room for a range; `why` then says which.
  static std::optional<CloudOrganizer> Create(const CloudInfo& info, std::string* why);

  struct Result {
    guint64 returns = 0;
    guint64 outside = 0;  // of them; each became a missing return
    bool fits() const { return returns > 0 && outside <= returns / kMostOutside; }
  };
  /// Learns from `cloud` where nothing is known yet, or where what is known does not fit it well.
  /// None where no model fits: there is nothing to put out. Else `out` has output_size() bytes.
  std::optional<Result> Organize(ByteView cloud, gdouble max_error_m, guint8* out);

  /// The cloud that comes out. It has the model once a cloud fitted.
  const CloudInfo& output() const { return output_; }
  /// Counts the models that were found.
  guint models() const { return models_; }

  /// Share of returns, 1 in this many, that may stand elsewhere: rain on the lens, and what a
  /// driver made up.
  static constexpr guint64 kMostOutside = 100;

 private:
  explicit CloudOrganizer(const CloudInfo& info) : input_(info), fit_(info.width, info.height) {}

  Result Write(ByteView cloud, const RangeProjection& projection, gdouble max_error_m,
               guint8* out) const;

  CloudInfo input_;
  CloudInfo output_;
  guint xyz_offset_ = 0;
  guint range_offset_ = 0;
  BeamFit fit_;
  std::optional<RangeProjection> projection_;
  guint models_ = 0;
  guint64 clouds_since_fit_ = 0;
};

}  // namespace lidar::gst
