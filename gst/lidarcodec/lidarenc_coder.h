// SPDX-License-Identifier: LGPL-2.1-or-later
// The coder of lidarenc. It spends as much effort on a slice as time allows, and keeps blocks that
// later slices may refer to.
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

/// Codes the slices of a stream. Only one thread at a time may use it.
class LidarEncCoder {
 public:
  /// Sets the format of later slices. Returns false if the cloud has neither the ranges of a sensor
  /// nor points. The measured speed of the machine is kept. The coder of points is also kept if
  /// only the size of the clouds changes. `exact` is only used for points.
  bool SetFormat(const CloudInfo& info, bool with_intensity,
                 const codec::cloud::ExactChoice& exact);
  /// Loads a slice. If `effort` is empty, chooses the highest effort that time allows.
  void Load(const GstLidarRawSlice& raw, std::optional<unsigned> effort);
  /// Allows the loaded slice to refer to blocks that the receiver has, and later slices to refer to
  /// blocks of this slice. If `remembers` is false, allows neither.
  void Link(const GstLidarRawSlice& raw, bool remembers, Duration key_interval);
  /// Describes the loaded slice. The description is valid until the next Load().
  void Describe(GstLidarLoadedSlice* loaded);
  /// Returns true if slices are coded as ranges of a sensor, and false if they are coded as points.
  bool codes_ranges() const { return encoder_.has_value(); }
  bool keeps_order() const { return exact_.keeps_order; }
  rate::ErrorBound Bound() const;
  void Thin(const std::vector<bool>& kept);
  GstLidarEncodeResult Encode(const GstLidarEncodeSettings& settings, GByteArray* bytes,
                              GstLidarCodedSlice* coded);
  /// Decodes a slice like a receiver, to check its error. Sets `points` to an array of
  /// GstLidarPoint.
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
  std::optional<codec::SliceEncoder> encoder_;       // used for ranges
  std::optional<codec::cloud::CloudEncoder> cloud_;  // used for points
  std::optional<codec::SliceDecoder> decoder_;       // used by Decode()
  bool with_intensity_ = false;
  codec::cloud::ExactChoice exact_;
  std::string mode_;
  codec::EncodedSlice slice_;
  codec::ReferenceKeeper keeper_;

  codec::EffortControl control_;
  bool automatic_ = false;  // true if `control_` chose the effort for the loaded slice
  Duration sweep_{};        // duration of the loaded slice
  Duration spent_{};        // time spent on all encodings of the loaded slice
};

}  // namespace lidar::gst
