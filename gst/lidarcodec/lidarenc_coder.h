// SPDX-License-Identifier: LGPL-2.1-or-later
// The coder of lidarenc: codes slices with the effort that time allows, and keeps blocks for
// references.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidarencoder.h"
#include "src/codec/cloud/cloud_encoder.h"
#include "src/codec/cloud/exact_decoder.h"
#include "src/codec/effort_control.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"
#include "src/rate/error_bound.h"

namespace lidar::gst {

/// For one thread at a time.
class LidarEncCoder {
 public:
  /// Returns false if `info` has neither ranges of a sensor nor points. Keeps the measured speed of
  /// the machine. Keeps the coder of points if only the size of the clouds changes. `exact` is for
  /// points only.
  bool SetFormat(const CloudInfo& info, bool with_intensity,
                 const codec::cloud::ExactChoice& exact);
  /// Loads the slice. Without `effort` it chooses the effort that time allows.
  void Load(const GstLidarRawSlice& raw, std::optional<unsigned> effort);
  /// Lets the loaded slice refer to blocks that the receiver has, and later slices to blocks of it,
  /// if `remembers` is true.
  void Link(const GstLidarRawSlice& raw, bool remembers, Duration key_interval);
  /// Describes the loaded slice; valid until the next Load().
  void Describe(GstLidarLoadedSlice* loaded);
  /// Returns true if slices are ranges of a sensor, and false if they are points in any order.
  bool codes_ranges() const { return encoder_.has_value(); }
  bool keeps_order() const { return exact_.keeps_order; }
  rate::ErrorBound Bound() const;
  void Thin(const std::vector<bool>& kept);
  GstLidarEncodeResult Encode(const GstLidarEncodeSettings& settings, GByteArray* bytes,
                              GstLidarCodedSlice* coded);
  /// Decodes as a receiver would, for the check of the error: `points` are GstLidarPoint.
  bool Decode(ByteView stream, GArray* points);
  void OnAcknowledged(guint receiver, guint scan_id, guint slice_index);
  void OnKeyRequest();

 private:
  void KeepBlocks();
  void MeasureEffort();
  void ChooseEffort(const GstLidarRawSlice& raw, std::optional<unsigned> effort);
  std::size_t returns() const { return encoder_ ? encoder_->returns() : cloud_->returns(); }

  codec::CloudFormat format_;
  double scans_per_second_ = 10;
  std::optional<codec::SliceEncoder> encoder_;       // of ranges,
  std::optional<codec::cloud::CloudEncoder> cloud_;  // or of points
  std::optional<codec::SliceDecoder> decoder_;       // for Decode()
  bool with_intensity_ = false;
  codec::cloud::ExactChoice exact_;
  std::string mode_;
  codec::EncodedSlice slice_;
  codec::ReferenceKeeper keeper_;

  codec::EffortControl control_;
  bool automatic_ = false;  // the loaded slice has the effort of `control_`
  Duration sweep_{};        // of the loaded slice
  Duration spent_{};        // for all encodings of the loaded slice
};

}  // namespace lidar::gst
