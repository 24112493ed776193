// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/model_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lidar::rate {
namespace {

ModelFile Example() {
  ModeCoefficients mode;
  mode.step = {9.1, -0.3, -0.025, 0.001};
  mode.min_x = -2.5;
  mode.max_x = 4;
  mode.returns = 0.93;
  mode.intensity = {6, 1.5};
  ModelFile file;
  file.trained_on = "a \"street\"";
  file.adaptive = AdaptiveCoefficients{{{"range-adaptive", mode}}, mode};
  file.paper = PaperCoefficients{{{"xyz", {{1, -2, 3.5, 4, 5, 6, 7, 8, -9}, 10}}}};
  return file;
}

SliceFeatures Slice(const char* mode) {
  SliceFeatures slice;
  slice.returns = 12345;
  slice.extent_m = 100;
  slice.mode = mode;
  return slice;
}

TEST(ModelFile, RoundTripsToTheSamePredictions) {
  std::string error;
  const auto back = ParseModelFile(WriteModelFile(Example()), &error);
  ASSERT_TRUE(back) << error;
  EXPECT_EQ(back->trained_on, Example().trained_on);
  for (const RateModel kind : {RateModel::kAdaptive, RateModel::kPaper}) {
    const auto before = MakeModel(Example(), kind, &error);
    const auto after = MakeModel(*back, kind, &error);
    ASSERT_TRUE(before && after) << error;
    for (const char* mode : {"range-adaptive", "xyz-kd6"})
      EXPECT_EQ(before->Predict(Slice(mode), {0.02, 5, 7}).total(),
                after->Predict(Slice(mode), {0.02, 5, 7}).total());
  }
}

TEST(ModelFile, MayHoldEitherModelOrBothAndNotNone) {
  for (const bool adaptive : {false, true})
    for (const bool paper : {false, true}) {
      ModelFile file = Example();
      if (!adaptive) file.adaptive.reset();
      if (!paper) file.paper.reset();
      std::string error;
      const auto back = ParseModelFile(WriteModelFile(file), &error);
      ASSERT_EQ(back.has_value(), adaptive || paper) << error;
      if (!back) continue;
      EXPECT_EQ(back->adaptive.has_value(), adaptive);
      EXPECT_EQ(back->paper.has_value(), paper);
      EXPECT_EQ(WriteModelFile(*back), WriteModelFile(file));
    }
}

TEST(ModelFile, IsRefusedAtEveryTruncation) {
  std::string whole = WriteModelFile(Example());
  while (whole.back() == '\n') whole.pop_back();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    std::string error;
    EXPECT_FALSE(ParseModelFile(std::string_view(whole).substr(0, n), &error)) << n;
    EXPECT_NE(error.find("cut off"), std::string::npos) << error;
  }
}

struct BadFile {
  const char* text;
  const char* complaint;
};
void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.complaint; }

class BadModelFile : public ::testing::TestWithParam<BadFile> {};
TEST_P(BadModelFile, IsRefusedWithTheReason) {
  std::string error;
  EXPECT_FALSE(ParseModelFile(GetParam().text, &error));
  EXPECT_NE(error.find(GetParam().complaint), std::string::npos) << error;
}
#define HEADER R"("format": "gst-lidar-rate-model", "version": 1)"
#define MODE(step, range)                                                    \
  R"({"step": )" step R"(, "log2-step-range": )" range R"(, "returns": 1, )" \
  R"("intensity": [1, 2], "intensity-returns": 1})"
INSTANTIATE_TEST_SUITE_P(
    All, BadModelFile,
    ::testing::Values(
        BadFile{"\x7f"
                "ELF",
                "not JSON"},
        BadFile{"[1, 2]", "not a rate model"},
        BadFile{R"({"lidar_mode": "1024x10"})", "not a rate model"},
        BadFile{R"({"format": 3, "version": 1})", "not a rate model"},
        BadFile{R"({"format": "gst-lidar-rate-model", "version": 2})", "version 2"},
        BadFile{R"({"format": "gst-lidar-rate-model", "version": "1"})", "positive integer"},
        BadFile{R"({"format": "gst-lidar-rate-model", "version": 0})", "positive integer"},
        BadFile{R"({"format": "gst-lidar-rate-model", "version": -1})", "positive integer"},
        BadFile{R"({"format": "gst-lidar-rate-model", "version": 1.5})", "positive integer"},
        BadFile{"{" HEADER "}", "both missing"},
        BadFile{"{" HEADER R"(, "adaptive": 5})", "adaptive is missing or not an object"},
        BadFile{"{" HEADER R"(, "adaptive": {"modes": {}}})", "adaptive.fallback"},
        BadFile{"{" HEADER
                R"(, "adaptive": {"modes": {}, "fallback": )" MODE("[1, -1, 0]", "[0, 1]") "}}",
                "adaptive.fallback.step is not a list of 4"},
        BadFile{"{" HEADER R"(, "adaptive": {"modes": {}, "fallback": )" MODE("[1, \"a\", 0, 0]",
                                                                              "[0, 1]") "}}",
                "adaptive.fallback.step[1] is not a number"},
        BadFile{"{" HEADER R"(, "adaptive": {"modes": {}, "fallback": )" MODE("[1, 1e300, 0, 0]",
                                                                              "[0, 1]") "}}",
                "step[1] is not a number"},
        BadFile{"{" HEADER
                R"(, "adaptive": {"modes": {}, "fallback": )" MODE("[1, 1, 0, 0]", "[0, 1]") "}}",
                "must fall as the step grows"},
        BadFile{"{" HEADER
                R"(, "adaptive": {"modes": {}, "fallback": )" MODE("[1, -1, 0, 0]", "[1, 1]") "}}",
                "range is empty"},
        BadFile{"{" HEADER R"(, "adaptive": {"modes": {}, "fallback": {"step": [1, -1, 0, 0],
                )"
                R"("log2-step-range": [0, 1], "returns": 1, "intensity": [1, -2],
                "intensity-returns": 1}}})",
                "must not fall as the bits grow"},
        BadFile{"{" HEADER R"(, "paper": {"geometries": {}}})", "empty"},
        BadFile{"{" HEADER R"(, "paper": {"geometries": {"xyz": {"alpha": [1], "beta": 2}}}})",
                "list of 9"},
        BadFile{"{" HEADER R"(, "paper": {"geometries": {"xyz": 1}}})", "not a list"}));

TEST(ModelFile, OfMoreThanAMegabyteIsNotEvenParsed) {
  std::string error;
  EXPECT_FALSE(ParseModelFile(std::string(kMaxModelFileSize + 1, ' '), &error));
  EXPECT_NE(error.find("megabyte"), std::string::npos);
}

TEST(ModelFile, OfDeepNestingIsRefused) {
  std::string error;
  const std::string deep = std::string(400000, '[') + std::string(400000, ']');
  EXPECT_FALSE(ParseModelFile(std::string(200000, '['), &error));
  EXPECT_FALSE(ParseModelFile(deep, &error));
  EXPECT_FALSE(ParseModelFile("{\"format\": " + deep + "}", &error));
  EXPECT_FALSE(
      ParseModelFile("{\"format\": \"gst-lidar-rate-model\", \"version\": " + deep + "}", &error));
  EXPECT_FALSE(ParseModelFile(
      "{" HEADER R"(, "adaptive": {"modes": {}, "fallback": {"returns": )" + deep + "}}}", &error));
}

TEST(ModelFile, IsRefusedInWordsThatAMessageCanHold) {
  for (const char* text : {"\x89PNG\r\n", "{\"format\": \"\xFF\"}"}) {
    std::string error;
    EXPECT_FALSE(ParseModelFile(text, &error));
    EXPECT_TRUE(std::all_of(error.begin(), error.end(), [](char c) {
      return c >= ' ' && c <= '~';
    })) << error;
  }
}

TEST(ModelFile, TellsWhichModelItDoesNotHave) {
  ModelFile file = Example();
  file.paper.reset();
  std::string error;
  EXPECT_FALSE(MakeModel(file, RateModel::kPaper, &error));
  EXPECT_NE(error.find("\"paper\""), std::string::npos) << error;
}

TEST(BuiltInModel, PredictsPlausibleSizesForEveryMode) {
  std::string error;
  const auto file = ParseModelFile(BuiltInModelFile(), &error);
  ASSERT_TRUE(file) << error;
  for (const RateModel kind : {RateModel::kAdaptive, RateModel::kPaper}) {
    const auto model = MakeBuiltInModel(kind);
    ASSERT_TRUE(model);
    for (const auto& [mode, coefficients] : file->adaptive->modes) {
      SliceFeatures slice = Slice(mode.c_str());
      slice.returns = 20000;
      const double bits = 8 * model->Predict(slice, {0.04, 0, 7}).total() / slice.returns;
      EXPECT_GT(bits, 1) << mode;
      EXPECT_LT(bits, 25) << mode;
    }
  }
}

}  // namespace
}  // namespace lidar::rate
