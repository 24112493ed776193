// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/model_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "src/rate/default_model.h"

namespace lidar::rate {
namespace {

using Json = nlohmann::json;
constexpr const char* kFormat = "gst-lidar-rate-model";
constexpr double kLargest = 1e12;  // larger coefficients are a mistake

/// Returns a reference to the member, or to a null value. A copy is avoided, because copying deeply
/// nested JSON would exhaust the stack.
const Json& Member(const Json& parent, const char* name) {
  static const Json kNone;
  const auto found = parent.find(name);
  return found == parent.end() ? kNone : *found;
}

/// Reads the members of objects, and keeps the first fault.
class Reader {
 public:
  explicit Reader(std::string* error) : error_(error) { error_->clear(); }
  bool ok() const { return error_->empty(); }
  void Fail(const std::string& why) {
    if (ok()) *error_ = why;
  }

  const Json& Object(const Json& parent, const std::string& path, const char* name) {
    static const Json kNone = Json::object();
    const Json& found = Member(parent, name);
    if (found.is_object()) return found;
    Fail(path + name + " is missing or not an object");
    return kNone;
  }
  double Number(const Json& value, const std::string& path) {
    if (!value.is_number() || !(std::abs(value.get<double>()) <= kLargest)) {
      Fail(path + " is not a number");
      return 0;
    }
    return value.get<double>();
  }
  double Number(const Json& parent, const std::string& path, const char* name) {
    return Number(Member(parent, name), path + name);
  }
  template <std::size_t N>
  std::array<double, N> Numbers(const Json& parent, const std::string& path, const char* name) {
    std::array<double, N> numbers{};
    const Json& found = Member(parent, name);
    if (!found.is_array() || found.size() != N) {
      Fail(path + name + " is not a list of " + std::to_string(N) + " numbers");
      return numbers;
    }
    for (std::size_t i = 0; i < N; ++i)
      numbers[i] = Number(found[i], path + name + "[" + std::to_string(i) + "]");
    return numbers;
  }

 private:
  std::string* error_;
};

ModeCoefficients ReadMode(const Json& json, const std::string& path, Reader* reader) {
  ModeCoefficients mode;
  mode.step = reader->Numbers<4>(json, path, "step");
  const auto range = reader->Numbers<2>(json, path, "log2-step-range");
  mode.min_x = range[0];
  mode.max_x = range[1];
  mode.returns = reader->Number(json, path, "returns");
  mode.intensity = reader->Numbers<2>(json, path, "intensity");
  mode.intensity_returns = reader->Number(json, path, "intensity-returns");
  if (!(mode.min_x < mode.max_x)) reader->Fail(path + "log2-step-range is empty");
  if (mode.intensity[1] < 0) reader->Fail(path + "intensity: sizes must not fall as the bits grow");
  if (!mode.Falls()) reader->Fail(path + "step: sizes must fall as the step grows");
  return mode;
}

AdaptiveCoefficients ReadAdaptive(const Json& json, Reader* reader) {
  AdaptiveCoefficients adaptive;
  const std::string path = "adaptive.";
  for (const auto& [name, mode] : reader->Object(json, path, "modes").items())
    adaptive.modes[name] = ReadMode(mode, path + "modes." + name + ".", reader);
  adaptive.fallback = ReadMode(reader->Object(json, path, "fallback"), path + "fallback.", reader);
  return adaptive;
}

PaperCoefficients ReadPaper(const Json& json, Reader* reader) {
  PaperCoefficients paper;
  for (const auto& [name, polynomial] : reader->Object(json, "paper.", "geometries").items()) {
    const std::string path = "paper.geometries." + name + ".";
    paper.geometries[name] = {reader->Numbers<kPaperFeatures>(polynomial, path, "alpha"),
                              reader->Number(polynomial, path, "beta")};
  }
  if (paper.geometries.empty()) reader->Fail("paper.geometries is empty");
  return paper;
}

Json WriteMode(const ModeCoefficients& mode) {
  return {{"step", mode.step},
          {"log2-step-range", {mode.min_x, mode.max_x}},
          {"returns", mode.returns},
          {"intensity", mode.intensity},
          {"intensity-returns", mode.intensity_returns}};
}

void CheckHeader(const Json& json, Reader* reader) {
  if (!json.is_object() || Member(json, "format") != kFormat)
    return reader->Fail(std::string("not a rate model: \"format\" is not \"") + kFormat + '"');
  const Json& version = Member(json, "version");
  if (!version.is_number_integer() || version < 1)
    return reader->Fail("\"version\" is not a positive integer");
  if (version > kModelFileVersion)
    reader->Fail("the file is of version " + version.dump() + ", but only versions up to " +
                 std::to_string(kModelFileVersion) + " are known");
}

}  // namespace

std::optional<ModelFile> ParseModelFile(std::string_view text, std::string* error) {
  Reader reader(error);
  if (text.size() > kMaxModelFileSize) {
    reader.Fail("the file is larger than a megabyte");
    return std::nullopt;
  }
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& e) {
    // The text of the exception is not used. It quotes bytes of the file, but a message may have
    // only UTF-8.
    reader.Fail("not JSON, or cut off, at byte " + std::to_string(e.byte));
    return std::nullopt;
  } catch (const Json::exception& e) {
    reader.Fail(std::string("not JSON: ") + e.what());
    return std::nullopt;
  }
  CheckHeader(json, &reader);
  if (!reader.ok()) return std::nullopt;
  ModelFile file;
  if (const Json& text_of = Member(json, "trained-on"); text_of.is_string())
    file.trained_on = text_of;
  if (json.contains("adaptive"))
    file.adaptive = ReadAdaptive(reader.Object(json, "", "adaptive"), &reader);
  if (json.contains("paper")) file.paper = ReadPaper(reader.Object(json, "", "paper"), &reader);
  if (!file.adaptive && !file.paper) reader.Fail("\"adaptive\" and \"paper\" are both missing");
  if (!reader.ok()) return std::nullopt;
  return file;
}

std::string WriteModelFile(const ModelFile& file) {
  Json json = {
      {"format", kFormat}, {"version", kModelFileVersion}, {"trained-on", file.trained_on}};
  if (file.adaptive) {
    Json modes = Json::object();
    for (const auto& [name, mode] : file.adaptive->modes) modes[name] = WriteMode(mode);
    json["adaptive"] = {{"modes", modes}, {"fallback", WriteMode(file.adaptive->fallback)}};
  }
  if (file.paper) {
    Json geometries = Json::object();
    for (const auto& [name, polynomial] : file.paper->geometries)
      geometries[name] = {{"alpha", polynomial.alpha}, {"beta", polynomial.beta}};
    json["paper"] = {{"geometries", geometries}};
  }
  return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

std::unique_ptr<SizeModel> MakeModel(const ModelFile& file, RateModel kind, std::string* error) {
  if (kind == RateModel::kAdaptive && file.adaptive)
    return std::make_unique<AdaptiveModel>(*file.adaptive);
  if (kind == RateModel::kPaper && file.paper) return std::make_unique<PaperModel>(*file.paper);
  *error = std::string("the file has no coefficients of the model \"") +
           (kind == RateModel::kPaper ? "paper" : "adaptive") + '"';
  return nullptr;
}

std::string_view BuiltInModelFile() { return kDefaultModel; }

std::unique_ptr<SizeModel> MakeBuiltInModel(RateModel kind) {
  std::string error;
  return MakeModel(ParseModelFile(BuiltInModelFile(), &error).value(), kind, &error);
}

}  // namespace lidar::rate
