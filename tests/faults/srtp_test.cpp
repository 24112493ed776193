// SPDX-License-Identifier: LGPL-2.1-or-later
// SRTP in screamsink and screamsrc, over loopback and through a link that can look and forge.
#include <gtest/gtest.h>

#include <thread>

#include "ends.h"
#include "fault_link.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::string Key(std::size_t bytes, char digit = '5') {
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
TEST_P(Srtp, CarriesTheStreamAndItsFeedbackHidden) {
  const std::string options = GetParam().options + std::string(" ") + Key(GetParam().key_bytes);
  Path path(options, options);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  std::this_thread::sleep_for(seconds(2));
  EXPECT_GT(path.receiver.clouds(), 80U);
  EXPECT_EQ(path.receiver.foreign(), 0U);
  EXPECT_EQ(path.receiver.accounts().lost, 0U);
  // The link sees packets, but no slices in them.
  EXPECT_GT(path.link.counts().packets, 100U);
  EXPECT_LT(path.link.counts().slices, 3U);
  Pipeline& sender = path.sender.pipeline();
  EXPECT_GT(sender.Stat("net", "feedback-accepted"), 20U);
  EXPECT_EQ(sender.Stat("net", "packets-lost"), 0U);
  EXPECT_EQ(sender.Stat("net", "srtp-refused"), 0U);
  EXPECT_EQ(path.receiver.pipeline().Stat("net", "srtp-refused"), 0U);
  // EOS still says goodbye, protected, and the receiver ends.
  EXPECT_TRUE(sender.Finish(seconds(5)));
}
INSTANTIATE_TEST_SUITE_P(Ciphers, Srtp,
                         ::testing::Values(Suite{"srtp-cipher=aes-128-icm", 30},
                                           Suite{"srtp-auth=hmac-sha1-32", 30},
                                           Suite{"srtp-cipher=aes-256-icm", 46},
                                           Suite{"srtp-cipher=aes-128-gcm", 28},
                                           Suite{"srtp-cipher=aes-256-gcm", 44}));

TEST(Srtp, RefusesAnotherKeyWithOneMessage) {
  Path path(Key(30, '5'), Key(30, '6'));
  path.Play();
  std::this_thread::sleep_for(seconds(2));
  EXPECT_EQ(path.receiver.clouds(), 0U);
  EXPECT_GT(path.receiver.pipeline().Stat("net", "srtp-refused"), 50U);
  EXPECT_EQ(path.receiver.pipeline().Messages(GST_MESSAGE_WARNING), 1U);
  EXPECT_EQ(path.receiver.pipeline().Error(), "");
}

TEST(Srtp, RefusesPacketsThatAreNotProtected) {
  Path path("", Key(30));
  path.Play();
  std::this_thread::sleep_for(seconds(2));
  EXPECT_EQ(path.receiver.clouds(), 0U);
  EXPECT_EQ(path.receiver.pipeline().Messages(GST_MESSAGE_WARNING), 1U);
}

TEST(Srtp, RefusesFeedbackThatIsNotAuthenticated) {
  // A receiver without the key cannot read the media, but it answers what looks like RTP.
  Path path(Key(30), "");
  path.Play();
  std::this_thread::sleep_for(seconds(2));
  EXPECT_EQ(path.sender.pipeline().Stat("net", "feedback-accepted"), 0U);
  EXPECT_GT(path.sender.pipeline().Stat("net", "srtp-refused"), 0U);
}

TEST(Srtp, RefusesReplayedPacketsAndCountsThem) {
  Path path(Key(30), Key(30));
  Fault twice;
  twice.duplicate = 1;
  path.link.Set(twice);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  std::this_thread::sleep_for(seconds(2));
  EXPECT_GT(path.receiver.pipeline().Stat("net", "srtp-refused"), 50U);
  EXPECT_EQ(path.receiver.accounts().lost, 0U);
  EXPECT_EQ(path.receiver.pipeline().Stat("depay", "packets-duplicate"), 0U);
}

TEST(Srtp, IsJoinedAfterTheSequenceNumbersWrapped) {
  Path path(Key(30), Key(30));
  g_object_set(path.sender.pipeline().Child("pay").get(), "seqnum-offset", 65'450, nullptr);
  path.sender.pipeline().SetState(GST_STATE_PLAYING);
  std::this_thread::sleep_for(seconds(3));
  path.receiver.pipeline().SetState(GST_STATE_PLAYING);
  EXPECT_LT(path.receiver.NextCloud(seconds(5)), seconds(3));
}

TEST(Srtp, TakesItsKeyFromTheEnvironmentOrAFile) {
  g_setenv("LIDAR_TEST_KEY", std::string(60, '7').c_str(), TRUE);
  const std::string file = ::testing::TempDir() + "lidar-srtp-key";
  ASSERT_TRUE(
      g_file_set_contents(file.c_str(), (std::string(60, '7') + "\n").c_str(), -1, nullptr));
  Path path("srtp-key=env:LIDAR_TEST_KEY", "srtp-key=file:" + file);
  path.Play();
  EXPECT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
}

class BadKey : public ::testing::TestWithParam<const char*> {};
TEST_P(BadKey, IsAnErrorThatDoesNotShowIt) {
  SentSlices sent;
  SendingEnd sender(&sent, 5004, GetParam());
  EXPECT_EQ(gst_element_set_state(sender.pipeline().get(), GST_STATE_PLAYING),
            GST_STATE_CHANGE_FAILURE);
  const std::string error = sender.pipeline().Error();
  EXPECT_NE(error.find("SRTP cannot be used"), std::string::npos) << error;
  EXPECT_EQ(error.find("c0ffee"), std::string::npos) << error;
}
INSTANTIATE_TEST_SUITE_P(All, BadKey,
                         ::testing::Values("srtp-key=c0ffee", "srtp-key=env:NO_SUCH_VARIABLE",
                                           "srtp-key=file:/no/such/file",
                                           "srtp-key=c0ffee srtp-cipher=rot13",
                                           "srtp-key=c0ffee srtp-auth=none"));

}  // namespace
}  // namespace lidar::test
