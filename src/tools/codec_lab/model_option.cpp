// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/codec_lab/model_option.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace lidar::tools {

rate::ModelFile LoadModelFile(const std::string& path) {
  std::string text(rate::BuiltInModelFile());
  if (!path.empty()) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot open " + path);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
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
