// SPDX-License-Identifier: LGPL-2.1-or-later
// Adapts the virtual methods of an encoder to the coder that the rate loop uses.
#pragma once
#include <memory>
#include <vector>

#include "gst/lidar/gstlidarencoder.h"
#include "src/base/byte_reader.h"
#include "src/rate/slice_coder.h"

namespace lidar::gst {

/// The coder of an encoder. `encoder` owns this object. Only the encoder's streaming thread may use
/// it.
class VtableCoder final : public rate::SliceCoder {
 public:
  explicit VtableCoder(GstLidarEncoder* encoder);

  void Load(const GstLidarRawSlice& raw);
  void set_threads(guint threads) { threads_ = threads; }
  /// Returns the bytes that the last Encode() made.
  ByteView bytes() const { return {bytes_->data, bytes_->len}; }

  rate::LoadedSlice loaded() const override { return loaded_; }
  rate::StepRange Steps(double max_error_m) const override;
  void Thin(const std::vector<bool>& kept) override;
  rate::CodingResult Encode(double max_error_m, const rate::Settings& settings,
                            rate::CodedSlice* slice) override;

 private:
  struct FreeBytes {
    void operator()(GByteArray* bytes) const { g_byte_array_unref(bytes); }
  };

  GstLidarEncoder* encoder_;
  GstLidarEncoderClass* class_;
  std::unique_ptr<GByteArray, FreeBytes> bytes_;
  rate::LoadedSlice loaded_;
  guint threads_ = 1;
};

}  // namespace lidar::gst
