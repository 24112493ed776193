// SPDX-License-Identifier: LGPL-2.1-or-later
// Loads the model file that a command line names.
#pragma once
#include <string>

#include "src/rate/model_file.h"

namespace lidar::tools {

/// Loads the model file, or the built-in one if `path` is empty. Throws std::runtime_error if the
/// file cannot be read or is wrong.
rate::ModelFile LoadModelFile(const std::string& path);
/// Makes a model of the given kind. Throws std::runtime_error if the file has no such model.
std::unique_ptr<rate::SizeModel> MakeModelOrThrow(const rate::ModelFile& file,
                                                  rate::RateModel kind);

}  // namespace lidar::tools
