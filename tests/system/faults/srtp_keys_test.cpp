// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the SRTP keys of screamsink and screamsrc: where the elements get a key from, and how it is
// changed.
#include <gtest/gtest.h>

#include <thread>

#include "tests/system/faults/srtp_path.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST_P(Srtp, ChangesItsKeyWithoutALoss) {
  const std::string options = GetParam().options + std::string(" ");
  Path path(options + Key(GetParam().key_bytes), options + Key(GetParam().key_bytes));
  // The sequence numbers wrap before the first change of the key. So the rollover counter is 1 at
  // that time, and starts at 0 again with the new key.
  g_object_set(path.sender.pipeline().Child("pay").get(), "seqnum-offset", 65'450, nullptr);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  for (const char digit : {'6', '7', '8', '9'}) {
    const std::string key(2 * GetParam().key_bytes, digit);
    std::this_thread::sleep_for(milliseconds(400));
    SetKey(path.receiver.pipeline(), key);
    std::this_thread::sleep_for(milliseconds(400));
    SetKey(path.sender.pipeline(), key);
  }
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_EQ(path.receiver.pipeline().Stat("net", "srtp-key-changes"), 4U);
  EXPECT_EQ(path.sender.pipeline().Stat("net", "srtp-key-changes"), 4U);
  ExpectNothingLost(&path);
}

TEST(Srtp, ChangesItsKeyWhilePacketsAreReordered) {
  Path path(Key(30), Key(30));
  g_object_set(path.receiver.pipeline().Child("depay").get(), "max-reorder-time",
               guint64{GST_SECOND}, nullptr);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  Fault late;
  late.reorder_by = 20;
  path.link.Set(late);
  for (const char digit : {'6', '7', '8', '9', 'a', 'b'}) {
    SetKey(path.receiver.pipeline(), std::string(60, digit));
    SetKey(path.sender.pipeline(), std::string(60, digit));
    std::this_thread::sleep_for(milliseconds(500));
  }
  path.link.Set({});
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_TRUE(path.sender.pipeline().Finish(seconds(5)));
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(path.receiver.accounts().received, path.sender.slices_sent());
  EXPECT_EQ(path.receiver.pipeline().Stat("net", "srtp-refused"), 0U);
}

TEST(Srtp, ASenderWithAKeyThatTheReceiverLacksIsRefusedUntilItHasIt) {
  Path path(Key(30), Key(30));
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  SetKey(path.sender.pipeline(), std::string(60, '6'));
  std::this_thread::sleep_for(seconds(1));
  const auto clouds = path.receiver.clouds();
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(path.receiver.clouds(), clouds);
  SetKey(path.receiver.pipeline(), std::string(60, '6'));
  EXPECT_LT(path.receiver.NextCloud(seconds(5)), seconds(3));
}

TEST(Srtp, AKeyThatIsNoneOrWasUsedBeforeChangesNothing) {
  Path path(Key(30), Key(30));
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  Pipeline& sender = path.sender.pipeline();
  SetKey(path.receiver.pipeline(), std::string(60, '6'));
  SetKey(sender, std::string(60, '6'));
  std::this_thread::sleep_for(milliseconds(500));
  for (const std::string& key : {std::string("c0ffee"), std::string(60, '5'), std::string()}) {
    SetKey(sender, key);
    EXPECT_EQ(sender.Messages(GST_MESSAGE_WARNING), 1U) << key;
  }
  // A key that is already in use is not a change.
  SetKey(sender, std::string(60, '6'));
  EXPECT_EQ(sender.Messages(GST_MESSAGE_WARNING), 0U);
  std::this_thread::sleep_for(milliseconds(500));
  ExpectNothingLost(&path);
}

TEST(Srtp, FindsAStreamWhoseKeyItGetsLate) {
  Path path(Key(30), Key(30));
  g_object_set(path.sender.pipeline().Child("pay").get(), "seqnum-offset", 65'436, nullptr);
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  SetKey(path.sender.pipeline(), std::string(60, '6'));
  // The sequence numbers have wrapped after these 150 packets, so the rollover counter of the new
  // key is 1.
  WaitForRefused(path, 150);
  SetKey(path.receiver.pipeline(), std::string(60, '6'));
  EXPECT_LT(path.receiver.NextCloud(seconds(8)), seconds(3));
}

TEST(Srtp, KeepsItsKeyWhereOneIsRefused) {
  Path path(Key(30), Key(30));
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  SetKey(path.sender.pipeline(), "c0ffee");
  path.sender.pipeline().SetState(GST_STATE_NULL);
  path.sender.pipeline().SetState(GST_STATE_PLAYING);
  EXPECT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  // The receiver accepts two keys that the sender does not use yet. A third key would replace the
  // key in use, so the receiver refuses it.
  for (const char digit : {'6', '7'}) SetKey(path.receiver.pipeline(), std::string(60, digit));
  EXPECT_EQ(path.receiver.pipeline().Messages(GST_MESSAGE_WARNING), 0U);
  SetKey(path.receiver.pipeline(), std::string(60, '8'));
  EXPECT_EQ(path.receiver.pipeline().Messages(GST_MESSAGE_WARNING), 1U);
  EXPECT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  SetKey(path.sender.pipeline(), std::string(60, '7'));
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  EXPECT_EQ(path.receiver.pipeline().Stat("net", "srtp-refused"), 0U);
}

TEST(Srtp, ForgetsTheOldKeyAfterTheStragglers) {
  Path path(Key(30), Key(30));
  path.Play();
  ASSERT_NE(path.receiver.NextCloud(seconds(5)), milliseconds::max());
  SetKey(path.receiver.pipeline(), std::string(60, '6'));
  SetKey(path.sender.pipeline(), std::string(60, '6'));
  std::this_thread::sleep_for(seconds(11));
  // The receiver has forgotten the old key by now, so it refuses a sender that still uses the key.
  path.sender.pipeline().SetState(GST_STATE_NULL);
  SetKey(path.sender.pipeline(), std::string(60, '5'));
  path.sender.pipeline().SetState(GST_STATE_PLAYING);
  const auto clouds = path.receiver.clouds();
  std::this_thread::sleep_for(seconds(1));
  EXPECT_EQ(path.receiver.clouds(), clouds);
  EXPECT_GT(path.receiver.pipeline().Stat("net", "srtp-refused"), 20U);
}

TEST(Srtp, CarriesSeveralStreamsThroughAChangeOfKey) {
  const std::uint16_t port = FreePort();
  const std::string key = " " + Key(30) + " ";
  std::string sources, sinks;
  for (const char* n : {"1", "2"}) {
    sources +=
        std::string(" lidartestsrc is-live=true model=os0-32 mode=512x10 num-buffers=240 ! ") +
        "dracoenc max-error=0.05 ! rtplidarpay name=pay" + n + " ssrc=" + n + " ! net.";
    sinks += std::string(" net.src_") + n + " ! rtplidardepay name=depay" + n +
             " ! fakesink sync=false async=false";
  }
  Pipeline receiver("screamsrc name=net port=" + std::to_string(port) + key +
                    "pt-map=\"application/x-rtp-pt-map,96=(string)\\\"application/x-rtp,"
                    "media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO\\\"\"" +
                    sinks);
  Pipeline sender("screamsink name=net max-bitrate=20000000 port=" + std::to_string(port) + key +
                  sources);
  receiver.SetState(GST_STATE_PLAYING);
  sender.SetState(GST_STATE_PLAYING);
  std::this_thread::sleep_for(seconds(1));
  SetKey(receiver, std::string(60, '6'));
  SetKey(sender, std::string(60, '6'));
  // The source ends after 240 buffers.
  EXPECT_TRUE(sender.AwaitEnd(seconds(30)));
  std::this_thread::sleep_for(milliseconds(300));
  for (const std::string n : {"1", "2"}) {
    EXPECT_EQ(sender.Stat(("pay" + n).c_str(), "slices-sent"), 240U);
    EXPECT_EQ(receiver.Stat(("depay" + n).c_str(), "slices-received"), 240U);
  }
  EXPECT_EQ(receiver.Stat("net", "srtp-refused"), 0U);
  EXPECT_EQ(receiver.Error() + sender.Error(), "");
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
