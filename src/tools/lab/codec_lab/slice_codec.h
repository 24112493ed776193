// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes slices of scans as dracoenc does, and measures sizes and real errors.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ext/draco/slice_coder.h"
#include "src/rate/error_bound.h"
#include "src/rate/size_model.h"
#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

/// A way of coding, with its name in the rate models.
struct CodingMode {
  std::string name;
  Geometry geometry = Geometry::kRange;
  codec::RangeCoder coder = codec::RangeCoder::kAdaptive;  // of range geometry
  unsigned level = 7;                                      // Draco's, of xyz geometry
  unsigned effort = 0;                                     // kMixing's
};
const std::vector<CodingMode>& AllModes();
/// Throws std::runtime_error for an unknown name.
const CodingMode& ModeNamed(const std::string& name);
/// Returns the mode that Draco uses for xyz geometry at a compression level.
const CodingMode& XyzModeOfLevel(unsigned level);

struct Distortion {
  double mean_m = 0;
  double max_m = 0;
};

/// Holds one slice and encodes it as often as wanted.
class SliceCodec {
 public:
  void Load(const Scan& scan, SliceOf slice);

  std::size_t returns() const { return returns_; }
  /// The format of the slice in a buffer.
  const codec::CloudFormat& format() const { return format_; }
  ByteView raw() const { return {raw_.data(), raw_.size()}; }
  std::uint32_t first_column() const { return first_column_; }
  /// The features of the slice: returns, extent, mode.
  rate::SliceFeatures Features(const CodingMode& mode);
  rate::ErrorBound Bound(const CodingMode& mode);

  /// Returns nothing if the slice is empty or the codec refuses the step. `keep_fraction` thins
  /// beams, or points of a cloud without order.
  std::optional<rate::EncodedSize> Encode(const CodingMode& mode, const rate::Settings& settings,
                                          double keep_fraction = 1);
  /// Returns distances between points and decoded points. Returns nothing if Encode() would, or for
  /// xyz steps so fine that no coder keeps the order.
  std::optional<Distortion> Errors(const CodingMode& mode, const rate::Settings& settings);

 private:
  struct Coder {
    draco::SliceEncoder encoder;
    bool loaded = false;
  };
  void SetFormat(const Scan& scan);
  void AppendPoint(const float* xyz, float intensity, std::uint32_t range_mm);
  draco::SliceEncoder& EncoderFor(const CodingMode& mode);
  bool EncodeXyz(const CodingMode& mode, const rate::Settings& settings, double keep_fraction);
  bool EncodeBytes(const CodingMode& mode, const rate::Settings& settings, double keep_fraction);

  std::shared_ptr<const ScanGeometry> geometry_;
  codec::CloudFormat format_;
  std::map<std::string, Coder> coders_;  // by mode
  std::uint32_t first_column_ = 0;
  std::vector<std::uint8_t> raw_;
  std::vector<float> points_;  // x y z of every return
  std::size_t returns_ = 0;
  codec::EncodedSlice encoded_;
};

}  // namespace lidar::tools
