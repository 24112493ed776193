// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of wrong captures, wrong metadata and wrong packets. Wrong captures and metadata cause a
// clear error. Wrong packets are counted and skipped.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/base/byte_writer.h"
#include "tests/elements/ouster/ouster_support.h"
#include "tests/support/files.h"

namespace lidar::test {
namespace {

using Json = nlohmann::json;

/// A file that exists during the lifetime of the object.
class TempFile {
 public:
  TempFile(const std::string& name, const std::string& bytes)
      : path_(::testing::TempDir() + "ouster_bad_" + name) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~TempFile() { std::remove(path_.c_str()); }
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

Ending RunFile(const std::string& pcap, const std::string& metadata) {
  return Run("ouster_src location=" + pcap + " metadata=" + metadata + " ! fakesink");
}

struct BadInput {
  std::string properties;  // @ is replaced by the folder of the test data
  const char* error;       // part of the expected message
};
class OusterBadInput : public ::testing::TestWithParam<BadInput> {};
TEST_P(OusterBadInput, IsAClearError) {
  std::string properties = GetParam().properties;
  for (std::size_t at; (at = properties.find('@')) != std::string::npos;)
    properties.replace(at, 1, DataPath(""));
  const std::string error = RunToEnd("ouster_src " + properties + " ! fakesink");
  EXPECT_NE(error.find(GetParam().error), std::string::npos) << error;
}
INSTANTIATE_TEST_SUITE_P(
    All, OusterBadInput,
    ::testing::Values(
        BadInput{"", "None of hostname"},
        BadInput{"location=/nowhere.pcap metadata=@crc_test.json", "No such file"},
        BadInput{"location=@crc_test.pcap metadata=/nowhere.json", "Cannot read the metadata"},
        BadInput{"location=/nowhere.pcap", "Cannot read the capture /nowhere.pcap: No such file"},
        BadInput{"location=@README.md metadata=@crc_test.json", "unknown file format"},
        BadInput{"location=@ metadata=@crc_test.json", "s a directory"},
        BadInput{"location=@crc_test.pcap metadata=@README.md", "not a JSON object"},
        BadInput{"location=@crc_test.pcap metadata=@", "Cannot read the metadata"},
        BadInput{"location=@crc_test.pcap metadata=/dev/zero", "larger than any"},
        BadInput{"location=@crc_test.pcap metadata=@OS-0-32-U1_v2.2.0_1024x10_digest.json",
                 "is not the metadata of an Ouster sensor"},
        BadInput{"location=@crc_test.pcap metadata=@OS-1-32-G_v2.1.1_1024x10.json",
                 "34 datagrams of 8448 bytes, but the metadata describes packets of 6464 bytes"},
        BadInput{"location=@crc_test.pcap metadata=@OS-1-128_v2.3.0_1024x10.json",
                 "packets of another sensor"},
        BadInput{"location=@crc_test.pcap return=second", "has no second return"},
        BadInput{"location=@crc_test.pcap channels=signal", "has no channel signal"},
        BadInput{"location=@crc_test.pcap channels=colour", "there is no channel"},
        BadInput{"location=@crc_test.pcap azimuth-sectors=left", "azimuth-sectors"},
        BadInput{"location=@crc_test.pcap mask-location=@README.md", "not a binary PGM"},
        BadInput{"location=@crc_test.pcap mask-location=/nowhere.pgm", "cannot read the mask"},
        BadInput{"hostname=\"bad host/x?y\"", "is not a host name or an address"},
        BadInput{"hostname=127.0.0.1:1 azimuth-window=5", "azimuth-window must be like"},
        BadInput{"hostname=127.0.0.1:1 azimuth-window=left", "azimuth-window must be like"},
        BadInput{"hostname=127.0.0.1:1 azimuth-window=-1,9", "azimuth-window must be like"},
        BadInput{"hostname=127.0.0.1:1 azimuth-window=9,-1", "azimuth-window must be like"},
        BadInput{"hostname=127.0.0.1:1 azimuth-window=1,2,3", "azimuth-window must be like"},
        BadInput{"metadata=@crc_test.json multicast-group=239.1.1.1 multicast-iface=nope0 "
                 "lidar-port=" +
                     std::to_string(FreePort()),
                 "no network interface \"nope0\""},
        BadInput{"location=@crc_test.pcap min-range=3 max-range=3", "max-range"},
        BadInput{"location=@crc_test.pcap min-range=9 max-range=3", "max-range"}));

/// Returns the header of a pcap file with the link type `link`.
std::string PcapHeader(std::uint32_t link) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  w.Le32(0xa1b2c3d4);
  w.Le32(0x00040002);
  w.Zeros(8);
  w.Le32(65535);
  w.Le32(link);
  return {bytes.begin(), bytes.end()};
}

/// Converts a pcap file to pcapng, with timestamps in microseconds.
std::string ToPcapng(const std::string& pcap) {
  std::vector<std::uint8_t> out;
  ByteWriter w(&out);
  const auto block = [&](std::uint32_t type, const std::vector<std::uint8_t>& body) {
    const auto size = static_cast<std::uint32_t>(body.size() + 12);
    w.Le32(type);
    w.Le32(size);
    w.Bytes({body.data(), body.size()});
    w.Le32(size);
  };
  block(0x0a0d0d0a, {0x4d, 0x3c, 0x2b, 0x1a, 1, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255});
  block(1, {1, 0, 0, 0, 0, 0, 4, 0});
  const ByteView in{reinterpret_cast<const std::uint8_t*>(pcap.data()), pcap.size()};
  ByteReader r(in);
  r.Skip(24);
  while (r.remaining() > 0) {
    const std::uint64_t whole_seconds = r.Le32() * 1'000'000ULL;
    const std::uint64_t time = whole_seconds + r.Le32();
    const std::uint32_t size = r.Le32();
    r.Skip(4);
    std::vector<std::uint8_t> body;
    ByteWriter b(&body);
    b.Le32(0);
    b.Le32(static_cast<std::uint32_t>(time >> 32));
    b.Le32(static_cast<std::uint32_t>(time));
    b.Le32(size);
    b.Le32(size);
    b.Bytes(r.Bytes(size));
    b.Zeros((4 - size % 4) % 4);
    block(6, body);
  }
  return {out.begin(), out.end()};
}

TEST(OusterCapture, MayBePcapng) {
  const TempFile file("good.pcapng", ToPcapng(ReadFile(DataPath("crc_test.pcap"))));
  const Ending ending = RunFile(file.path(), DataPath("crc_test.json"));
  EXPECT_EQ(ending.error, "");
  EXPECT_EQ(ending.warnings, "");
}

TEST(OusterCapture, HasItsMetadataBesideIt) {
  const TempFolder folder;
  const std::string dotted = folder.path() + "/run.2";
  std::filesystem::create_directory(dotted);
  std::filesystem::copy(DataPath("crc_test.json"), dotted + "/drive.json");
  for (const char* name : {"/drive.pcap", "/drive"}) {
    std::filesystem::copy(DataPath("crc_test.pcap"), dotted + name);
    EXPECT_EQ(RunToEnd("ouster_src location=" + dotted + name + " ! fakesink"), "") << name;
  }
}

TEST(OusterCapture, OfWhichTheEndIsMissingGivesWhatItHasAndWarns) {
  const std::string pcap = ReadFile(DataPath("crc_test.pcap"));
  for (const std::string& bytes : {pcap, ToPcapng(pcap)}) {
    const TempFile file("short.pcap", bytes.substr(0, bytes.size() - 5000));
    const Ending ending = RunFile(file.path(), DataPath("crc_test.json"));
    EXPECT_EQ(ending.error, "");
    EXPECT_NE(ending.warnings.find("is cut short"), std::string::npos) << ending.warnings;
  }
}

TEST(OusterCapture, OfWhichTheEndIsMissingMayLoop) {
  const std::string pcap = ReadFile(DataPath("crc_test.pcap"));
  const TempFile file("short.pcap", pcap.substr(0, pcap.size() - 5000));
  const Ending ending = test::Run("ouster_src loop=true num-buffers=40 location=" + file.path() +
                                  " metadata=" + DataPath("crc_test.json") + " ! fakesink");
  EXPECT_EQ(ending.error, "");
  EXPECT_EQ(ending.warnings.find("is cut short"), ending.warnings.rfind("is cut short"));
  EXPECT_NE(ending.warnings.find("is cut short"), std::string::npos);
}

TEST(OusterCapture, OfAnotherLinkTypeIsAClearError) {
  const TempFile file("radio.pcap", PcapHeader(127));
  const Ending ending = RunFile(file.path(), DataPath("crc_test.json"));
  EXPECT_NE(ending.error.find("802.11"), std::string::npos) << ending.error;
  EXPECT_NE(ending.error.find("tcpdump"), std::string::npos) << ending.error;
}

TEST(OusterCapture, WithoutDatagramsIsAClearError) {
  for (const std::string& bytes : {PcapHeader(1), std::string()}) {
    const TempFile file("empty.pcap", bytes);
    const Ending ending = RunFile(file.path(), DataPath("crc_test.json"));
    EXPECT_NE(ending.error, "");
    EXPECT_NE(ending.error.find(bytes.empty() ? "truncated" : "no whole UDP datagrams"),
              std::string::npos)
        << ending.error;
  }
}

TEST(OusterCapture, OfAnotherInitIdIsReadWithAWarning) {
  Json root = Json::parse(ReadFile(DataPath("crc_test.json")));
  root["sensor_info"]["initialization_id"] =
      (root["sensor_info"]["initialization_id"].get<int>() + 1) % 0xffffff;
  const TempFile file("init.json", root.dump());
  const Ending ending = RunFile(DataPath("crc_test.pcap"), file.path());
  EXPECT_EQ(ending.error, "");
  EXPECT_NE(ending.warnings.find("restarted or reconfigured"), std::string::npos)
      << ending.warnings;
}

struct Hostile {
  const char* pointer;
  const char* value;  // JSON, or invalid text
  const char* error;  // part of the expected message
};
class OusterHostileMetadata : public ::testing::TestWithParam<Hostile> {};
TEST_P(OusterHostileMetadata, IsAClearError) {
  Json root = Json::parse(ReadFile(DataPath("windowed_frame1_0.json")));
  root[Json::json_pointer(GetParam().pointer)] = "@HERE@";
  std::string text = root.dump();
  const std::string mark = "\"@HERE@\"";
  text.replace(text.find(mark), mark.size(), GetParam().value);
  const TempFile file("hostile.json", text);
  const Ending ending = RunFile(DataPath("windowed_frame1.pcap"), file.path());
  EXPECT_NE(ending.error.find(GetParam().error), std::string::npos) << ending.error;
  EXPECT_NE(ending.error.find("api/v1/sensor/metadata"), std::string::npos) << ending.error;
}
INSTANTIATE_TEST_SUITE_P(
    All, OusterHostileMetadata,
    ::testing::Values(
        Hostile{"/lidar_data_format/columns_per_packet", "0", "columns_per_packet"},
        Hostile{"/lidar_data_format/columns_per_packet", "-16", "columns_per_packet"},
        Hostile{"/lidar_data_format/columns_per_packet", "1e18", "columns_per_packet"},
        Hostile{"/lidar_data_format/pixels_per_column", "100000", "pixels_per_column"},
        Hostile{"/lidar_data_format/fps", "NaN", "not a JSON object"},
        Hostile{"/beam_intrinsics/beam_altitude_angles/3", "NaN", "not a JSON object"},
        Hostile{"/beam_intrinsics/beam_altitude_angles/3", "1e999", "not a JSON object"},
        Hostile{"/beam_intrinsics/beam_altitude_angles/3", "-1e30", "beam_altitude_angles"},
        Hostile{"/beam_intrinsics/beam_azimuth_angles", "[[[[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]]]",
                "not a JSON object"},
        Hostile{"/lidar_data_format/column_window", "[-1, 12]", "column_window"},
        Hostile{"/lidar_data_format/udp_profile_lidar", "\"RNG99\"", "RNG99 is not known"}));

TEST(OusterHostile, AnAngleListOfAMillionIsRefusedAtOnce) {
  Json root = Json::parse(ReadFile(DataPath("windowed_frame1_0.json")));
  root["beam_intrinsics"]["beam_azimuth_angles"] = std::vector<int>(1'000'000, 1);
  const TempFile file("million.json", root.dump());
  const Ending ending = RunFile(DataPath("windowed_frame1.pcap"), file.path());
  EXPECT_NE(ending.error.find("beam_azimuth_angles must be a list"), std::string::npos)
      << ending.error;
}

}  // namespace
}  // namespace lidar::test
