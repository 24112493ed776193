// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that a cloud is read equally from each encoding that a file may have.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "src/base/byte_writer.h"
#include "src/cloud/cloud_files.h"

namespace lidar {
namespace {

struct EncodedField {
  std::string name;  // "_" is padding
  char type;         // the type in PCD
  std::uint32_t size;
  std::uint32_t count;
};

/// Returns fields of each type, arrays whose count differs from the size of their elements, and
/// padding.
std::vector<EncodedField> AllFields() {
  return {{"x", 'F', 4, 1}, {"y", 'F', 4, 1},     {"z", 'F', 4, 1}, {"_", 'U', 1, 3},
          {"a", 'I', 1, 2}, {"b", 'U', 2, 4},     {"c", 'I', 2, 1}, {"d", 'U', 4, 2},
          {"e", 'I', 4, 3}, {"stamp", 'F', 8, 2}, {"f", 'U', 1, 1}, {"_", 'U', 1, 2}};
}

/// Returns the number with the index `k` in a point. All numbers of a cloud differ, and each number
/// fits each type.
int NumberAt(int point, int k) { return 25 * point + k + 1; }

void PutNumber(int value, char type, std::uint32_t size, std::vector<std::uint8_t>* out) {
  ByteWriter w(out);
  if (type == 'F' && size == 4) return w.LeF32(static_cast<float>(value));
  if (type == 'F') return w.LeF64(value);
  for (std::uint32_t i = 0; i < size; ++i) w.U8(static_cast<std::uint8_t>(value >> (8 * i)));
}

struct Encodings {
  std::string text, binary, planes;
  std::vector<std::uint8_t> points;
};

Encodings Encode(int points) {
  Encodings all;
  std::vector<std::vector<std::uint8_t>> planes(AllFields().size());
  for (int i = 0; i < points; ++i) {
    int k = 0;
    for (std::size_t f = 0; f < planes.size(); ++f) {
      const EncodedField field = AllFields()[f];
      for (std::uint32_t n = 0; n < field.count; ++n, ++k) {
        all.text += std::to_string(NumberAt(i, k)) + (k % 2 == 0 ? " " : "\t");
        PutNumber(NumberAt(i, k), field.type, field.size, &all.points);
        PutNumber(NumberAt(i, k), field.type, field.size, &planes[f]);
      }
    }
    all.text += "\n";
  }
  all.binary.assign(all.points.begin(), all.points.end());
  for (const auto& plane : planes) all.planes.append(plane.begin(), plane.end());
  return all;
}

/// Compresses the bytes by LZF, with literals only.
std::string Packed(const std::string& bytes) {
  std::string lzf;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string run = bytes.substr(at, 32);
    lzf += static_cast<char>(run.size() - 1);
    lzf += run;
  }
  std::vector<std::uint8_t> sizes;
  ByteWriter w(&sizes);
  w.Le32(static_cast<std::uint32_t>(lzf.size()));
  w.Le32(static_cast<std::uint32_t>(bytes.size()));
  return std::string(sizes.begin(), sizes.end()) + lzf;
}

std::string PcdOf(const std::string& data, const std::string& size) {
  std::string fields = "FIELDS", sizes = "\nSIZE", types = "\nTYPE", counts = "\nCOUNT";
  for (const EncodedField& f : AllFields()) {
    fields += " " + f.name;
    sizes += " " + std::to_string(f.size);
    types += std::string(" ") + f.type;
    counts += " " + std::to_string(f.count);
  }
  return fields + sizes + types + counts + size + "\nDATA " + data + "\n";
}

ByteView Bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class PcdEncoding : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, PcdEncoding,
                         ::testing::Values("ascii", "binary", "binary_compressed"),
                         [](const auto& which) { return which.param; });

TEST_P(PcdEncoding, KeepsEveryNumberOfEveryPointInItsPlace) {
  const Encodings all = Encode(4);
  const std::string data = GetParam() == "ascii"    ? all.text
                           : GetParam() == "binary" ? all.binary
                                                    : Packed(all.planes);
  std::string why;
  const std::string file = PcdOf(GetParam(), "\nWIDTH 2\nHEIGHT 2\nPOINTS 4") + data;
  const auto cloud = ReadPcd(Bytes(file), &why);
  ASSERT_TRUE(cloud) << why;
  EXPECT_EQ(cloud->width, 2U);
  EXPECT_EQ(cloud->height, 2U);
  EXPECT_EQ(cloud->points, all.points);
  std::uint32_t offset = 0;
  std::vector<PointField> expected;
  for (const EncodedField& f : AllFields())
    for (std::uint32_t n = 0; n < f.count; ++n, offset += f.size) {
      const auto type = f.type == 'F'   ? (f.size == 4 ? FieldType::kF32 : FieldType::kF64)
                        : f.type == 'I' ? (f.size == 1   ? FieldType::kI8
                                           : f.size == 2 ? FieldType::kI16
                                                         : FieldType::kI32)
                                        : (f.size == 1   ? FieldType::kU8
                                           : f.size == 2 ? FieldType::kU16
                                                         : FieldType::kU32);
      const std::string name = f.count == 1 ? f.name : f.name + "[" + std::to_string(n) + "]";
      if (f.name != "_") expected.push_back({name, type, offset});
    }
  EXPECT_EQ(cloud->fields, expected);
  EXPECT_EQ(cloud->point_step, offset);
}

TEST_P(PcdEncoding, LacksNothingOfWhatItSays) {
  const Encodings all = Encode(4);
  const std::string data = GetParam() == "ascii"
                               ? all.text.substr(0, all.text.rfind('\t', all.text.size() - 3))
                           : GetParam() == "binary" ? all.binary.substr(0, all.binary.size() - 1)
                                                    : Packed(all.planes.substr(1));
  std::string why;
  const std::string file = PcdOf(GetParam(), "\nWIDTH 4\nHEIGHT 1\nPOINTS 4") + data;
  EXPECT_FALSE(ReadPcd(Bytes(file), &why));
}

TEST(PlyElements, OnlyTheFirstVerticesCount) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n";
  const std::string points = "1\n2\n3 4\n5 6\n7 8\n";
  for (const std::string& more :
       {std::string(), std::string("element vertex 3\nproperty float x\nproperty int y\n"),
        std::string("element edge 3\nproperty int x\nproperty int y\n"),
        std::string("element face 3\nproperty list uchar int x\n")}) {
    std::string why;
    const std::string file = head + more + "end_header\n" + points;
    const auto cloud = ReadPly(Bytes(file), &why);
    ASSERT_TRUE(cloud) << more << why;
    EXPECT_EQ(cloud->width, 2U) << more;
    EXPECT_EQ(cloud->fields, (std::vector<PointField>{{"x", FieldType::kF32, 0}})) << more;
    float last = 0;
    std::memcpy(&last, cloud->points.data() + 4, 4);
    EXPECT_EQ(last, 2) << more;
  }
}

TEST(CaptureTimeOfAFile, IsSecondsAndNineDigitsOrNone) {
  const auto of = [](const std::string& time, bool ply) {
    // The capture time is in the middle of other comments.
    const char* mark = ply ? "comment " : "# ";
    const std::string comment = "of a sensor\n" + std::string(mark) +
                                "capture time [s since 1970-01-01T00:00:00Z]: " + time + "\n" +
                                mark + "made by hand\n";
    const std::string pcd_rest = "FIELDS x\nSIZE 4\nTYPE F\nPOINTS 1\nDATA ascii\n1\n";
    const std::string ply_rest = "element vertex 1\nproperty float x\nend_header\n1\n";
    const std::string file =
        ply ? "ply\nformat ascii 1.0\ncomment " + comment + ply_rest : "# " + comment + pcd_rest;
    std::string why;
    const auto cloud = ply ? ReadPly(Bytes(file), &why) : ReadPcd(Bytes(file), &why);
    EXPECT_TRUE(cloud) << why;
    return cloud ? cloud->capture_time : std::nullopt;
  };
  for (const bool ply : {false, true}) {
    EXPECT_EQ(of("1764000000.000000123", ply), 1'764'000'000'000'000'123U);
    EXPECT_EQ(of("1764000000.000000123\r", ply), 1'764'000'000'000'000'123U);
    EXPECT_EQ(of("0.999999999", ply), 999'999'999U);
    EXPECT_EQ(of("9223372035.000000000", ply), 9'223'372'035'000'000'000U);
    for (const char* other :
         {"1764000000", "1764000000.5", "1764000000.0000001234", "1764000000.12345678",
          ".123456789", "-1.123456789", "9223372037.000000000", "1764000000.12345678x", ""})
      EXPECT_EQ(of(other, ply), std::nullopt) << other;
  }
}

/// The headers claim more data than a file may have, or have impossible fields. They are refused
/// whatever follows.
TEST(ClaimsOfHeaders, AreRefusedBeyondTheirLimitsHoweverTheFileGoesOn) {
  const auto pcd = [](const std::string& size, const std::string& count) {
    const std::string file =
        "FIELDS x a\nSIZE 4 " + size + "\nTYPE F U\nCOUNT 1 " + count + "\nPOINTS 0\nDATA binary\n";
    std::string why;
    return ReadPcd(Bytes(file), &why).has_value();
  };
  EXPECT_TRUE(pcd("1", "1"));
  EXPECT_TRUE(pcd("8", "1"));
  for (const char* size : {"0", "9", "4294967297", "-1", "x"}) EXPECT_FALSE(pcd(size, "1")) << size;
  for (const char* count : {"65537", "4294967297", "18446744073709551615", "-1", "x"})
    EXPECT_FALSE(pcd("1", count)) << count;
  const auto vertices = [](const std::string& count) {
    const std::string file = "ply\nformat binary_little_endian 1.0\nelement vertex " + count +
                             "\nproperty uchar x\nend_header\n";
    std::string why;
    const bool read = ReadPly(Bytes(file), &why).has_value();
    return read ? "" : why;
  };
  EXPECT_EQ(vertices("0"), "");
  EXPECT_EQ(vertices("1073741824"), "the file ends before its last point");  // one GiB
  EXPECT_EQ(vertices("1073741825"), "the cloud is larger than 1 GiB");
  for (const char* count : {"2147483648", "4294967296", "18446744073709551616", "-1", "x"})
    EXPECT_NE(vertices(count).find("vertices"), std::string::npos) << count;
}

}  // namespace
}  // namespace lidar
