// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/cloud_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "src/base/byte_writer.h"
#include "src/cloud/field_number.h"

namespace lidar {
namespace {

ByteView View(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::optional<FileCloud> Pcd(const std::string& file, std::string* why = nullptr) {
  std::string ignored;
  return ReadPcd(View(file), why != nullptr ? why : &ignored);
}
std::optional<FileCloud> Ply(const std::string& file, std::string* why = nullptr) {
  std::string ignored;
  return ReadPly(View(file), why != nullptr ? why : &ignored);
}

std::string PcdHeader(const std::string& data, int width = 2, int height = 1) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z _ ring\n"
         "SIZE 4 4 4 1 2\nTYPE F F F U U\nCOUNT 1 1 1 2 1\nWIDTH " +
         std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(width * height) + "\nDATA " + data +
         "\n";
}

/// Returns two points in the layout of PcdHeader(): x, y, z, two bytes of padding and ring.
std::vector<std::uint8_t> TwoPoints() {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const float v : {1.0F, -2.5F, 0.25F}) w.LeF32(v);
  w.Le16(0);
  w.Le16(7);
  for (const float v : {4.0F, 5.0F, 6.0F}) w.LeF32(v);
  w.Le16(0);
  w.Le16(65'535);
  return bytes;
}

std::string Text(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

void ExpectTwoPoints(const std::optional<FileCloud>& cloud) {
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->width, 2U);
  EXPECT_EQ(cloud->height, 1U);
  EXPECT_EQ(cloud->point_step, 16U);
  ASSERT_EQ(cloud->fields.size(), 4U);  // does not count the padding
  EXPECT_EQ(cloud->fields[3], (PointField{"ring", FieldType::kU16, 14}));
  EXPECT_EQ(cloud->points, TwoPoints());
}

TEST(Pcd, TextIsRead) {
  ExpectTwoPoints(Pcd(PcdHeader("ascii") + "1 -2.5 2.5e-1 0 0 7\n 4 5\t6 0 0 65535"));
}

TEST(Pcd, OfVersion05IsRead) {
  std::string file = PcdHeader("ascii") + "1 -2.5 2.5e-1 0 0 7\n 4 5\t6 0 0 65535";
  file.replace(file.find("FIELDS"), 6, "COLUMNS");
  ExpectTwoPoints(Pcd(file));
}

TEST(Pcd, BinaryIsRead) { ExpectTwoPoints(Pcd(PcdHeader("binary") + Text(TwoPoints()))); }

TEST(Pcd, CompressedIsRead) {
  // The order is all x, then all y, and so on. LZF encodes them as literals.
  const auto points = TwoPoints();
  std::string planes;
  for (const auto& [offset, size] :
       std::vector<std::pair<int, int>>{{0, 4}, {4, 4}, {8, 4}, {12, 2}, {14, 2}})
    for (int i = 0; i < 2; ++i)
      planes.append(points.begin() + 16 * i + offset, points.begin() + 16 * i + offset + size);
  std::string lzf = "\x1F" + planes;  // the code for 32 literals
  std::vector<std::uint8_t> sizes;
  ByteWriter w(&sizes);
  w.Le32(static_cast<std::uint32_t>(lzf.size()));
  w.Le32(32);
  ExpectTwoPoints(Pcd(PcdHeader("binary_compressed") + Text(sizes) + lzf));
  lzf.back() = 0;
  EXPECT_TRUE(Pcd(PcdHeader("binary_compressed") + Text(sizes) + lzf));
  EXPECT_FALSE(Pcd(PcdHeader("binary_compressed", 3) + Text(sizes) + lzf));
  sizes[4] = 31;  // less than the header needs, although the data would suffice
  EXPECT_FALSE(Pcd(PcdHeader("binary_compressed") + Text(sizes) + lzf));
  sizes[4] = 32;
  EXPECT_FALSE(Pcd(PcdHeader("binary_compressed") + Text(sizes) + lzf.substr(0, 20)));
}

TEST(Pcd, WithoutAPointIsReadInEachForm) {
  for (const std::string form : {"ascii", "binary", "binary_compressed"}) {
    const auto cloud =
        Pcd(PcdHeader(form, 0) + (form == "binary_compressed" ? std::string(8, 0) : ""));
    ASSERT_TRUE(cloud) << form;
    EXPECT_TRUE(cloud->points.empty());
  }
}

TEST(Pcd, CompressedPointsRepeatWhatCameBefore) {
  // The first two bytes are a literal zero. The others mean 79 copies of the byte before.
  const std::vector<std::uint8_t> lzf = {0, 0, 7 << 5, 70, 0};
  const auto file = [&lzf](std::uint32_t size) {
    std::vector<std::uint8_t> bytes;
    ByteWriter w(&bytes);
    w.Le32(size);
    w.Le32(80);
    bytes.insert(bytes.end(), lzf.begin(), lzf.end());
    return PcdHeader("binary_compressed", 5) + Text(bytes);
  };
  const auto cloud = Pcd(file(5));
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->points, std::vector<std::uint8_t>(80));
  EXPECT_FALSE(Pcd(file(4)));
  EXPECT_FALSE(Pcd(file(0)));
}

TEST(Pcd, RowsStayRowsAndNanStaysNan) {
  const auto cloud = Pcd(PcdHeader("ascii", 1, 2) + "nan nan nan 0 0 1\n1 2 3 0 0 2\n");
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->height, 2U);
  float x = 0;
  std::memcpy(&x, cloud->points.data(), 4);
  EXPECT_TRUE(std::isnan(x));
}

TEST(Pcd, SizesThatAreMissingFollowFromTheOthers) {
  const std::string head = "FIELDS x\nSIZE 4\nTYPE F\n";
  const auto size = [&](const std::string& lines, const std::string& points) {
    const auto cloud = Pcd(head + lines + "DATA ascii\n" + points);
    return cloud ? std::pair(cloud->width, cloud->height) : std::pair(99U, 99U);
  };
  EXPECT_EQ(size("POINTS 3\n", "1 2 3"), std::pair(3U, 1U));
  EXPECT_EQ(size("WIDTH 2\n", "1 2"), std::pair(2U, 1U));
  EXPECT_EQ(size("WIDTH 2\nHEIGHT 2\n", "1 2 3 4"), std::pair(2U, 2U));
  EXPECT_EQ(size("", ""), std::pair(0U, 1U));
  EXPECT_EQ(size("WIDTH 2\nHEIGHT 0\n", ""), std::pair(99U, 99U));
}

TEST(Pcd, TextMayEndRightBehindItsLastNumber) {
  const std::string head = "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n";
  EXPECT_TRUE(Pcd(head + "1 2"));
  EXPECT_TRUE(Pcd(head + "+1 +2\n"));
  EXPECT_FALSE(Pcd(head + "1 "));
  EXPECT_FALSE(Pcd(head + "10 "));
}

TEST(Pcd, SaysWhyItCannotBeRead) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"", "its header has no line DATA"},
      {PcdHeader("zip"), "DATA is neither ascii, binary nor binary_compressed"},
      {PcdHeader("binary"), "the file ends before its last point"},
      {PcdHeader("binary", 2'000'000'000), "the cloud is larger than 1 GiB"},
      {PcdHeader("ascii", 2'000'000'000), "the cloud is larger than 1 GiB"},
      {PcdHeader("binary_compressed", 2'000'000'000), "the cloud is larger than 1 GiB"},
      {"FIELDS x a\nSIZE 4 1\nTYPE F U\nCOUNT 1 65533\nPOINTS 1\nDATA ascii\n",
       "a point has too many fields"},
      {"FIELDS x a\nSIZE 4 1\nTYPE F U\nCOUNT 1 32\nPOINTS 1\nDATA ascii\n",
       "a point has too many fields"},
      {PcdHeader("ascii") + "1 2 3", "the file ends before its last point"},
      {PcdHeader("ascii") + "1 2 3 0 0 1 1 2 three 0 0 1 1", "\"three\" is not a number"},
      {PcdHeader("ascii") + "1 1e400 3 0 0 1 4 5 6 0 0 1", "\"1e400\" is not a number"},
      {PcdHeader("ascii") + "1 2,5 3 0 0 1 4 5 6 0 0 1", "\"2,5\" is not a number"},
      {PcdHeader("ascii") + "1 1.#QNAN 3 0 0 1 4 5 6 0 0 1", "\"1.#QNAN\" is not a number"},
      {PcdHeader("ascii") + "1 2 \x80\x3F\x01 0 0 1 4 5 6 0 0 1", "\"???\" is not a number"},
      {PcdHeader("ascii") + "1 2 ~\x7F 0 0 1 4 5 6 0 0 1", "\"~?\" is not a number"},
      {PcdHeader("binary_compressed") + Text({4, 0, 0, 0, 32, 0, 0, 0, 255, 255, 255, 255}),
       "the compressed points are damaged"},
      {"FIELDS x\nSIZE 4 4\nTYPE F\nDATA ascii\n", "FIELDS, SIZE, TYPE and COUNT do not match"},
      {"FIELDS x\nSIZE 4\nTYPE F\nWIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n",
       "WIDTH, HEIGHT and POINTS do not match"},
      {"FIELDS x\nSIZE 4\nTYPE F\nWIDTH 4294967296\nHEIGHT 1\nDATA ascii\n",
       "WIDTH, HEIGHT and POINTS do not match"},
      {"FIELDS x\nSIZE 4\nTYPE F\nWIDTH 1\nHEIGHT 4294967297\nDATA ascii\n1\n",
       "WIDTH, HEIGHT and POINTS do not match"},
      {"FIELDS x\nSIZE 4\nTYPE F\nWIDTH 1\nHEIGHT 0\nDATA ascii\n1\n",
       "WIDTH, HEIGHT and POINTS do not match"},
      {"FIELDS x\nSIZE 4\nTYPE F\nPOINTS 1\nDATA\n1\n", "its header has no line DATA"},
  };
  for (const auto& [file, reason] : bad) {
    std::string why;
    EXPECT_FALSE(Pcd(file, &why));
    EXPECT_EQ(why, reason);
  }
}

std::string PlyHeader(const std::string& format, int vertices = 2) {
  return "ply\nformat " + format + " 1.0\ncomment capture time [s since 1970-01-01T00:00:00Z]: " +
         "1764000000.000000123\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty double z\nproperty uchar i\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST(Ply, TextIsRead) {
  const auto cloud = Ply(PlyHeader("ascii") + "1 2 3 4\n5 6 7 8\n3 0 1 1\n");
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->width, 2U);
  EXPECT_EQ(cloud->point_step, 17U);
  EXPECT_EQ(cloud->points[16], 4);
  EXPECT_EQ(cloud->points[33], 8);
  EXPECT_EQ(cloud->capture_time, 1'764'000'000'000'000'123U);
}

TEST(Ply, NumbersHaveTheTypesThatTheirNamesSay) {
  const std::vector<std::tuple<std::string, std::string, FieldType>> types = {
      {"char", "int8", FieldType::kI8},      {"uchar", "uint8", FieldType::kU8},
      {"short", "int16", FieldType::kI16},   {"ushort", "uint16", FieldType::kU16},
      {"int", "int32", FieldType::kI32},     {"uint", "uint32", FieldType::kU32},
      {"float", "float32", FieldType::kF32}, {"double", "float64", FieldType::kF64}};
  for (const auto& [old_name, name, type] : types)
    for (const std::string& text : {old_name, name}) {
      const auto cloud =
          Ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty " + text + " a\nend_header\n1\n");
      ASSERT_TRUE(cloud) << text;
      EXPECT_EQ(cloud->fields[0].type, type) << text;
    }
}

TEST(Ply, NumbersThatTheirTypeCannotHoldBecomeTheNearestThatItCan) {
  struct Row {
    const char* type;
    FieldType field;
    const char* text;
    double number;
  };
  for (const Row& row :
       {Row{"char", FieldType::kI8, "300", 127}, Row{"char", FieldType::kI8, "-300", -128},
        Row{"uchar", FieldType::kU8, "256", 255}, Row{"uchar", FieldType::kU8, "-1", 0},
        Row{"short", FieldType::kI16, "-4e4", -32'768},
        Row{"ushort", FieldType::kU16, "7e4", 65'535},
        Row{"int", FieldType::kI32, "3e9", 2'147'483'647}, Row{"uint", FieldType::kU32, "-5", 0},
        Row{"uint", FieldType::kU32, "1e300", 4'294'967'295}, Row{"int", FieldType::kI32, "nan", 0},
        Row{"uchar", FieldType::kU8, "6.7", 7}, Row{"float", FieldType::kF32, "6.5", 6.5}}) {
    const auto cloud = Ply("ply\nformat ascii 1.0\nelement vertex 1\nproperty " +
                           std::string(row.type) + " a\nend_header\n" + row.text + "\n");
    ASSERT_TRUE(cloud) << row.text;
    EXPECT_EQ(ReadNumber(cloud->points.data(), row.field), row.number) << row.type << row.text;
  }
}

TEST(Ply, BinaryOfBothByteOrdersIsRead) {
  for (const bool big : {false, true}) {
    const auto cloud =
        Ply(PlyHeader(big ? "binary_big_endian" : "binary_little_endian") + std::string(40, 'x'));
    ASSERT_TRUE(cloud);
    EXPECT_EQ(cloud->is_bigendian, big);
    EXPECT_EQ(cloud->points.size(), 34U);
  }
}

TEST(Ply, SaysWhyItCannotBeRead) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"ply\nformat ascii 1.0\n", "its header has no end_header"},
      {"ply\nelement vertex 1\nend_header\n", "its header has no known format"},
      {"ply\nformat\nelement vertex 1\nproperty float x\nend_header\n1\n",
       "its header has no known format"},
      {"ply\nformat ascii 1.0\nelement vertex\nend_header\n",
       "its vertices are not its first element"},
      {"ply\nformat ascii 1.0\nend_header\n", "its vertices are not its first element"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float\nend_header\n1\n",
       "a property of its vertices is a list or of an unknown type"},
      {"ply\nformat ascii 1.0\nelement face 1\nelement vertex 1\nend_header\n",
       "its vertices are not its first element"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n",
       "a property of its vertices is a list or of an unknown type"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nend_header\n", "there are no fields"},
      {PlyHeader("binary_little_endian", 3) + std::string(40, 'x'),
       "the file ends before its last point"},
  };
  for (const auto& [file, reason] : bad) {
    std::string why;
    EXPECT_FALSE(Ply(file, &why));
    EXPECT_EQ(why, reason);
  }
}

/// A LAS file of two points. The first has the x coordinate `x` * `scale` + `offset`.
struct Las {
  std::uint8_t minor = 2;
  std::uint8_t format = 1;
  std::uint16_t step = 28;
  std::uint32_t points = 2;
  double scale = 0.001;
  double offset = 0;
  std::int32_t x = 1500;

  std::string File() const {
    std::vector<std::uint8_t> bytes;
    ByteWriter w(&bytes);
    const auto skip = [&](std::size_t to) { bytes.resize(to); };
    for (const char c : {'L', 'A', 'S', 'F'}) w.U8(static_cast<std::uint8_t>(c));
    skip(24);
    w.U8(1);
    w.U8(minor);
    skip(94);
    const std::uint16_t header = minor == 4 ? 375 : 227;
    w.Le16(header);
    w.Le32(header);
    w.Le32(0);
    w.U8(format);
    w.Le16(step);
    w.Le32(minor == 4 ? 0 : points);
    skip(131);
    for (int k = 0; k < 3; ++k) w.LeF64(scale);
    for (int k = 0; k < 3; ++k) w.LeF64(offset);
    skip(247);
    if (minor == 4) w.Le64(points);
    skip(header);
    for (std::uint32_t i = 0; i < 2; ++i) {
      const std::size_t begin = bytes.size();
      w.Le32(static_cast<std::uint32_t>(x));
      w.Le32(2000 + i);
      w.Le32(static_cast<std::uint32_t>(-250));
      w.Le16(77);
      skip(begin + step);
    }
    return Text(bytes);
  }
};

std::optional<FileCloud> ReadLasFile(const std::string& file, std::string* why = nullptr) {
  std::string ignored;
  return ReadLas(View(file), why != nullptr ? why : &ignored);
}

float FloatAt(const FileCloud& cloud, std::size_t offset) {
  float v = 0;
  std::memcpy(&v, cloud.points.data() + offset, sizeof v);
  return v;
}

std::uint32_t OffsetOf(const FileCloud& cloud, const std::string& field) {
  for (const PointField& f : cloud.fields)
    if (f.name == field) return f.offset;
  return 0;
}

TEST(Las, RecordsOfAllFormatsAreRead) {
  constexpr std::uint16_t kSteps[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  constexpr std::size_t kFields[] = {7, 8, 10, 11, 8, 11, 8, 11, 12, 8, 12};
  for (std::uint8_t format = 0; format <= 10; ++format) {
    Las las;
    las.minor = format >= 6 ? 4 : 2;
    las.format = format;
    // Some records have extra bytes.
    las.step = static_cast<std::uint16_t>(kSteps[format] + format % 3);
    const auto cloud = ReadLasFile(las.File());
    ASSERT_TRUE(cloud) << int{format};
    EXPECT_EQ(cloud->width, 2U);
    EXPECT_EQ(cloud->point_step, las.step);
    EXPECT_EQ(cloud->fields.size(), kFields[format]) << int{format};
    for (const PointField& f : cloud->fields)
      EXPECT_LE(f.offset + SizeOf(f.type), kSteps[format]) << f.name;
    EXPECT_EQ(FloatAt(*cloud, 0), 1.5F);
    EXPECT_EQ(FloatAt(*cloud, las.step + 4U), 2.001F);
    EXPECT_EQ(FloatAt(*cloud, 8), -0.25F);
    EXPECT_EQ(cloud->points[12], 77);
    const bool is_long = format >= 6;
    EXPECT_EQ(OffsetOf(*cloud, "classification"), is_long ? 16U : 15U) << int{format};
    EXPECT_EQ(OffsetOf(*cloud, "point_source_id"), is_long ? 20U : 18U) << int{format};
    las.step = static_cast<std::uint16_t>(kSteps[format] - 1);
    EXPECT_FALSE(ReadLasFile(las.File())) << int{format};
  }
}

TEST(Las, AClassIsReadWithoutTheFlagsBesideIt) {
  for (const bool is_long : {false, true}) {
    Las las;
    las.minor = is_long ? 4 : 2;
    las.format = is_long ? 6 : 1;
    las.step = is_long ? 30 : 28;
    std::string file = las.File();
    const std::size_t classification = is_long ? 375 + 16 : 227 + 15;
    // Sets the flags withheld, key point and synthetic, and the class ground.
    file[classification] = static_cast<char>(0xE2);
    const auto cloud = ReadLasFile(file);
    ASSERT_TRUE(cloud);
    EXPECT_EQ(cloud->points[OffsetOf(*cloud, "classification")], is_long ? 0xE2 : 2);
  }
}

TEST(Las, PointsOnAMapKeepTheirMillimetres) {
  Las las;
  las.offset = 5'400'000;
  const auto cloud = ReadLasFile(las.File());
  ASSERT_TRUE(cloud);
  EXPECT_EQ(FloatAt(*cloud, 0), 0.5F);  // The origin of the cloud is 5,400,001.
  EXPECT_NEAR(FloatAt(*cloud, 28 + 4), 0.001F, 1e-6);
  EXPECT_EQ(FloatAt(*cloud, 8), 0.75F);
}

TEST(Las, ItsOriginIsWhereItsPointsBeginOnEitherSideOfZero) {
  for (const double offset : {-5'400'000.0, 5'400'000.0}) {
    Las las;
    las.offset = offset;
    const auto cloud = ReadLasFile(las.File());
    ASSERT_TRUE(cloud);
    for (const std::size_t axis : {0U, 4U, 8U}) {
      EXPECT_GE(FloatAt(*cloud, axis), 0) << offset;
      EXPECT_LT(FloatAt(*cloud, axis), 2) << offset;
    }
    EXPECT_NEAR(FloatAt(*cloud, 28 + 4) - FloatAt(*cloud, 4), 0.001F, 1e-6) << offset;
  }
  for (const double offset : {-16'000.0, 16'000.0}) {
    Las las;
    las.offset = offset;
    EXPECT_NEAR(FloatAt(*ReadLasFile(las.File()), 0), offset + 1.5, 1e-3) << "stays";
  }
}

TEST(Las, EachAxisHasAScaleOfItsOwn) {
  std::string file = Las().File();
  constexpr std::size_t kScaleOfZ = 131 + 16;
  const double scale = 0.01;
  std::memcpy(&file[kScaleOfZ], &scale, sizeof scale);
  const auto cloud = ReadLasFile(file);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(FloatAt(*cloud, 0), 1.5F);
  EXPECT_EQ(FloatAt(*cloud, 8), -2.5F);
}

TEST(Las, OfNoPointIsItsHeaderAlone) {
  for (const auto& [minor, size] : {std::pair(2, 227U), std::pair(4, 375U)}) {
    Las las;
    las.minor = static_cast<std::uint8_t>(minor);
    las.points = 0;
    const std::string header = las.File().substr(0, size);
    const auto cloud = ReadLasFile(header);
    ASSERT_TRUE(cloud) << minor;
    EXPECT_EQ(cloud->width, 0U);
    EXPECT_TRUE(cloud->points.empty());
    EXPECT_FALSE(ReadLasFile(header.substr(0, size - 1))) << minor;
  }
}

TEST(Las, SaysWhyItCannotBeRead) {
  const auto with = [](auto change) {
    Las las;
    change(las);
    return las.File();
  };
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"LASF", "its header is cut off"},
      {with([](Las& l) { l.minor = 5; }), "it is not LAS 1.0 to 1.4"},
      {with([](Las& l) { l.format = 0x81; }),
       "its points are compressed (LAZ): convert the file to LAS"},
      {with([](Las& l) { l.format = 11; }),
       "its point format is unknown, or its records are too short for it"},
      {with([](Las& l) { l.scale = std::nan(""); }), "its scale or offset is not a finite number"},
      {with([](Las& l) { l.offset = std::nan(""); }), "its scale or offset is not a finite number"},
      {with([](Las& l) { l.points = 3; }), "the file ends before its last point"},
      {with([](Las& l) { l.points = 2'000'000'000; }), "the cloud is larger than 1 GiB"},
  };
  for (const auto& [file, reason] : bad) {
    std::string why;
    EXPECT_FALSE(ReadLasFile(file, &why));
    EXPECT_EQ(why, reason);
  }
}

std::string Floats(const std::vector<float>& values) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const float v : values) w.LeF32(v);
  return Text(bytes);
}

TEST(Kitti, IsKnownByPlausiblePoints) {
  const std::vector<float> point = {70.5F, -3.25F, -1.7F, 0.5F};
  EXPECT_EQ(TypeOfCloudFile(View(Floats(point))), CloudFileType::kKitti);
  EXPECT_EQ(TypeOfCloudFile(View(Floats({0, 0, 0, 0}))), std::nullopt);
  for (const auto& on_an_axis :
       {Floats({0, 5, 0, 0}), Floats({0, 0, -5, 1}), Floats({70.5F, 0, 0, 1, 0, 0, 0, 0})})
    EXPECT_EQ(TypeOfCloudFile(View(on_an_axis)), CloudFileType::kKitti);
  EXPECT_EQ(TypeOfCloudFile(View(std::string(64, 'a'))), std::nullopt);
  for (const auto& [at, bad] : std::vector<std::pair<std::size_t, float>>{
           {0, 1e6F}, {1, 1e-41F}, {2, NAN}, {3, -1}, {3, 300.0F}, {3, 1e-41F}}) {
    std::vector<float> points = point;
    points.insert(points.end(), point.begin(), point.end());
    points[4 + at] = bad;
    EXPECT_EQ(TypeOfCloudFile(View(Floats(points))), std::nullopt) << at;
  }
}

TEST(Kitti, IsRead) {
  std::string why;
  const auto cloud = ReadKitti(View(Floats({1, 2, 3, 4, 5, 6, 7, 8})), &why);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->width, 2U);
  EXPECT_EQ(cloud->point_step, 16U);
  EXPECT_EQ(cloud->fields[3], (PointField{"intensity", FieldType::kF32, 12}));
  EXPECT_EQ(FloatAt(*cloud, 28), 8);
  EXPECT_FALSE(ReadKitti(View(std::string(17, 'a')), &why));
  EXPECT_EQ(why, "its size is not a multiple of 16 bytes");
  EXPECT_FALSE(ReadKitti({cloud->points.data(), (std::size_t{1} << 30) + 16}, &why));
  EXPECT_EQ(why, "the cloud is larger than 1 GiB");
}

TEST(CloudFiles, LeaveOutFieldsOfNamesOrTypesThatCloudsCannotHave) {
  const auto expect = [](const std::optional<FileCloud>& cloud) {
    ASSERT_TRUE(cloud);
    EXPECT_EQ(cloud->fields,
              (std::vector<PointField>{{"x", FieldType::kF32, 8}, {"~", FieldType::kF32, 16}}));
    EXPECT_EQ(cloud->point_step, 24U);
    EXPECT_EQ(FloatAt(*cloud, 8), 3);
    EXPECT_EQ(FloatAt(*cloud, 16), 5);
  };
  expect(
      Ply("ply\nformat ascii 1.0\nobj_info by hand\nelement vertex 1\nobj_info of six numbers\n"
          "property float a,b\nproperty float c:d\nproperty float x\nproperty float n\x80m\n"
          "property float ~\nproperty float n\x7Fm\nend_header\n1 2 3 4 5 6\n"));
  expect(
      Pcd("FIELDS a,b c:d x n\x80m ~ n\x01m\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nPOINTS 1\n"
          "DATA ascii\n1 2 3 4 5 6\n"));
  expect(
      Pcd("FIELDS long half x _ ~ z\nSIZE 4 4 4 4 4 4\nTYPE FLOAT X F F F f\nPOINTS 1\n"
          "DATA ascii\n1 2 3 4 5 6\n"));
}

TEST(CloudFiles, AreKnownByHowTheyBegin) {
  EXPECT_EQ(TypeOfCloudFile(View("LASF")), CloudFileType::kLas);
  EXPECT_EQ(TypeOfCloudFile(View(PcdHeader("ascii"))), CloudFileType::kPcd);
  EXPECT_EQ(TypeOfCloudFile(View("VERSION .7\nFIELDS x y z\n")), CloudFileType::kPcd);
  EXPECT_EQ(TypeOfCloudFile(View("ply\r\nformat")), CloudFileType::kPly);
  EXPECT_EQ(TypeOfCloudFile(View("")), std::nullopt);
  EXPECT_EQ(TypeOfCloudFile(View("VERSION 2")), std::nullopt);
  EXPECT_EQ(TypeOfCloudFile(View("# .PCD v.5")), CloudFileType::kPcd);
  EXPECT_EQ(TypeOfCloudFile(View("#.PCD v.7")), CloudFileType::kPcd);
  EXPECT_EQ(TypeOfCloudFile(View("ply\n")), CloudFileType::kPly);
  for (const char* none :
       {"ply", "ply format", " ply\n", "# PCD", "LASV", "las", "FIELDS x", "text\nFIELDS x"})
    EXPECT_EQ(TypeOfCloudFile(View(none)), std::nullopt) << none;
}

TEST(CloudFiles, DamageIsSurvived) {
  std::mt19937 random(5);
  const std::vector<std::string> files = {
      PcdHeader("ascii") + "1 -2.5 2.5e-1 0 0 7\n 4 5\t6 0 0 65535",
      PcdHeader("binary") + Text(TwoPoints()),
      PcdHeader("binary_compressed") + std::string(60, '\x21'),
      PlyHeader("ascii") + "1 2 3 4\n5 6 7 8\n3 0 1 1\n", Las().File()};
  for (int round = 0; round < 4'000; ++round) {
    std::string file = files[static_cast<std::size_t>(round) % files.size()];
    for (int i = 0; i < 3; ++i) file[random() % file.size()] = static_cast<char>(random());
    for (const auto& cloud : {Pcd(file), Ply(file), ReadLasFile(file)})
      ASSERT_TRUE(!cloud || cloud->points.size() <= 100 * file.size());
  }
}

}  // namespace
}  // namespace lidar
