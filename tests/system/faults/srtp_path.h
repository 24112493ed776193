// SPDX-License-Identifier: LGPL-2.1-or-later
// A test setup of a screamsink and a screamsrc with SRTP. The link between them can read and forge
// packets.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <thread>

#include "tests/system/faults/ends.h"
#include "tests/system/faults/fault_link.h"

namespace lidar::test {

inline std::string Key(std::size_t bytes, char digit = '5') {
  return "srtp-key=" + std::string(2 * bytes, digit);
}

struct Path {
  explicit Path(const std::string& sink_options, const std::string& source_options)
      : port(FreePort()),
        link(port),
        receiver(&sent, port, source_options),
        sender(&sent, link.port(), sink_options) {}
  void Play() {
    receiver.pipeline().SetState(GST_STATE_PLAYING);
    sender.pipeline().SetState(GST_STATE_PLAYING);
  }
  std::uint16_t port;
  SentSlices sent;
  FaultLink link;
  ReceivingEnd receiver;
  SendingEnd sender;
};

struct Suite {
  const char* options;
  std::size_t key_bytes;
};
class Srtp : public ::testing::TestWithParam<Suite> {};

/// Ends the stream. Expects that the receiver showed exactly the slices that were sent, and that
/// both ends have ended.
inline void ExpectNothingLost(Path* path) {
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_TRUE(path->sender.pipeline().Finish(std::chrono::seconds(5)));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const Accounts a = path->receiver.accounts();
  EXPECT_EQ(a.received, path->sender.slices_sent());
  EXPECT_EQ(a.slices(), a.received);
  EXPECT_EQ(path->receiver.foreign(), 0U);
  EXPECT_EQ(path->receiver.pipeline().Stat("net", "srtp-refused"), 0U);
  EXPECT_EQ(path->sender.pipeline().Stat("net", "srtp-refused"), 0U);
  EXPECT_EQ(path->sender.pipeline().Stat("net", "packets-lost"), 0U);
}

inline void SetKey(Pipeline& pipeline, const std::string& key) {
  g_object_set(pipeline.Child("net").get(), "srtp-key", key.c_str(), nullptr);
}

/// Waits until the receiver has refused at least `packets` packets.
inline void WaitForRefused(Path& path, std::uint64_t packets) {
  for (int i = 0; i < 3'000; ++i) {
    if (path.receiver.pipeline().Stat("net", "srtp-refused") >= packets) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ADD_FAILURE() << "fewer than " << packets << " packets were refused within 30 s";
}

}  // namespace lidar::test
