// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "src/ouster/metadata_writer.h"
#include "src/ouster/pixel_projection.h"
#include "src/ouster/point_writer.h"
#include "tests/core/ouster/captures.h"

namespace lidar::ouster {
namespace {

using nlohmann::json;

std::optional<Metadata> Parse(const json& root, std::string* error) {
  return ParseMetadata(root.dump(), error);
}
json Load(const std::string& name) { return json::parse(test::ReadFile(test::DataPath(name))); }

TEST(Metadata, ReadsTheFlatLayoutOfOldClients) {
  const Metadata m = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  EXPECT_EQ(m.product_line, "OS-1-32-G");
  EXPECT_EQ(m.serial, 992101000280ULL);
  EXPECT_EQ(m.init_id, 0U);
  EXPECT_EQ(m.format.profile, Profile::kLegacy);
  EXPECT_EQ(m.format.packet_size(), 6464U);
  EXPECT_EQ(m.format.beams, 32U);
  EXPECT_DOUBLE_EQ(m.scans_per_second, 10);
  EXPECT_EQ(m.model.columns_per_scan, 1024U);
  EXPECT_NEAR(m.model.beam_to_lidar_x_m, 0.015806, 1e-9);
  EXPECT_NEAR(m.model.lidar_to_sensor[11], 0.03618, 1e-9);
  EXPECT_DOUBLE_EQ(m.model.lidar_to_sensor[15], 1);
  EXPECT_EQ(m.model.beams[5].pixel_shift, 16);
  EXPECT_NEAR(m.model.beams[0].altitude_deg, 12.75, 1e-5);
}

TEST(Metadata, ReadsTheSectionsOfNewFirmware) {
  const Metadata m = test::LoadMetadata("windowed_frame1_0.json");
  EXPECT_EQ(m.format.profile, Profile::kRng15Rfl8Nir8);
  EXPECT_EQ(m.format.packet_size(), 8448U);
  EXPECT_EQ(m.init_id, 7109746U);
  EXPECT_EQ(m.timestamp_mode, "TIME_FROM_PTP_1588");
  EXPECT_EQ(m.lidar_port, 53750U);
  EXPECT_EQ(m.window.first, 1U);
  EXPECT_EQ(m.window.count, 256U);
  EXPECT_EQ(m.model.range_unit_mm, 8U);
  EXPECT_NEAR(m.model.beam_to_lidar_x_m, 0.02767, 1e-9);
}

TEST(Metadata, AWindowMayWrap) {
  json root = Load("windowed_frame1_0.json");
  root["lidar_data_format"]["column_window"] = {500, 11};
  std::string error;
  const auto m = Parse(root, &error);
  ASSERT_TRUE(m) << error;
  EXPECT_EQ(m->window.first, 500U);
  EXPECT_EQ(m->window.count, 24U);
}

TEST(Metadata, TellsThatTheStreamIsSentNowhere) {
  json root = Load("windowed_frame1_0.json");
  std::string error;
  EXPECT_FALSE(Parse(root, &error)->switched_off);
  root["config_params"]["udp_port_lidar"] = 0;
  EXPECT_TRUE(Parse(root, &error)->switched_off);
  root["config_params"]["udp_port_lidar"] = 7502;
  root["config_params"]["udp_dest"] = "";
  auto m = Parse(root, &error);
  ASSERT_TRUE(m) << error;
  EXPECT_TRUE(m->switched_off);
  // Points can still be written, because the capture may be newer than the metadata.
  EXPECT_TRUE(PointWriter::Create(*m, {}, &error)) << error;
  root["lidar_data_format"]["udp_profile_lidar"] = "OFF";
  m = Parse(root, &error);
  ASSERT_TRUE(m) << error;
  EXPECT_TRUE(m->switched_off);
  EXPECT_FALSE(PointWriter::Create(*m, {}, &error));
  EXPECT_NE(error.find("switched off"), std::string::npos);
}

TEST(Metadata, TakesRateAndColumnsOfTheModeWhereItHasNone) {
  json root = Load("windowed_frame1_0.json");
  root["config_params"]["lidar_mode"] = "1024x20";
  root["lidar_data_format"]["fps"] = 0;
  root["lidar_data_format"].erase("columns_per_frame");
  std::string error;
  const auto m = Parse(root, &error);
  ASSERT_TRUE(m) << error;
  EXPECT_DOUBLE_EQ(m->scans_per_second, 20);
  EXPECT_EQ(m->model.columns_per_scan, 1024U);
}

TEST(Metadata, MayLackBeamsWindowAndShifts) {
  const json whole = Load("windowed_frame1_0.json");
  const std::size_t beams = whole["beam_intrinsics"]["beam_altitude_angles"].size();
  for (const char* empty : {"", "null"}) {
    json root = whole;
    json& format = root["lidar_data_format"];
    for (const char* key : {"pixels_per_column", "column_window", "pixel_shift_by_row"})
      format.erase(key);
    if (*empty != '\0') format["column_window"] = nullptr;
    std::string error;
    const auto m = Parse(root, &error);
    ASSERT_TRUE(m) << error;
    EXPECT_EQ(m->format.beams, beams);
    EXPECT_EQ(m->window.first, 0U);
    EXPECT_EQ(m->window.count, m->model.columns_per_scan);
    for (const Beam& beam : m->model.beams) EXPECT_EQ(beam.pixel_shift, 0);
  }
}

TEST(Metadata, TellsTheSizeOfPacketsOfTheImu) {
  json root = Load("windowed_frame1_0.json");
  root["imu_data_format"]["imu_measurements_per_packet"] = 8;
  struct Case {
    const char* profile;
    ImuProfile imu;
    std::size_t packet_size;
  };
  for (const auto& [profile, imu, packet_size] :
       {Case{"LEGACY", ImuProfile::kLegacy, 48}, Case{"OFF", ImuProfile::kOff, 0},
        Case{"ACCEL32_GYRO32_NMEA", ImuProfile::kAccel32Gyro32Nmea, 64 + 100 + 8 * 36}}) {
    root["lidar_data_format"]["udp_profile_imu"] = profile;
    std::string error;
    const auto m = Parse(root, &error);
    ASSERT_TRUE(m) << error;
    EXPECT_EQ(m->imu_profile, imu) << profile;
    EXPECT_EQ(m->imu_packet_size(), packet_size) << profile;
    const auto again = ParseMetadata(WriteMetadata(*m), &error);
    ASSERT_TRUE(again) << error;
    EXPECT_EQ(again->imu_profile, imu) << profile;
  }
}

TEST(Metadata, KnowsWhereTheBeamsOfEachSensorBegin) {
  json root = Load("windowed_frame1_0.json");
  root["beam_intrinsics"].erase("lidar_origin_to_beam_origin_mm");
  root["beam_intrinsics"].erase("beam_to_lidar_transform");
  for (const auto& [line, origin_m] :
       {std::pair("OS-0-128", 0.02767), std::pair("OS-1-32-G", 0.015806),
        std::pair("OS-2-64", 0.013762), std::pair("another", 0.012163)}) {
    root["sensor_info"]["prod_line"] = line;
    std::string error;
    const auto m = Parse(root, &error);
    ASSERT_TRUE(m) << error;
    EXPECT_NEAR(m->model.beam_to_lidar_x_m, origin_m, 1e-9) << line;
  }
}

TEST(Metadata, OfScansLargerThanAnySensorsIsRefused) {
  json root = Load("windowed_frame1_0.json");
  root["lidar_data_format"]["columns_per_frame"] = SensorModel::kMaxColumns;
  root["lidar_data_format"]["pixels_per_column"] = SensorModel::kMaxBeams;
  root["lidar_data_format"]["columns_per_packet"] = 1;
  std::string error;
  EXPECT_FALSE(Parse(root, &error));
  EXPECT_EQ(error, "lidar_data_format describes scans larger than any sensor's");
}

TEST(Metadata, PixelsMayHaveAnglesOfTheirOwn) {
  Metadata m = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  const std::size_t pixels = std::size_t{32} * 1024;
  for (std::size_t i = 0; i < pixels; ++i) {
    m.pixel_angles.azimuth_deg.push_back(60.0F - static_cast<float>(i % 1024) * 0.125F);
    m.pixel_angles.altitude_deg.push_back(16.0F - static_cast<float>(i / 1024));
  }
  std::string error;
  const auto back = ParseMetadata(WriteMetadata(m), &error);
  ASSERT_TRUE(back) << error;
  EXPECT_EQ(back->pixel_angles.azimuth_deg, m.pixel_angles.azimuth_deg);
  EXPECT_EQ(back->pixel_angles.altitude_deg, m.pixel_angles.altitude_deg);
  // A beam has the azimuth of its pixel in the middle column.
  EXPECT_DOUBLE_EQ(back->model.beams[3].azimuth_deg, 60 - 512 * 0.125);
  EXPECT_DOUBLE_EQ(back->model.beams[3].altitude_deg, 13);
  const PixelProjection projection(*back);
  // Beam 16 has the altitude 0. Column 480 looks along the x axis, which lidar_to_sensor turns to
  // -x.
  const auto p = projection.Point(16, 480, 10'000);
  EXPECT_NEAR(static_cast<double>(p[0]), -10.0, 1e-5);
  EXPECT_NEAR(static_cast<double>(p[1]), 0.0, 1e-5);
  EXPECT_NEAR(static_cast<double>(p[2]), 0.03618, 1e-5);
  const auto left = projection.Direction(0, 0);
  EXPECT_NEAR(static_cast<double>(left[1]), -std::sin(60 * M_PI / 180) * std::cos(16 * M_PI / 180),
              1e-6);
}

struct Damage {
  const char* pointer;
  const char* value;  // in JSON; "" removes the key
};
class BadMetadata : public ::testing::TestWithParam<Damage> {};
TEST_P(BadMetadata, IsRefusedWithAReason) {
  json root = Load("windowed_frame1_0.json");
  const json::json_pointer at(GetParam().pointer);
  root["config_params"].erase("lidar_mode");
  if (*GetParam().value == '\0')
    root[at.parent_pointer()].erase(at.back());
  else
    root[at] = json::parse(GetParam().value);
  std::string error;
  EXPECT_FALSE(Parse(root, &error));
  EXPECT_NE(error, "");
}
INSTANTIATE_TEST_SUITE_P(
    All, BadMetadata,
    ::testing::Values(Damage{"/lidar_data_format/columns_per_frame", "0"},
                      Damage{"/lidar_data_format/columns_per_frame", "-512"},
                      Damage{"/lidar_data_format/columns_per_frame", "1e300"},
                      Damage{"/lidar_data_format/columns_per_frame", "512.5"},
                      Damage{"/lidar_data_format/columns_per_packet", "16.5"},
                      Damage{"/lidar_data_format/columns_per_frame", "\"512\""},
                      Damage{"/lidar_data_format/columns_per_frame", ""},
                      Damage{"/lidar_data_format/fps", "0"},
                      Damage{"/lidar_data_format/fps", "-10"},
                      Damage{"/lidar_data_format/fps", "1e-300"},
                      Damage{"/lidar_data_format/pixels_per_column", "4000000000"},
                      Damage{"/lidar_data_format/pixels_per_column", "64"},
                      Damage{"/lidar_data_format/columns_per_packet", "0"},
                      Damage{"/lidar_data_format/columns_per_packet", "60000"},
                      Damage{"/lidar_data_format/column_window", "[0, 512]"},
                      Damage{"/lidar_data_format/column_window", "[0]"},
                      Damage{"/lidar_data_format/column_window", "\"all\""},
                      Damage{"/lidar_data_format/udp_profile_lidar", "\"RNG99\""},
                      Damage{"/lidar_data_format/pixel_shift_by_row/3", "1e9"},
                      Damage{"/lidar_data_format/pixel_shift_by_row/3", "513"},
                      Damage{"/beam_intrinsics/beam_altitude_angles", "[]"},
                      Damage{"/beam_intrinsics/beam_altitude_angles/7", "\"up\""},
                      Damage{"/beam_intrinsics/beam_altitude_angles/7", "1e9"},
                      Damage{"/beam_intrinsics/beam_altitude_angles/7", "[1, 2]"},
                      Damage{"/beam_intrinsics/beam_azimuth_angles", ""},
                      Damage{"/beam_intrinsics/beam_azimuth_angles", "null"},
                      Damage{"/lidar_intrinsics/lidar_to_sensor_transform", "[1, 2, 3]"},
                      Damage{"/lidar_intrinsics/lidar_to_sensor_transform/3", "null"}));

TEST(Metadata, WhatIsNoJsonObjectIsRefused) {
  std::string error;
  EXPECT_FALSE(ParseMetadata("", &error));
  EXPECT_FALSE(ParseMetadata("[]", &error));
  EXPECT_FALSE(ParseMetadata("{", &error));
  EXPECT_FALSE(ParseMetadata("<html>", &error));
  EXPECT_FALSE(ParseMetadata(std::string(100'000, '['), &error));
  std::string nested;
  for (int i = 0; i < 10'000; ++i) nested += "{\"a\":";
  EXPECT_FALSE(ParseMetadata(nested, &error));
  EXPECT_FALSE(ParseMetadata(std::string(Metadata::kMaxJsonSize + 1, ' '), &error));
}

/// Returns a text of about `size` bytes, in which `piece` is repeated within an object.
std::string Filled(const std::string& piece, std::size_t size) {
  std::string text = "{\"a\":[";
  while (text.size() + 2 * piece.size() + 2 < size) text += piece + ",";
  return text + piece + "]}";
}

/// Returns the processor time for refusing metadata of `bytes` bytes that are filled with `piece`.
/// This is the shortest time of three, because other processes may disturb a measurement.
double CostOf(const char* piece, std::size_t bytes) {
  const std::string text = Filled(piece, bytes);
  double least = 0;
  for (int i = 0; i < 3; ++i) {
    const std::clock_t start = std::clock();
    std::string error;
    EXPECT_FALSE(ParseMetadata(text, &error)) << piece;
    EXPECT_NE(error, "");
    const auto cost = static_cast<double>(std::clock() - start);
    if (i == 0 || cost < least) least = cost;
  }
  return least;
}

TEST(Metadata, TakesTimeLinearInItsSize) {
  for (const char* piece : {"{}", "[]", "[[[[{}]]]]", "\"\"", "0", "{\"\":0}"}) {
    constexpr std::size_t kSmall = 1U << 16;
    constexpr double kGrowth = 16;
    const double small = CostOf(piece, kSmall);
    const double large = CostOf(piece, static_cast<std::size_t>(kGrowth) * kSmall);
    // A parser whose time is quadratic in the size would take kGrowth * kGrowth times as long.
    EXPECT_LT(large, 5 * kGrowth * std::max(small, 1.0)) << piece;
  }
}

TEST(Metadata, HasBoundedNumbersOfStringsListsAndObjects) {
  const std::string text = test::ReadFile(test::DataPath("windowed_frame1_0.json"));
  const auto with = [&](int strings) {
    json root = json::parse(text);
    root["remarks"] = std::vector<std::string>(static_cast<std::size_t>(strings), "x");
    std::string error;
    return Parse(root, &error).has_value();
  };
  EXPECT_TRUE(with(65'000));
  EXPECT_FALSE(with(66'000));
}

TEST(Metadata, OfMoreThanEightMebibytesIsNotLookedAt) {
  const std::string text = test::ReadFile(test::DataPath("windowed_frame1_0.json"));
  std::string error;
  EXPECT_TRUE(ParseMetadata(text + std::string((8U << 20) - text.size(), ' '), &error)) << error;
  EXPECT_FALSE(ParseMetadata(text + std::string((8U << 20) + 1 - text.size(), ' '), &error));
  EXPECT_NE(error.find("larger than any"), std::string::npos) << error;
}

TEST(Metadata, BracketsWithinStringsAreNoDepth) {
  json root = Load("windowed_frame1_0.json");
  root["remark"] = std::string(50, '[') + "\\\"" + std::string(50, '{');
  std::string error;
  EXPECT_TRUE(Parse(root, &error)) << error;
}

TEST(Metadata, KeepTheOriginOfTheBeamsInTheirJson) {
  Metadata m = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  m.model.beam_to_lidar_x_m = 0.0158;
  m.model.beam_to_lidar_z_m = 0.0037;
  std::string error;
  const auto back = ParseMetadata(WriteMetadata(m), &error);
  ASSERT_TRUE(back) << error;
  EXPECT_NEAR(back->model.beam_to_lidar_x_m, 0.0158, 1e-9);
  EXPECT_NEAR(back->model.beam_to_lidar_z_m, 0.0037, 1e-9);
}

TEST(Metadata, OfAnotherScanRateOrWindowHaveAnotherGeometry) {
  const Metadata before = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  std::vector<Metadata> others(3, before);
  EXPECT_TRUE(SameGeometry(before, others[0]));
  others[0].scans_per_second *= 2;
  others[1].window.first = 1;
  others[2].window.count = 512;
  for (const Metadata& other : others) EXPECT_FALSE(SameGeometry(before, other));
}

}  // namespace
}  // namespace lidar::ouster
