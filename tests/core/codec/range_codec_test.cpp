// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/range_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "src/codec/slice_decoder.h"
#include "tests/core/codec/test_clouds.h"

namespace lidar::codec {
namespace {

constexpr std::size_t kAnyPoints = 1U << 20;

struct CodingCase {
  RangeCoder coder;
  double cells;  // a bin
  unsigned intensity_bits;
  RangeGrid grid() const { return RangeGrid::ForStep(1e-3 * cells, 1); }
};
class RangeCoders : public ::testing::TestWithParam<CodingCase> {};

/// A pair that goes through all slices of a test: nothing of a slice may reach into the next.
struct Codec {
  explicit Codec(const SensorModel& model) : encoder(model), decoder(model) {}
  RangeEncoder encoder;
  RangeDecoder decoder;
};

void ExpectRoundTrip(const RangeImage& image, const RangeSettings& settings, Codec* codec) {
  RangeEncoder& encoder = codec->encoder;
  RangeDecoder& decoder = codec->decoder;
  std::vector<std::uint8_t> bytes;
  ASSERT_TRUE(encoder.Encode(image, settings, &bytes));
  ByteReader reader(bytes.data(), bytes.size());
  RangeImage back;
  IntensityScale scale;
  ASSERT_TRUE(decoder.Decode(&reader, kAnyPoints, &back, &scale));
  EXPECT_EQ(reader.remaining(), 0U);
  EXPECT_EQ(back.first_column, image.first_column);
  ASSERT_EQ(back.ranges.size(), image.ranges.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t range = image.ranges[i];
    ASSERT_EQ(back.ranges[i], range == 0 ? 0 : settings.grid.RangeOf(settings.grid.BinOf(range)));
    if (settings.intensity.bits() > 0 && range != 0) {
      ASSERT_EQ(back.intensity[i], settings.intensity.Coarsen(image.intensity[i]));
    }
  }
}

TEST_P(RangeCoders, GiveBackTheBinsTheyWereGiven) {
  const CodingCase& c = GetParam();
  const SensorModel model = test::RoomSensor();
  const RangeSettings settings{c.coder, c.grid(),
                               IntensityScale(FullScale::kByte, c.intensity_bits)};
  Codec codec(model);
  ExpectRoundTrip(test::RoomScan(model), settings, &codec);
  ExpectRoundTrip(test::RoomScan(model, 448, 64), settings, &codec);
  ExpectRoundTrip(test::RoomScan(model, 0, 259), settings, &codec);
  ExpectRoundTrip(test::RoomScan(model, 0, 1), settings, &codec);
  codec.decoder = RangeDecoder(model);
  ExpectRoundTrip(test::RoomScan(model, 500, 37), settings, &codec);
}

TEST_P(RangeCoders, GiveBackNoise) {
  const CodingCase& c = GetParam();
  const SensorModel model = test::RoomSensor();
  std::mt19937 random(5);
  Codec codec(model);
  for (const unsigned lost : {0U, 3U, 90U, 100U}) {
    RangeImage image = test::RoomScan(model, 0, lost % 2 == 0 ? 128 : 511);
    for (std::size_t i = 0; i < image.size(); ++i) {
      image.ranges[i] =
          random() % 100 < lost ? 0 : 1 + static_cast<std::uint32_t>(random() % 250'000);
      image.intensity[i] = static_cast<std::uint8_t>(random());
    }
    ExpectRoundTrip(image, {c.coder, c.grid(), IntensityScale(FullScale::kByte, c.intensity_bits)},
                    &codec);
    codec.decoder = RangeDecoder(model);
  }
}
INSTANTIATE_TEST_SUITE_P(
    All, RangeCoders,
    ::testing::Values(
        CodingCase{RangeCoder::kDraco, 41, 0}, CodingCase{RangeCoder::kDraco, 41, 5},
        CodingCase{RangeCoder::kResidual, 41, 0}, CodingCase{RangeCoder::kResidual, 1, 8},
        CodingCase{RangeCoder::kAdaptive, 41, 0}, CodingCase{RangeCoder::kAdaptive, 41, 5},
        CodingCase{RangeCoder::kDraco, 2.75, 0}, CodingCase{RangeCoder::kAdaptive, 1.01, 0},
        CodingCase{RangeCoder::kAdaptive, 40.5, 0}, CodingCase{RangeCoder::kAdaptive, 41, 8},
        CodingCase{RangeCoder::kAdaptive, 1, 1}, CodingCase{RangeCoder::kAdaptive, 65'535, 8}));

struct Piece {
  unsigned lane;
  unsigned symbol;
  std::uint32_t bits;
  unsigned count;
  std::uint32_t more;  // without a symbol
};

std::vector<Piece> RandomPieces(std::size_t count) {
  std::mt19937 random(3);
  std::vector<Piece> pieces(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto r = static_cast<unsigned>(random());
    Piece& piece = pieces[i];
    piece.lane = r >> 30;
    piece.symbol = i < count / 2 ? 7U : r % (1U << (r >> 8) % 5);
    piece.count = (r >> 12) % (kMaxJointBits + 1);
    piece.bits = static_cast<std::uint32_t>(random()) & ((1U << piece.count) - 1);
    piece.more = static_cast<std::uint32_t>(random()) & ((1U << kMaxPlainBits) - 1);
  }
  return pieces;
}

std::vector<std::uint8_t> Coded(const std::vector<Piece>& pieces) {
  RansEncoder encoder;
  encoder.Start(2 * pieces.size());
  NibbleModel model;
  {
    RansEncoder::Writer writer(&encoder);
    for (const Piece& piece : pieces) {
      writer.Put(piece.lane, piece.symbol, &model, piece.bits, piece.count);
      if (piece.symbol == 3) writer.PutBits(piece.lane, piece.more, kMaxPlainBits);
    }
  }
  std::vector<std::uint8_t> bytes;
  encoder.Finish(&bytes);
  return bytes;
}

TEST(Rans, GivesBackEverySymbolWhateverTheModelSaw) {
  const auto pieces = RandomPieces(20'000);
  const auto bytes = Coded(pieces);
  std::vector<std::uint8_t> padded;
  RansDecoder decoder({bytes.data(), bytes.size()}, 2 * pieces.size(), &padded);
  NibbleModel model;
  for (const Piece& piece : pieces) {
    ASSERT_EQ(decoder.Get(piece.lane, &model), piece.symbol);
    ASSERT_EQ(decoder.GetBits(piece.lane, piece.count), piece.bits);
    if (piece.symbol == 3) {
      ASSERT_EQ(decoder.GetBits(piece.lane, kMaxPlainBits), piece.more);
    }
  }
  EXPECT_TRUE(decoder.AtEnd());
  EXPECT_FALSE(decoder.overran());
}

TEST(Rans, NoticesAStreamThatEndsTooEarly) {
  const auto pieces = RandomPieces(2'000);
  const auto bytes = Coded(pieces);
  for (const std::size_t missing :
       {bytes.size(), bytes.size() - 27, bytes.size() / 2, std::size_t{4}, std::size_t{1}}) {
    std::vector<std::uint8_t> padded;
    RansDecoder decoder({bytes.data(), bytes.size() - missing}, 2 * pieces.size(), &padded);
    NibbleModel model;
    for (const Piece& piece : pieces) {
      const unsigned symbol = decoder.Get(piece.lane, &model);
      decoder.GetBits(piece.lane, piece.count);
      if (symbol == 3) decoder.GetBits(piece.lane, kMaxPlainBits);
    }
    EXPECT_FALSE(decoder.AtEnd()) << missing;
  }
}

class Rows : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Rows, AreCodedWholeAndEveryLaneInOrder) {
  const RowLanes row(GetParam());
  std::vector<int> seen(GetParam());
  std::size_t next[kRansLanes];
  for (std::size_t lane = 0; lane < kRansLanes; ++lane) next[lane] = row.Start(lane);
  ForEachInTurns(row, [&](unsigned lane, std::size_t i) {
    ASSERT_EQ(i, next[lane]++);
    ++seen[i];
  });
  EXPECT_EQ(seen, std::vector<int>(GetParam(), 1));
}
INSTANTIATE_TEST_SUITE_P(All, Rows, ::testing::Values(1, 4, 255, 256, 257, 258, 259, 1024, 16'384));

struct StreamCase {
  const char* name;
  Geometry geometry;
  RangeCoder coder;
  unsigned level;
  double most_undetected;  // of the mutations
};
class HostileStreams : public ::testing::TestWithParam<StreamCase> {
 protected:
  CloudFormat Format() const {
    CloudFormat format{test::OrganisedLayout(), 32, test::RoomSensor()};
    return format;
  }
  std::vector<std::uint8_t> Stream() const {
    const StreamCase& c = GetParam();
    const SensorModel model = test::RoomSensor();
    const auto raw = test::RawCloud(model, test::RoomScan(model, 0, 64));
    auto encoder = *SliceEncoder::Create(Format(), c.geometry, c.coder);
    encoder.Load({raw.data(), raw.size()}, 0, true);
    EncodedSlice slice;
    SliceSettings settings;
    settings.level = c.level;
    settings.intensity_bits = 5;
    EXPECT_EQ(encoder.Encode(settings, &slice), SliceResult::kEncoded);
    return slice.bytes;
  }
};

TEST_P(HostileStreams, OfAnyMutationGiveACloudWithinLimitsOrNone) {
  const auto stream = Stream();
  SliceDecoder decoder(Format(), GetParam().geometry, 4096);
  std::mt19937 random(42);
  constexpr int kMutations = 2000;
  int decoded = 0;
  for (int i = 0; i < kMutations; ++i) {
    auto bytes = stream;
    const std::size_t damage = 1 + random() % 4;
    // Half of the hits go where the headers are.
    for (std::size_t k = 0; k < damage; ++k) {
      const std::size_t reach =
          random() % 2 == 0 ? std::min<std::size_t>(64, bytes.size()) : bytes.size();
      bytes[random() % reach] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    const auto shape = decoder.Decode({bytes.data(), bytes.size()});
    if (!shape) continue;
    ++decoded;
    const std::size_t points = std::size_t{shape->width} * shape->height;
    ASSERT_LE(points, 4096U);
    std::vector<std::uint8_t> raw(points * 20);
    decoder.Write(raw.data());
  }
  EXPECT_LE(decoded, GetParam().most_undetected * kMutations);
}

TEST_P(HostileStreams, ThatAreCutOffGiveNothing) {
  const auto stream = Stream();
  SliceDecoder decoder(Format(), GetParam().geometry, 4096);
  for (std::size_t n = 0; n < std::min<std::size_t>(stream.size(), 200); ++n)
    EXPECT_FALSE(decoder.Decode({stream.data(), n})) << n;
  if (GetParam().geometry == Geometry::kRange) {
    EXPECT_FALSE(decoder.Decode({stream.data(), stream.size() - 1}));
  }
  EXPECT_TRUE(decoder.Decode({stream.data(), stream.size()}));
}
// Draco finds hardly any damage by itself: that is what the CRC of the payload format is for. Of
// the adaptive coder's, what passes hit the header: a grid of another step, another first column.
INSTANTIATE_TEST_SUITE_P(
    All, HostileStreams,
    ::testing::Values(StreamCase{"sequential", Geometry::kXyz, RangeCoder::kDraco, 0, 1.0},
                      StreamCase{"kd", Geometry::kXyz, RangeCoder::kDraco, 7, 1.0},
                      StreamCase{"draco", Geometry::kRange, RangeCoder::kDraco, 7, 1.0},
                      StreamCase{"residual", Geometry::kRange, RangeCoder::kResidual, 7, 1.0},
                      StreamCase{"adaptive", Geometry::kRange, RangeCoder::kAdaptive, 7, 0.03}),
    [](const auto& c) { return c.param.name; });

TEST_P(HostileStreams, OfFieldsWithOddTypesStayInsideTheirBuffer) {
  const auto stream = Stream();
  CloudFormat format = Format();
  format.layout.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:U8:12,range:U8:13");
  format.layout.point_step = 14;
  SliceDecoder decoder(format, GetParam().geometry, 4096);
  const auto shape = decoder.Decode({stream.data(), stream.size()});
  ASSERT_TRUE(shape);
  const std::size_t size = std::size_t{shape->width} * shape->height * 14;
  std::vector<std::uint8_t> raw(size + 16, 0xAA);
  decoder.Write(raw.data());
  EXPECT_EQ(std::count(raw.begin() + static_cast<std::ptrdiff_t>(size), raw.end(), 0xAA), 16);
  EXPECT_EQ(raw[12], 0);
  EXPECT_EQ(raw[13], 0);
}

TEST(RangeGrids, AreTheCoarsestThatKeepToAnError) {
  EXPECT_EQ(RangeGrid::ForError(0.02, 1).parts(), RangeGrid(1, 41).parts());
  EXPECT_EQ(RangeGrid::ForError(0.0195, 1).parts(), RangeGrid(1, 39).parts());
  EXPECT_EQ(RangeGrid::ForError(0.02, 8).parts(), RangeGrid(8, 6).parts());
  EXPECT_EQ(RangeGrid::ForError(0.0001, 8).parts(), RangeGrid(8, 1).parts());
  EXPECT_EQ(RangeGrid::ForError(-1, 3).parts(), RangeGrid(3, 1).parts());
}

TEST(RangeGrids, TakeAnyStepDownToTheSensorsUnit) {
  EXPECT_EQ(RangeGrid::ForStep(0.04, 1).parts(), RangeGrid(1, 40).parts());
  EXPECT_EQ(RangeGrid::ForStep(0.012, 8).parts(), 3 * RangeGrid::kParts / 2);
  EXPECT_DOUBLE_EQ(RangeGrid::ForStep(0.012, 8).step_m(), 0.012);
  EXPECT_EQ(RangeGrid::ForStep(0.001, 8).parts(), RangeGrid::kParts);
  EXPECT_EQ(RangeGrid::ForStep(1e9, 8).parts(), RangeGrid(8, RangeGrid::kMaxCells).parts());
}

class GridErrors : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(GridErrors, AreReachedAndNeverPassed) {
  const std::uint32_t unit = GetParam();
  for (std::uint32_t parts = 1; parts <= 44; ++parts) {
    const auto grid = RangeGrid::OfParts(unit, RangeGrid::kParts + parts * 139);
    ASSERT_TRUE(grid.IsValid());
    std::uint32_t worst = 0;
    // The bins of all fractions of a cell repeat after so many.
    for (std::uint32_t r = unit; r < 26 * RangeGrid::kParts * unit; r += unit) {
      const std::uint32_t back = grid.RangeOf(grid.BinOf(r));
      ASSERT_GT(back, 0U) << "a return became a missing one";
      ASSERT_EQ(grid.BinOf(back / unit * unit), grid.BinOf(r)) << "not in the bin it stands for";
      worst = std::max(worst, back > r ? back - r : r - back);
    }
    EXPECT_DOUBLE_EQ(1e-3 * worst, grid.error_m()) << parts;
  }
}

TEST_P(GridErrors, StayWithinTheErrorAskedFor) {
  const std::uint32_t unit = GetParam();
  for (const double error : {0.0005, 0.0015, 0.0195, 0.02, 0.05, 1.0}) {
    const auto grid = RangeGrid::ForError(error, unit);
    EXPECT_LE(grid.error_m(), error);
    EXPECT_GT(RangeGrid::OfParts(unit, grid.parts() + RangeGrid::kParts).error_m(), error);
    // Any finer step keeps to it as well.
    for (std::uint32_t parts = RangeGrid::kParts; parts < grid.parts(); parts += 97)
      ASSERT_LE(RangeGrid::OfParts(unit, parts).error_m(), error + 1e-12) << parts;
  }
}
INSTANTIATE_TEST_SUITE_P(All, GridErrors, ::testing::Values(1U, 3U, 8U));

TEST(RangeGrids, MakeSizesThatFallAsTheStepGrows) {
  const SensorModel model = test::RoomSensor();
  RangeEncoder encoder(model);
  const RangeImage image = test::RoomScan(model);
  double last = 0;
  for (std::uint32_t parts = 8 * RangeGrid::kParts; parts < 12 * RangeGrid::kParts; parts += 32) {
    std::vector<std::uint8_t> bytes;
    ASSERT_TRUE(
        encoder.Encode(image, {RangeCoder::kAdaptive, RangeGrid::OfParts(1, parts), {}}, &bytes));
    const auto size = static_cast<double>(bytes.size());
    if (last > 0) {
      EXPECT_LT(size, 1.005 * last) << parts;
      EXPECT_GT(size, 0.98 * last) << parts;
    }
    last = size;
  }
}

class HostileHeaders : public ::testing::Test {
 protected:
  /// The header of a good block with one of its first bytes replaced.
  static bool Reads(std::vector<std::uint8_t> bytes) {
    ByteReader reader(bytes.data(), bytes.size());
    return RangeHeader::Read(&reader).has_value();
  }
  static std::vector<std::uint8_t> Header(const RangeGrid& grid) {
    RangeHeader header;
    header.beams = 32;
    header.columns = 64;
    header.grid = grid;
    header.coder = RangeCoder::kAdaptive;
    std::vector<std::uint8_t> bytes;
    header.Write(&bytes);
    return bytes;
  }
};

TEST_F(HostileHeaders, OfOtherVersionsAreRefused) {
  auto bytes = Header(RangeGrid(1, 41));
  ASSERT_TRUE(Reads(bytes));
  for (const unsigned version : {0U, 1U, RangeHeader::kVersion + 1U, 15U}) {
    bytes[0] = static_cast<std::uint8_t>(version << 4 | (bytes[0] & 15U));
    EXPECT_FALSE(Reads(bytes)) << version;
  }
}

TEST_F(HostileHeaders, WithAMaskThatTheyDoNotNeedOrLackAreRefused) {
  RangeHeader header;
  header.beams = 32;
  header.columns = 64;
  header.coder = RangeCoder::kDraco;
  header.has_gaps = true;
  for (const std::uint32_t mask_size : {0U, 1U}) {
    header.mask_size = mask_size;
    std::vector<std::uint8_t> bytes;
    header.Write(&bytes);
    EXPECT_FALSE(Reads(bytes)) << "of " << mask_size << " bytes, of which there is none";
    bytes.push_back(0);
    EXPECT_EQ(Reads(bytes), mask_size == 1);
  }
}

TEST_F(HostileHeaders, ThatKeptNoBeamOrMoreThanThereAreAreRefused) {
  RangeHeader header;
  header.beams = 32;
  header.columns = 64;
  header.kept_beams = 31;
  std::vector<std::uint8_t> bytes;
  header.Write(&bytes);
  ByteReader reader(bytes.data(), bytes.size());
  const auto read = RangeHeader::Read(&reader);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->kept_beams, 31U);
  EXPECT_EQ(reader.remaining(), 0U);
  for (const std::uint8_t kept : std::initializer_list<std::uint8_t>{0, 32, 33}) {
    bytes[bytes.size() - 2] = kept;  // before the payload's length
    EXPECT_FALSE(Reads(bytes)) << unsigned{kept};
  }
}

TEST_F(HostileHeaders, WithStepsOutOfTheirLimitsAreRefused) {
  const auto of_parts = [](std::uint32_t unit, std::uint32_t parts) {
    return Reads(Header(RangeGrid::OfParts(unit, parts)));
  };
  constexpr std::uint32_t kMost = RangeGrid::kMaxCells * RangeGrid::kParts;
  EXPECT_TRUE(of_parts(1, RangeGrid::kParts));
  EXPECT_TRUE(of_parts(RangeGrid::kMaxUnitMm, kMost));
  EXPECT_FALSE(of_parts(1, 0));
  EXPECT_FALSE(of_parts(1, RangeGrid::kParts - 1));
  EXPECT_FALSE(of_parts(1, kMost + 1));
  EXPECT_FALSE(of_parts(0, RangeGrid::kParts));
  EXPECT_FALSE(of_parts(RangeGrid::kMaxUnitMm + 1, RangeGrid::kParts));
}

}  // namespace
}  // namespace lidar::codec
