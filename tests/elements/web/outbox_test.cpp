// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/outbox.h"

#include <gtest/gtest.h>

namespace lidar::web {
namespace {

Outbox::Item Of(std::uint32_t channel, std::uint32_t number, bool continues = false) {
  auto message = std::make_shared<Message>();
  message->continues = continues;
  message->unix_ns = number;
  return {channel, 10 * channel, message};
}

std::vector<std::uint64_t> Drain(Outbox* outbox) {
  std::vector<std::uint64_t> numbers;
  while (const auto item = outbox->Pop()) numbers.push_back(item->message->unix_ns);
  return numbers;
}

TEST(Outbox, KeepsTheOrder) {
  Outbox outbox;
  EXPECT_FALSE(outbox.Push(Of(1, 1), 5));
  EXPECT_FALSE(outbox.Push(Of(2, 2), 5));
  EXPECT_FALSE(outbox.Push(Of(1, 3), 5));
  const auto first = outbox.Pop();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->channel_id, 1U);
  EXPECT_EQ(first->subscription_id, 10U);
  EXPECT_EQ(Drain(&outbox), (std::vector<std::uint64_t>{2, 3}));
}

TEST(Outbox, TheOldestOfAChannelGivesWayAndNoOther) {
  Outbox outbox;
  EXPECT_FALSE(outbox.Push(Of(2, 0), 2));
  EXPECT_FALSE(outbox.Push(Of(1, 1), 2));
  EXPECT_FALSE(outbox.Push(Of(1, 2), 2));
  EXPECT_TRUE(outbox.Push(Of(1, 3), 2));
  EXPECT_EQ(Drain(&outbox), (std::vector<std::uint64_t>{0, 2, 3}));
  EXPECT_FALSE(outbox.Push(Of(1, 4), 1));
  EXPECT_TRUE(outbox.Push(Of(1, 5), 1));
  EXPECT_EQ(Drain(&outbox), (std::vector<std::uint64_t>{5}));
}

TEST(Outbox, DropsWhatContinuesAMessageThatGaveWay) {
  Outbox outbox;
  EXPECT_EQ(outbox.Push(Of(1, 0, true), 3), 1U);  // the beginning of the message is missing
  for (std::uint32_t i = 1; i <= 3; ++i) EXPECT_EQ(outbox.Push(Of(1, i, i > 1), 3), 0U);
  EXPECT_EQ(outbox.Push(Of(2, 9), 3), 0U);
  EXPECT_EQ(outbox.Push(Of(1, 4, true), 3), 4U);
  EXPECT_EQ(outbox.Push(Of(1, 5, true), 3), 1U);
  EXPECT_EQ(outbox.Push(Of(1, 6), 3), 0U);
  EXPECT_EQ(outbox.Push(Of(1, 7, true), 3), 0U);
  EXPECT_EQ(Drain(&outbox), (std::vector<std::uint64_t>{9, 6, 7}));
}

TEST(Outbox, KeepsANewBeginningWhereTheOldOneGivesWay) {
  Outbox outbox;
  for (std::uint32_t i = 1; i <= 4; ++i) outbox.Push(Of(1, i, i != 1 && i != 3), 4);
  EXPECT_EQ(outbox.Push(Of(1, 5, true), 4), 2U);
  EXPECT_EQ(Drain(&outbox), (std::vector<std::uint64_t>{3, 4, 5}));
}

TEST(Outbox, TakesNothingThatContinuesWhatWentElsewhere) {
  Outbox outbox;
  outbox.Push(Of(1, 1), 4);
  outbox.Skip(1);
  EXPECT_EQ(outbox.Push(Of(1, 2, true), 4), 1U);
  EXPECT_EQ(Drain(&outbox), (std::vector<std::uint64_t>{1}));
  outbox.Push(Of(1, 3), 4);
  outbox.Forget(1);
  EXPECT_EQ(outbox.Push(Of(1, 4, true), 4), 1U);
}

TEST(Outbox, ForgetsAChannel) {
  Outbox outbox;
  for (std::uint32_t i = 0; i < 6; ++i) outbox.Push(Of(i % 2, i), 9);
  outbox.Forget(1);
  EXPECT_EQ(Drain(&outbox), (std::vector<std::uint64_t>{0, 2, 4}));
}

TEST(Topic, HoldsOneMessageAtLeast) {
  Topic topic({});
  EXPECT_EQ(topic.depth(), 1U);
  topic.set_depth(0);
  EXPECT_EQ(topic.depth(), 1U);
  topic.set_depth(8);
  EXPECT_EQ(topic.depth(), 8U);
  EXPECT_FALSE(topic.wanted());
  topic.AddSubscribers(2);
  topic.AddSubscribers(-1);
  EXPECT_TRUE(topic.wanted());
  topic.AddSubscribers(-1);
  EXPECT_FALSE(topic.wanted());
}

}  // namespace
}  // namespace lidar::web
