// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/websocket.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "src/base/byte_writer.h"

namespace lidar::foxglove {
namespace {

constexpr std::size_t kMax = 1000;

struct Options {
  bool final = true;
  bool masked = true;
  std::uint8_t reserved = 0;
};

std::vector<std::uint8_t> Masked(Opcode opcode, const std::string& text, Options options = {}) {
  std::vector<std::uint8_t> frame;
  AppendFrameHeader(opcode, text.size(), &frame);
  if (!options.final) frame[0] &= 0x7F;
  frame[0] |= options.reserved;
  if (options.masked) frame[1] |= 0x80;
  const std::array<std::uint8_t, 4> mask = {0x12, 0x34, 0x56, 0x78};
  if (options.masked) frame.insert(frame.end(), mask.begin(), mask.end());
  for (std::size_t i = 0; i < text.size(); ++i)
    frame.push_back(static_cast<std::uint8_t>(text[i]) ^ (options.masked ? mask[i % 4] : 0));
  return frame;
}

ByteView ViewOf(const std::vector<std::uint8_t>& bytes) { return {bytes.data(), bytes.size()}; }

std::string Text(const ClientMessage& message) {
  return {message.payload.begin(), message.payload.end()};
}

class LengthsOfFrames : public ::testing::TestWithParam<std::size_t> {};

TEST_P(LengthsOfFrames, AreReadAsTheyAreWritten) {
  const std::string text(GetParam(), 'a');
  MessageReader reader(100'000);
  reader.Append(ViewOf(Masked(Opcode::kText, text)));
  const auto message = reader.Next();
  ASSERT_TRUE(message);
  EXPECT_EQ(Text(*message), text);
  EXPECT_FALSE(reader.Next());
  EXPECT_FALSE(reader.error());
}

INSTANTIATE_TEST_SUITE_P(Sizes, LengthsOfFrames,
                         ::testing::Values(0, 1, 125, 126, 127, 65'535, 65'536));

TEST(MessageReader, TakesBytesOneByOneAndSeveralMessagesAtOnce) {
  auto bytes = Masked(Opcode::kText, "first");
  const auto second = Masked(Opcode::kBinary, "second");
  bytes.insert(bytes.end(), second.begin(), second.end());
  MessageReader at_once(kMax);
  at_once.Append(ViewOf(bytes));
  EXPECT_EQ(Text(*at_once.Next()), "first");
  EXPECT_EQ(Text(*at_once.Next()), "second");
  MessageReader slowly(kMax);
  std::string all;
  for (const std::uint8_t byte : bytes) {
    slowly.Append({&byte, 1});
    if (const auto message = slowly.Next()) all += Text(*message) + ";";
  }
  EXPECT_EQ(all, "first;second;");
}

TEST(MessageReader, JoinsFragmentsWithControlFramesBetween) {
  MessageReader reader(kMax);
  Options first;
  first.final = false;
  reader.Append(ViewOf(Masked(Opcode::kText, "frag", first)));
  reader.Append(ViewOf(Masked(Opcode::kPing, "hello")));
  reader.Append(ViewOf(Masked(Opcode::kContinuation, "ments")));
  const auto ping = reader.Next();
  ASSERT_TRUE(ping);
  EXPECT_EQ(ping->opcode, Opcode::kPing);
  const auto message = reader.Next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->opcode, Opcode::kText);
  EXPECT_EQ(Text(*message), "fragments");
}

struct Bad {
  const char* name;
  std::vector<std::vector<std::uint8_t>> frames;
  CloseCode code;
};

class BadFrames : public ::testing::TestWithParam<Bad> {};

TEST_P(BadFrames, EndTheConnection) {
  MessageReader reader(kMax);
  for (const auto& frame : GetParam().frames) reader.Append(ViewOf(frame));
  EXPECT_FALSE(reader.Next());
  ASSERT_TRUE(reader.error());
  EXPECT_EQ(*reader.error(), GetParam().code);
  reader.Append(ViewOf(Masked(Opcode::kText, "more")));
  EXPECT_FALSE(reader.Next());
}

Options With(bool final, bool masked, std::uint8_t reserved = 0) {
  return {final, masked, reserved};
}

INSTANTIATE_TEST_SUITE_P(
    All, BadFrames,
    ::testing::Values(
        Bad{"unmasked", {Masked(Opcode::kText, "a", With(true, false))}, CloseCode::kProtocolError},
        Bad{"compressed",
            {Masked(Opcode::kText, "a", With(true, true, 0x40))},
            CloseCode::kProtocolError},
        Bad{"unknown_opcode", {Masked(static_cast<Opcode>(3), "a")}, CloseCode::kProtocolError},
        Bad{"continues_nothing", {Masked(Opcode::kContinuation, "a")}, CloseCode::kProtocolError},
        Bad{"begins_within_a_message",
            {Masked(Opcode::kText, "a", With(false, true)), Masked(Opcode::kText, "b")},
            CloseCode::kProtocolError},
        Bad{"fragment_of_a_ping",
            {Masked(Opcode::kPing, "a", With(false, true))},
            CloseCode::kProtocolError},
        Bad{"long_ping", {Masked(Opcode::kPing, std::string(126, 'a'))}, CloseCode::kProtocolError},
        Bad{"too_large", {Masked(Opcode::kText, std::string(kMax + 1, 'a'))}, CloseCode::kTooLarge},
        Bad{"announces_exabytes",
            {{0x82, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 1, 2, 3, 4}},
            CloseCode::kTooLarge},
        Bad{"too_large_together",
            {Masked(Opcode::kText, std::string(kMax, 'a'), With(false, true)),
             Masked(Opcode::kContinuation, "b")},
            CloseCode::kTooLarge}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST(MessageReader, TakesTheOpcodesOfTheProtocolAndNoOther) {
  for (std::uint8_t code = 0; code < 16; ++code) {
    MessageReader reader(kMax);
    reader.Append(ViewOf(Masked(static_cast<Opcode>(code), "a")));
    const bool begins = code == 1 || code == 2 || (code >= 8 && code <= 10);
    EXPECT_EQ(reader.Next().has_value(), begins) << int{code};
    EXPECT_EQ(reader.error().has_value(), !begins) << int{code};
  }
}

TEST(Frames, OfTheServerAreWholeAndNotMasked) {
  EXPECT_EQ(TextFrame("hi"), (std::vector<std::uint8_t>{0x81, 2, 'h', 'i'}));
  EXPECT_EQ(CloseFrame(CloseCode::kGoingAway), (std::vector<std::uint8_t>{0x88, 2, 0x03, 0xE9}));
}

/// RFC 6455, section 5.2, has three forms of a length, and requires the shortest one.
TEST(Frames, TellTheirLengthInTheFewestBytes) {
  const auto head = [](std::uint64_t size) {
    std::vector<std::uint8_t> bytes;
    AppendFrameHeader(Opcode::kBinary, size, &bytes);
    return bytes;
  };
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(head(125), (Bytes{0x82, 125}));
  EXPECT_EQ(head(126), (Bytes{0x82, 126, 0, 126}));
  EXPECT_EQ(head(0xFFFF), (Bytes{0x82, 126, 0xFF, 0xFF}));
  EXPECT_EQ(head(0x10000), (Bytes{0x82, 127, 0, 0, 0, 0, 0, 1, 0, 0}));
}

}  // namespace
}  // namespace lidar::foxglove
