// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/range_codec.h"

#include <gtest/gtest.h>

#include <random>

#include "src/base/byte_writer.h"
#include "src/codec/varint.h"
#include "tests/core/codec/round_trips.h"

namespace lidar::codec {
namespace {

class RangeCoders : public ::testing::TestWithParam<test::CodingCase> {};
TEST_P(RangeCoders, GiveBackTheBinsTheyWereGiven) { test::ExpectBinsOfRooms(GetParam(), nullptr); }
TEST_P(RangeCoders, GiveBackNoise) { test::ExpectBinsOfNoise(GetParam(), nullptr); }
INSTANTIATE_TEST_SUITE_P(All, RangeCoders,
                         ::testing::Values(test::CodingCase{RangeCoder::kAdaptive, 41, 0},
                                           test::CodingCase{RangeCoder::kAdaptive, 41, 5},
                                           test::CodingCase{RangeCoder::kAdaptive, 1.01, 0},
                                           test::CodingCase{RangeCoder::kAdaptive, 40.5, 0},
                                           test::CodingCase{RangeCoder::kAdaptive, 41, 8},
                                           test::CodingCase{RangeCoder::kAdaptive, 1, 1},
                                           test::CodingCase{RangeCoder::kAdaptive, 65'535, 8},
                                           test::CodingCase{RangeCoder::kBlended, 41, 0},
                                           test::CodingCase{RangeCoder::kBlended, 40.5, 5},
                                           test::CodingCase{RangeCoder::kBlended, 1, 8}));

// The encoder computes bins in floating point, but must find the same bins as the grid.
TEST(RangeEncoders, PutRangesAtTheEdgesOfBinsWhereTheGridPutsThem) {
  const SensorModel model = test::RoomSensor(1);
  test::Codec codec(model);
  for (std::uint32_t cells = 1; cells < 120; ++cells) {
    RangeImage image;
    image.beams = 1;
    image.columns = 510;
    for (std::uint32_t k = 1; k <= 170; ++k)
      for (const std::uint32_t beside : {0U, 1U, 2U})
        image.ranges.push_back(k * k * cells + beside - (k * k * cells > 1 ? 1 : 0));
    image.intensity.resize(image.ranges.size());
    test::ExpectRoundTrip(image, {RangeCoder::kAdaptive, RangeGrid(1, cells), {}}, &codec);
  }
}

class CodersByRans : public ::testing::TestWithParam<RangeCoder> {};

struct Piece {
  unsigned lane;
  unsigned symbol;
  std::uint32_t bits;
  unsigned count;
  std::uint32_t more;  // is written as plain bits after the symbol 3
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

/// A damaged stream is a valid stream of other symbols, so the decoder does not notice all damage.
/// It also reads the same number of words, so only its final states show the damage.
TEST(Rans, NoticesMostFlippedBitsOfSymbolsByTheStatesAtTheEnd) {
  constexpr unsigned kSymbols = 40;
  RansEncoder encoder;
  encoder.Start(kSymbols);
  NibbleModel model;
  {
    RansEncoder::Writer writer(&encoder);
    for (unsigned i = 0; i < kSymbols; ++i) writer.Put(i % kRansLanes, i * i % 7, &model);
  }
  std::vector<std::uint8_t> bytes;
  encoder.Finish(&bytes);
  std::size_t passed = 0;
  for (std::size_t bit = 8; bit < 8 * bytes.size(); ++bit) {  // The first byte has the sizes.
    auto damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    std::vector<std::uint8_t> padded;
    RansDecoder decoder({damaged.data(), damaged.size()}, kSymbols, &padded);
    NibbleModel again;
    for (unsigned i = 0; i < kSymbols; ++i) {
      decoder.Get(i % kRansLanes, &again);
      decoder.GetBits(i % kRansLanes, 0);
    }
    passed += decoder.AtEnd() ? 1U : 0U;
  }
  EXPECT_LT(passed, bytes.size() / 4);
}

INSTANTIATE_TEST_SUITE_P(All, CodersByRans,
                         ::testing::Values(RangeCoder::kAdaptive, RangeCoder::kBlended));
TEST_P(CodersByRans, RefuseAWordBehindTheEnd) {
  test::ExpectNoWordBehind(GetParam(), nullptr, &RangeHeader::payload_size);
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

TEST(Varints, HoldNumbersBelow2ToThe28InFourBytesAtMost) {
  for (const auto& [number, size] :
       {std::pair(0U, 1U), std::pair(127U, 1U), std::pair(128U, 2U), std::pair(16'383U, 2U),
        std::pair(16'384U, 3U), std::pair((1U << 28) - 1, 4U)}) {
    std::vector<std::uint8_t> bytes;
    ByteWriter writer(&bytes);
    WriteVarint(number, &writer);
    EXPECT_EQ(bytes.size(), size) << number;
    ByteReader reader(bytes.data(), bytes.size());
    bool ok = true;
    EXPECT_EQ(ReadVarint(&reader, &ok), number);
    EXPECT_TRUE(ok && reader.ok() && reader.remaining() == 0) << number;
  }
  for (const std::vector<std::uint8_t>& longer :
       {std::vector<std::uint8_t>{128, 128, 128, 128, 0},
        std::vector<std::uint8_t>{255, 255, 255, 255, 1}}) {
    ByteReader reader(longer.data(), longer.size());
    bool ok = true;
    ReadVarint(&reader, &ok);
    EXPECT_FALSE(ok);
  }
}

class HostileHeaders : public ::testing::Test {
 protected:
  /// Returns true if a header can be read from `bytes`.
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

TEST_F(HostileHeaders, AreReadUpToTheirLimitsAndNotBeyond) {
  struct Numbers {
    unsigned bits = 5, full = 1;
    std::uint32_t beams = 32, first_column = 0, columns = 64, payload = 0;
  };
  const auto reads = [](const Numbers& n) {
    std::vector<std::uint8_t> bytes;
    ByteWriter writer(&bytes);
    writer.U8(static_cast<std::uint8_t>(RangeHeader::kVersion << 4 |
                                        static_cast<unsigned>(RangeCoder::kAdaptive)));
    writer.U8(static_cast<std::uint8_t>(n.bits | n.full << 4));
    for (const std::uint32_t number :
         {n.beams, n.first_column, n.columns, 1U, RangeGrid::kParts, n.payload})
      WriteVarint(number, &writer);
    writer.U8(0);  // the only byte of the payload
    return Reads(bytes);
  };
  constexpr std::uint32_t kBeams = RangeHeader::kMaxBeams;
  constexpr std::uint32_t kColumns = RangeHeader::kMaxColumns;
  for (const Numbers& n :
       {Numbers{}, Numbers{0}, Numbers{8}, Numbers{5, 0}, Numbers{5, 2}, Numbers{5, 1, 1},
        Numbers{5, 1, kBeams}, Numbers{5, 1, 32, kColumns - 1}, Numbers{5, 1, 32, 0, 1},
        Numbers{5, 1, 32, 0, kColumns}, Numbers{5, 1, 32, 0, 64, 1}})
    EXPECT_TRUE(reads(n)) << n.bits << n.full << ' ' << n.beams << ' ' << n.columns;
  for (const Numbers& n :
       {Numbers{9}, Numbers{15}, Numbers{5, 3}, Numbers{5, 1, 0}, Numbers{5, 1, kBeams + 1},
        Numbers{5, 1, 32, kColumns}, Numbers{5, 1, 32, 0, 0}, Numbers{5, 1, 32, 0, kColumns + 1},
        Numbers{5, 1, 32, 0, 64, 2}, Numbers{5, 1, 32, 0, 64, 1U << 28}})
    EXPECT_FALSE(reads(n)) << n.bits << n.full << ' ' << n.beams << ' ' << n.columns;
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
    bytes[bytes.size() - 2] = kept;  // the byte before the length of the payload
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
