// SPDX-License-Identifier: LGPL-2.1-or-later
// The model file that a command line names.
#pragma once
#include <string>

#include "src/rate/model_file.h"

namespace lidar::tools {

/// The built-in file if `path` is empty. Throws std::runtime_error.
rate::ModelFile LoadModelFile(const std::string& path);
/// Throws if the file has no such model.
std::unique_ptr<rate::SizeModel> MakeModelOrThrow(const rate::ModelFile& file,
                                                  rate::RateModel kind);

}  // namespace lidar::tools
