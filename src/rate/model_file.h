// SPDX-License-Identifier: LGPL-2.1-or-later
// The file with the coefficients of the predictors. It is JSON, and is documented in
// docs/rate-control.md.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "src/rate/adaptive_model.h"
#include "src/rate/paper_model.h"

namespace lidar::rate {

enum class RateModel { kAdaptive, kPaper };

struct ModelFile {
  std::string trained_on;  // a description for users
  std::optional<AdaptiveCoefficients> adaptive;
  std::optional<PaperCoefficients> paper;
};

/// Parses a model file. Returns nothing if the file is invalid or of a later version. `error` then
/// describes the fault for a user.
std::optional<ModelFile> ParseModelFile(std::string_view json, std::string* error);
std::string WriteModelFile(const ModelFile& file);

/// Makes a predictor. Returns null if the file has no coefficients for `kind`. `error` then has the
/// reason.
std::unique_ptr<SizeModel> MakeModel(const ModelFile& file, RateModel kind, std::string* error);
/// Makes a predictor from the file that is compiled in.
std::unique_ptr<SizeModel> MakeBuiltInModel(RateModel kind);
/// Returns the text of the file that is compiled in.
std::string_view BuiltInModelFile();

constexpr int kModelFileVersion = 1;
constexpr std::size_t kMaxModelFileSize = 1U << 20;  // bytes

}  // namespace lidar::rate
