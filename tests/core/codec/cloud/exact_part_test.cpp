// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the fields, and the order of points, that must decode exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>

#include "src/cloud/cloud_files.h"
#include "src/codec/cloud/cloud_encoder.h"
#include "src/codec/cloud/exact_decoder.h"

namespace lidar::codec::cloud {
namespace {

constexpr std::uint32_t kMostDecoded = 1U << 20;

/// Names the fields that must decode exactly, and says whether the order of points must be kept.
struct Wish {
  std::vector<std::string> fields;
  bool keeps_order = true;
};

struct Cloud {
  CloudLayout layout;
  std::vector<std::uint8_t> bytes;

  ByteView view() const { return {bytes.data(), bytes.size()}; }
  std::size_t size() const { return bytes.size() / layout.point_step; }
  std::uint64_t Number(std::size_t i, const PointField& field) const {
    std::uint64_t number = 0;
    std::memcpy(&number, &bytes[i * layout.point_step + field.offset], SizeOf(field.type));
    return number;
  }
  Point At(std::size_t i) const {
    Point p;
    std::memcpy(&p, &bytes[i * layout.point_step], sizeof p);
    return p;
  }
  template <class T>
  void Set(std::size_t i, const std::string& name, T value) {
    std::memcpy(&bytes[i * layout.point_step + layout.fields.Find(name)->offset], &value,
                sizeof value);
  }
};

Cloud CloudOf(const std::vector<Point>& points, const std::string& fields) {
  Cloud cloud;
  cloud.layout.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8," + fields);
  cloud.layout.point_step = cloud.layout.fields.MinimumStep();
  cloud.bytes.resize(points.size() * cloud.layout.point_step);
  for (std::size_t i = 0; i < points.size(); ++i)
    std::memcpy(&cloud.bytes[i * cloud.layout.point_step], &points[i], sizeof(Point));
  return cloud;
}

Cloud Shuffled(const Cloud& cloud) {
  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  Cloud shuffled{cloud.layout, {}};
  for (const std::uint32_t i : order) {
    const auto first =
        cloud.bytes.begin() + static_cast<std::ptrdiff_t>(i * cloud.layout.point_step);
    shuffled.bytes.insert(shuffled.bytes.end(), first, first + cloud.layout.point_step);
  }
  return shuffled;
}

ExactChoice ChoiceOf(const Cloud& cloud, const Wish& wish) {
  ExactChoice choice;
  for (const std::string& name : wish.fields)
    choice.fields.push_back(*cloud.layout.fields.Find(name));
  choice.keeps_order = wish.keeps_order;
  return choice;
}

std::vector<std::uint8_t> Encoded(const Cloud& cloud, const Wish& wish, unsigned effort = 1,
                                  unsigned intensity_bits = 0) {
  auto encoder = CloudEncoder::Create(cloud.layout, ChoiceOf(cloud, wish));
  encoder->set_effort(effort);
  encoder->Load(cloud.view(), intensity_bits > 0);
  EncodedSlice slice;
  EXPECT_EQ(encoder->Encode({0.02, 0, intensity_bits}, &slice), SliceResult::kEncoded);
  return slice.bytes;
}

Cloud Decoded(const Cloud& like, const Wish& wish, const std::vector<std::uint8_t>& bytes) {
  ExactDecoder decoder(ChoiceOf(like, wish).fields, kMostDecoded);
  EXPECT_TRUE(decoder.Decode({bytes.data(), bytes.size()}));
  Cloud cloud{like.layout, {}};
  cloud.bytes.resize(decoder.size() * like.layout.point_step);
  decoder.Write(cloud.layout, cloud.bytes.data());
  return cloud;
}

double BitsPerPoint(const Cloud& cloud, const std::vector<std::uint8_t>& bytes) {
  return 8.0 * static_cast<double>(bytes.size()) / static_cast<double>(cloud.size());
}

double Distance(const Point& a, const Point& b) {
  double square = 0;
  for (unsigned k = 0; k < 3; ++k) square += std::pow(static_cast<double>(a[k] - b[k]), 2);
  return std::sqrt(square);
}

/// Expects that each point decodes at its index, with its position and with the values of the
/// fields of `wish`.
void ExpectSame(const Cloud& cloud, const Wish& wish, const Cloud& decoded) {
  ASSERT_EQ(decoded.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LE(Distance(cloud.At(i), decoded.At(i)), 0.02001) << i;
    for (const std::string& name : wish.fields) {
      const PointField& field = *cloud.layout.fields.Find(name);
      ASSERT_EQ(decoded.Number(i, field), cloud.Number(i, field)) << name << " of " << i;
    }
  }
}

/// Returns a scan of a VLP-16 in the format in which Nebula publishes it.
Cloud VelodyneScan() {
  std::ifstream file(LIDARS_FOLDER "/vlp16.pcd", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::string why;
  const auto read =
      ReadPcd({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, &why);
  EXPECT_TRUE(read) << why;
  PointFields fields;
  for (const auto& f : read->fields) fields.Add(f.name, f.type);
  return {{fields, static_cast<std::uint32_t>(read->point_step)},
          {read->points.begin(), read->points.end()}};
}
const Wish kVelodyne = {{"channel", "time_stamp", "return_type"}, true};

class ExactEfforts : public ::testing::TestWithParam<unsigned> {};
TEST_P(ExactEfforts, KeepRingTimeAndOrderOfAVelodyne) {
  const Cloud cloud = VelodyneScan();
  const auto bytes = Encoded(cloud, kVelodyne, GetParam(), 0);
  ExpectSame(cloud, kVelodyne, Decoded(cloud, kVelodyne, bytes));
  const auto plain = Encoded(cloud, {{}, false}, GetParam());
  EXPECT_EQ(plain[0] & 32, 0);
  EXPECT_LE(BitsPerPoint(cloud, bytes) - BitsPerPoint(cloud, plain), 4.5);
}
INSTANTIATE_TEST_SUITE_P(All, ExactEfforts, ::testing::Values(0U, 1U, 3U));

/// Returns the points that a sensor of 16 beams measures in a room, ordered by firing. Some beams
/// have two returns. The last point is too far away for a cell.
Cloud SpinningScan() {
  std::vector<Point> points;
  std::vector<std::pair<int, int>> shots;
  for (int firing = 0; firing < 300; ++firing) {
    for (int beam = 0; beam < 16; ++beam) {
      const double azimuth = firing * 0.6 * M_PI / 180;
      const double elevation = (2.0 * beam - 15) * M_PI / 180;
      const double wall =
          std::min(10 / std::abs(std::cos(azimuth)), 6 / std::abs(std::sin(azimuth)));
      for (int i = 0; i < ((firing + beam) % 20 == 0 ? 2 : 1); ++i) {
        const double rho = wall + 1.5 * i;
        points.push_back({static_cast<float>(rho * std::cos(azimuth)),
                          static_cast<float>(rho * std::sin(azimuth)),
                          static_cast<float>(rho * std::tan(elevation))});
        shots.emplace_back(firing, beam);
      }
    }
  }
  points.push_back({1e30F, 1, 2});
  shots.emplace_back(300, 3);
  Cloud cloud = CloudOf(points, "intensity:F32:12,ring:U16:16,time:F32:18,packet:U32:22");
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud.Set(i, "intensity", static_cast<float>(i % 256));
    const auto [firing, beam] = shots[i];
    cloud.Set(i, "ring", static_cast<std::uint16_t>(beam));
    cloud.Set(i, "time", static_cast<float>(1e-6 * (166 * firing + 2.304 * beam)));
    // The field is a time that restarts with each packet of 24 firings, plus noise.
    const std::uint32_t place = static_cast<std::uint32_t>(firing % 24 * 16 + beam);
    cloud.Set(i, "packet", 10'000 * place + place * 0x9E37'79B1U % 1'000);
  }
  return cloud;
}

TEST(ExactPart, KeepsWhatADriverSaysOfBeamsFurtherReturnsAndFarPoints) {
  const Cloud cloud = SpinningScan();
  const Wish wish = {{"ring", "time"}, true};
  const auto bytes = Encoded(cloud, wish, 1, 8);
  EXPECT_EQ(bytes[0], 0x31);  // The slice has sections of beams and of exact fields.
  const Cloud decoded = Decoded(cloud, wish, bytes);
  ExpectSame(cloud, wish, decoded);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    ASSERT_EQ(decoded.Number(i, *cloud.layout.fields.Find("intensity")),
              cloud.Number(i, *cloud.layout.fields.Find("intensity")));
}

TEST(ExactPart, TakesFewBitsForRegularFields) {
  const Cloud cloud = SpinningScan();
  const double plain = BitsPerPoint(cloud, Encoded(cloud, {{}, false}));
  EXPECT_LE(BitsPerPoint(cloud, Encoded(cloud, {{"ring"}, false})), plain + 0.2);
  EXPECT_LE(BitsPerPoint(cloud, Encoded(cloud, {{"time"}, false})), plain + 2);
  EXPECT_LE(BitsPerPoint(cloud, Encoded(cloud, {{"packet"}, false})), plain + 2);
  EXPECT_LE(BitsPerPoint(cloud, Encoded(cloud, {{}, true})), plain + 0.6);
}

// An earlier encoder wrote the file.
TEST(ExactDecoder, ReadsItsFirstSlicesForEver) {
  std::ifstream file(GOLDEN_CLOUDS_FOLDER "/exact.bin", std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  Cloud cloud = SpinningScan();
  cloud.bytes.resize(4'000 * cloud.layout.point_step);
  const Wish wish = {{"ring", "time", "packet"}, true};
  ExpectSame(cloud, wish, Decoded(cloud, wish, bytes));
}

std::vector<Point> RandomPoints(std::size_t count) {
  std::mt19937 random(11);
  std::vector<Point> points(count);
  for (Point& p : points)
    for (float& v : p) v = 40 * (static_cast<float>(random() % 65'536) / 65'536 - 0.5F);
  return points;
}

// The fields contain arbitrary bits. Among the values are NaN, infinities, both zeros, and the
// limits of each type.
TEST(ExactPart, KeepsAnyNumbersOfAnyTypeInAnyOrder) {
  const std::string types[] = {"I8", "U8", "I16", "U16", "I32", "U32", "F32", "F64"};
  Wish wish;
  std::string fields;
  std::uint32_t offset = 12;
  for (const std::string& type : types) {
    fields += (fields.empty() ? "" : ",") + type + ":" + type + ":" + std::to_string(offset);
    offset += static_cast<std::uint32_t>(std::stoi(type.substr(1)) / 8);
    wish.fields.push_back(type);
  }
  Cloud cloud = CloudOf(RandomPoints(900), fields);
  std::mt19937 random(2);
  constexpr std::uint64_t kOdd[] = {0,
                                    1,
                                    0x8000'0000'8000'0000,
                                    0x7F80'0000'7F80'0000,
                                    0x7FF0'0000'FF80'0000,
                                    0xFFFF'FFFF'FFFF'FFFF,
                                    0x7FFF'FFFF'7FFF'FFFF,
                                    0x7FEF'FFFF'FFFF'FFFF};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint8_t* point = &cloud.bytes[i * cloud.layout.point_step];
    for (std::uint32_t k = 12; k < offset; ++k) point[k] = static_cast<std::uint8_t>(random());
    if (i % 3 == 0) continue;
    for (const std::string& name : wish.fields) {
      const PointField& field = *cloud.layout.fields.Find(name);
      std::memcpy(point + field.offset, &kOdd[random() % std::size(kOdd)], SizeOf(field.type));
    }
  }
  for (const unsigned effort : {0U, 1U, 3U}) {
    SCOPED_TRACE(effort);
    ExpectSame(cloud, wish, Decoded(cloud, wish, Encoded(cloud, wish, effort)));
  }
  const Cloud beams = Shuffled(SpinningScan());
  const Wish spinning = {{"time", "ring"}, true};
  ExpectSame(beams, spinning, Decoded(beams, spinning, Encoded(beams, spinning, 1)));
}

TEST(ExactPart, LeavesOutOnlyWhatIsNoPoint) {
  Cloud cloud = CloudOf({{1, 2, 3}, {0, 0, 0}, {NAN, 1, 2}, {1, 2, 3}, {4, 5, 6}}, "n:U32:12");
  for (std::uint32_t i = 0; i < 5; ++i) cloud.Set(i, "n", 7 * i);
  const Wish wish = {{"n"}, true};
  const Cloud decoded = Decoded(cloud, wish, Encoded(cloud, wish));
  ASSERT_EQ(decoded.size(), 3U);
  const PointField& n = *cloud.layout.fields.Find("n");
  EXPECT_EQ(decoded.Number(0, n), 0U);
  EXPECT_EQ(decoded.Number(1, n), 21U);
  EXPECT_EQ(decoded.Number(2, n), 28U);
}

// The decoder limits the number of values by the size of the slice. The limit must not refuse
// values that take nearly no bytes.
TEST(ExactPart, IsTakenWhereItCostsNextToNothing) {
  const Cloud cloud = CloudOf(std::vector<Point>(1U << 17, Point{1, 2, 3}), "n:U8:12");
  const Wish wish = {{"n"}, false};
  EXPECT_EQ(Decoded(cloud, wish, Encoded(cloud, wish, 0)).size(), cloud.size());
}

TEST(ExactPart, BelongsToThePointsThatAreKeptOfAThinnedCloud) {
  const Cloud cloud = SpinningScan();
  const Wish wish = {{"ring", "time"}, true};
  auto encoder = CloudEncoder::Create(cloud.layout, ChoiceOf(cloud, wish));
  encoder->Load(cloud.view(), false);
  std::vector<bool> kept(cloud.size());
  Cloud expected{cloud.layout, {}};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = i % 3 == 1;
    const auto first =
        cloud.bytes.begin() + static_cast<std::ptrdiff_t>(i * cloud.layout.point_step);
    if (kept[i])
      expected.bytes.insert(expected.bytes.end(), first, first + cloud.layout.point_step);
  }
  encoder->Thin(kept);
  EncodedSlice slice;
  ASSERT_EQ(encoder->Encode({0.02, 0, 0}, &slice), SliceResult::kEncoded);
  ExpectSame(expected, wish, Decoded(cloud, wish, slice.bytes));
}

TEST(ExactDecoder, RefusesASliceWithoutTheFieldsThoughTheOneBeforeHadThem) {
  const Cloud cloud = SpinningScan();
  const Wish wish = {{"ring"}, true};
  const auto with = Encoded(cloud, wish);
  const auto without = Encoded(cloud, {{}, false});
  ExactDecoder decoder(ChoiceOf(cloud, wish).fields, kMostDecoded);
  EXPECT_TRUE(decoder.Decode({with.data(), with.size()}));
  EXPECT_FALSE(decoder.Decode({without.data(), without.size()}));
  ExactDecoder plain({}, kMostDecoded);
  EXPECT_FALSE(plain.Decode({with.data(), with.size()}));
  EXPECT_TRUE(plain.Decode({without.data(), without.size()}));
}

TEST(CloudEncoder, SeesWhereFieldsOrOrderDoNotComeBack) {
  const Cloud cloud = Shuffled(SpinningScan());
  for (const bool keeps_order : {false, true}) {
    const Wish wish = {{"ring", "time"}, keeps_order};
    auto encoder = CloudEncoder::Create(cloud.layout, ChoiceOf(cloud, wish));
    encoder->Load(cloud.view(), false);
    EncodedSlice slice;
    ASSERT_EQ(encoder->Encode({0.02, 0, 0}, &slice), SliceResult::kEncoded);
    ExactDecoder decoder(ChoiceOf(cloud, wish).fields, kMostDecoded);
    ASSERT_TRUE(decoder.Decode({slice.bytes.data(), slice.bytes.size()}));
    EXPECT_TRUE(encoder->HasComeBack(decoder.part()));
    for (std::size_t field = 0; field < 2; ++field) {
      ExactPart other = decoder.part();
      ++other.fields[field].numbers[cloud.size() / 2];
      EXPECT_FALSE(encoder->HasComeBack(other));
    }
    ExactPart fewer = decoder.part();
    fewer.fields.pop_back();
    EXPECT_FALSE(encoder->HasComeBack(fewer));
    if (!keeps_order) continue;
    ExactPart turned = decoder.part();
    std::swap(turned.order.front(), turned.order.back());
    EXPECT_FALSE(encoder->HasComeBack(turned));
  }
}

TEST(ExactDecoder, RefusesSlicesWhoseFieldsAreOthers) {
  const Cloud cloud = SpinningScan();
  const auto decodes = [&](const Wish& has, const Wish& expected) {
    const auto bytes = Encoded(cloud, has);
    return ExactDecoder(ChoiceOf(cloud, expected).fields, kMostDecoded)
        .Decode({bytes.data(), bytes.size()});
  };
  EXPECT_TRUE(decodes({{"ring"}, false}, {{"ring"}, false}));
  EXPECT_TRUE(decodes({{}, false}, {{}, false}));
  EXPECT_TRUE(decodes({{}, true}, {{}, false}));
  EXPECT_FALSE(decodes({{"ring"}, false}, {{"time"}, false}));
  EXPECT_FALSE(decodes({{"ring"}, false}, {{"ring", "time"}, false}));
  EXPECT_FALSE(decodes({{"ring", "time"}, false}, {{"time", "ring"}, false}));
  EXPECT_FALSE(decodes({{"ring"}, true}, {{}, false}));
  EXPECT_FALSE(decodes({{}, false}, {{"ring"}, false}));
}

TEST(CloudDecoder, PassesOverWhatComesBackExactly) {
  const Cloud cloud = SpinningScan();
  const auto bytes = Encoded(cloud, {{"ring", "time"}, true});
  CloudDecoder decoder(kMostDecoded);
  ASSERT_TRUE(decoder.Decode({bytes.data(), bytes.size()}));
  EXPECT_EQ(decoder.cloud().size(), cloud.size());
  EXPECT_FALSE(decoder.exact_section().empty());
}

/// Encodes a section with the order of points, none of which is on a beam.
std::vector<std::uint8_t> SectionOf(const std::vector<std::uint32_t>& order) {
  PointPlaces places;
  places.AddLoose(order.size());
  ExactPart part;
  part.order = order;
  part.keeps_order = true;
  std::vector<std::uint8_t> section;
  EncodeExactPart(places, part, &section);
  return section;
}
bool Decodes(const std::vector<std::uint8_t>& section, std::size_t points,
             std::size_t most_numbers) {
  PointPlaces places;
  places.AddLoose(points);
  ExactPart part;
  return DecodeExactPart({section.data(), section.size()}, places, most_numbers, &part);
}

TEST(ExactPart, ReadsNoMoreNumbersThanItMay) {
  std::vector<std::uint32_t> order(5'000);
  std::iota(order.begin(), order.end(), 0U);
  const auto section = SectionOf(order);
  EXPECT_TRUE(Decodes(section, order.size(), 1U << 20));
  EXPECT_FALSE(Decodes(section, order.size(), order.size()));
  EXPECT_FALSE(Decodes(section, 1U << 20, 1U << 20));
  EXPECT_FALSE(Decodes({0, 33}, 1, 1U << 20));  // more than 32 fields
  EXPECT_FALSE(Decodes({0, 0}, 1, 1U << 20));   // neither fields nor an order
}

TEST(ExactPart, RefusesAnOrderByAFieldThatItDoesNotHave) {
  auto section = SectionOf({0, 1, 2});
  constexpr std::size_t kOrderKey = 2;  // the offset after the flags and the number of fields
  for (const unsigned key : {0U, 1U, 2U, 255U}) {
    section.at(kOrderKey) = static_cast<std::uint8_t>(key);
    EXPECT_EQ(Decodes(section, 3, 1U << 20), key < 2) << key;
  }
}

TEST(ExactPart, RefusesAnOrderThatPutsTwoPointsInOnePlace) {
  EXPECT_TRUE(Decodes(SectionOf({2, 0, 1}), 3, 1U << 20));
  EXPECT_FALSE(Decodes(SectionOf({0, 0, 0}), 3, 1U << 20));
}

// Each place in the order is coded as a step that leads to a long run of places that are already
// taken. A search that tries one place after the other would take minutes.
TEST(ExactPart, DecodesAnOrderFullOfStepsBackInTime) {
  constexpr std::uint32_t kPoints = 1U << 19;
  std::vector<std::uint32_t> order(kPoints);
  for (std::uint32_t i = 0; i < kPoints / 2; ++i) {
    order[kPoints / 2 + i] = i;
    order[i] = kPoints - 1 - i;
  }
  const auto section = SectionOf(order);
  EXPECT_TRUE(Decodes(section, kPoints, 1U << 22));
}

TEST(ExactDecoder, GivesACloudWithinTheLimitsOrNoneForDamagedSlices) {
  Cloud cloud = SpinningScan();
  cloud.bytes.resize(800 * cloud.layout.point_step);
  const Wish wish = {{"ring", "time"}, true};
  const auto bytes = Encoded(cloud, wish);
  ExactDecoder decoder(ChoiceOf(cloud, wish).fields, 800);
  std::vector<std::uint8_t> written(800 * std::size_t{cloud.layout.point_step});
  for (std::size_t n = 0; n < bytes.size(); n += n < 64 ? 1 : 197)
    EXPECT_FALSE(decoder.Decode({bytes.data(), n})) << n;
  std::mt19937 random(7);
  for (int i = 0; i < 150; ++i) {
    auto damaged = bytes;
    damaged[damaged.size() - 1 - random() % (damaged.size() / 2)] ^=
        static_cast<std::uint8_t>(1U << random() % 8);
    if (!decoder.Decode({damaged.data(), damaged.size()})) continue;
    ASSERT_LE(decoder.size(), 800U);
    std::vector<std::uint32_t> order = decoder.part().order;
    ASSERT_EQ(order.size(), decoder.size());
    std::sort(order.begin(), order.end());
    for (std::size_t k = 0; k < order.size(); ++k) ASSERT_EQ(order[k], k);
    decoder.Write(cloud.layout, written.data());
  }
  EXPECT_TRUE(decoder.Decode({bytes.data(), bytes.size()}));
}

}  // namespace
}  // namespace lidar::codec::cloud
