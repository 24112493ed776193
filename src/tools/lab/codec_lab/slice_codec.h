// SPDX-License-Identifier: LGPL-2.1-or-later
// Encodes slices of scans as dracoenc does, and measures their sizes and their real errors.
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

/// A way to encode slices. It has the same name in the rate models.
struct CodingMode {
  std::string name;
  Geometry geometry = Geometry::kRange;
  codec::RangeCoder coder = codec::RangeCoder::kAdaptive;  // for range geometry
  unsigned level = 7;                                      // Draco's level, for xyz geometry
  unsigned effort = 0;                                     // for kMixing
};
const std::vector<CodingMode>& AllModes();
/// Returns the mode called `name`. Throws std::runtime_error if there is no such mode.
const CodingMode& ModeNamed(const std::string& name);
/// Returns the mode that Draco uses for xyz geometry at this compression level.
const CodingMode& XyzModeOfLevel(unsigned level);

struct Distortion {
  double mean_m = 0;
  double max_m = 0;
};

/// Holds one slice, and encodes it any number of times.
class SliceCodec {
 public:
  void Load(const Scan& scan, SliceOf slice);

  std::size_t returns() const { return returns_; }
  /// Returns the format of the slice in raw().
  const codec::CloudFormat& format() const { return format_; }
  ByteView raw() const { return {raw_.data(), raw_.size()}; }
  std::uint32_t first_column() const { return first_column_; }
  /// Returns the features of the slice that rate models use: its returns, its extent and `mode`.
  rate::SliceFeatures Features(const CodingMode& mode);
  rate::ErrorBound Bound(const CodingMode& mode);

  /// Encodes the slice. Returns nothing if the slice is empty or the codec refuses the step.
  /// `keep_fraction` is the share of the beams to keep, or of the points if the cloud is not
  /// organised.
  std::optional<rate::EncodedSize> Encode(const CodingMode& mode, const rate::Settings& settings,
                                          double keep_fraction = 1);
  /// Returns the distances between the points and the decoded points. Returns nothing if Encode()
  /// would return nothing. Also returns nothing for xyz geometry if the step is so fine that no
  /// coder keeps the order of the points.
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
  std::map<std::string, Coder> coders_;  // by the name of the mode
  std::uint32_t first_column_ = 0;
  std::vector<std::uint8_t> raw_;
  std::vector<float> points_;  // x, y and z of each return
  std::size_t returns_ = 0;
  codec::EncodedSlice encoded_;
};

}  // namespace lidar::tools
