// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests which slices are complete, given the sequence numbers of the packets that arrived.
#include "src/rtp/delivery.h"

#include <gtest/gtest.h>

namespace lidar::rtp {
namespace {

constexpr std::uint32_t kSsrc = 0x1234;

/// Sends the slices 0, 1, ... of one scan. Each slice has `packets` packets. The first packet has
/// the sequence number `seq`.
void Send(Delivery* delivery, std::uint16_t seq, std::uint32_t slices, std::uint32_t packets,
          std::uint32_t scan = 7) {
  for (std::uint32_t slice = 0; slice < slices; ++slice)
    for (std::uint32_t i = 0; i < packets; ++i)
      delivery->OnSent({kSsrc, seq++, {scan, slice}, i + 1 == packets});
}
std::vector<std::uint32_t> Received(Delivery* delivery, std::uint16_t first, std::uint16_t last,
                                    std::uint32_t ssrc = kSsrc) {
  std::vector<std::uint32_t> indices;
  for (const auto& slice : delivery->OnReceived(ssrc, first, last)) indices.push_back(slice.index);
  return indices;
}
using Slices = std::vector<std::uint32_t>;

TEST(Delivery, TellsOfASliceOnceAllOfItHasArrived) {
  Delivery delivery;
  Send(&delivery, 65'534, 3, 2);  // The sequence numbers wrap.
  EXPECT_EQ(Received(&delivery, 65'534, 65'534), Slices{});
  for (int report = 0; report < 2; ++report) EXPECT_EQ(Received(&delivery, 0, 0), Slices{});
  EXPECT_EQ(Received(&delivery, 65'534, 65'535), Slices{0});
  EXPECT_EQ(Received(&delivery, 65'534, 3), (Slices{1, 2}));
  EXPECT_EQ(Received(&delivery, 65'534, 3), Slices{});
}

TEST(Delivery, WaitsForTheEndOfASliceThatIsStillBeingSent) {
  Delivery delivery;
  delivery.OnSent({kSsrc, 5, {1, 0}, false});
  EXPECT_EQ(Received(&delivery, 5, 5), Slices{});
  delivery.OnSent({kSsrc, 6, {1, 0}, true});
  EXPECT_EQ(Received(&delivery, 6, 6), Slices{0});
}

TEST(Delivery, KnowsNothingOfWhatWasNeverSent) {
  Delivery delivery;
  EXPECT_EQ(Received(&delivery, 0, 65'535), Slices{});
  Send(&delivery, 100, 2, 3);
  EXPECT_EQ(Received(&delivery, 0, 99), Slices{});
  EXPECT_EQ(Received(&delivery, 106, 50), Slices{});
  EXPECT_EQ(Received(&delivery, 100, 105, kSsrc + 1), Slices{});
  EXPECT_EQ(Received(&delivery, 0, 65'535), (Slices{0, 1}));
}

TEST(Delivery, BeginsAnewWithAnotherSsrcOrAJump) {
  Delivery delivery;
  Send(&delivery, 100, 1, 2);
  Send(&delivery, 500, 1, 2);
  EXPECT_EQ(Received(&delivery, 100, 101), Slices{});
  delivery.OnSent({kSsrc + 1, 502, {8, 4}, true});
  EXPECT_EQ(Received(&delivery, 500, 501), Slices{});
  EXPECT_EQ(Received(&delivery, 502, 502, kSsrc + 1), Slices{4});
}

TEST(Delivery, ForgetsTheOldestWhereNothingIsAcknowledged) {
  Delivery delivery;
  const auto all = static_cast<std::uint32_t>(Delivery::kMostPackets);
  Send(&delivery, 0, all + 10, 1);
  const auto slices = Received(&delivery, 0, static_cast<std::uint16_t>(all + 9));
  ASSERT_EQ(slices.size(), all);
  EXPECT_EQ(slices.front(), 10U);
}

}  // namespace
}  // namespace lidar::rtp
