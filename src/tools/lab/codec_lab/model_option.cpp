// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/lab/codec_lab/model_option.h"

#include <stdexcept>

#include "src/tools/common/output_file.h"

namespace lidar::tools {

rate::ModelFile LoadModelFile(const std::string& path) {
  const std::string text = path.empty() ? std::string(rate::BuiltInModelFile()) : ReadFile(path);
  std::string error;
  auto file = rate::ParseModelFile(text, &error);
  if (!file) throw std::runtime_error(path + ": " + error);
  return *std::move(file);
}

std::unique_ptr<rate::SizeModel> MakeModelOrThrow(const rate::ModelFile& file,
                                                  rate::RateModel kind) {
  std::string error;
  auto model = rate::MakeModel(file, kind, &error);
  if (!model) throw std::runtime_error(error);
  return model;
}

}  // namespace lidar::tools
