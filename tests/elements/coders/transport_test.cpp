// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that send the slices of every coder over their transports: files, and SRTP with congestion
// control.
#include <gtest/gtest.h>

#include "tests/elements/coders/coder_harness.h"
#include "tests/elements/scream/pipeline.h"
#include "tests/support/files.h"
#include "tests/support/patience.h"

namespace lidar::gst {
namespace {

class Transport : public ::testing::TestWithParam<CoderCase> {
 protected:
  static std::string Sender(const std::string& properties) {
    return "lidartestsrc model=os1-32 mode=512x10 slices-per-scan=8 " + properties + " ! " +
           GetParam().encoder + " ! rtplidarpay";
  }
  static std::string Receiver() {
    return std::string("rtplidardepay name=depay ! ") + GetParam().decoder +
           " name=dec ! fakesink sync=false async=false";
  }
};
INSTANTIATE_TEST_SUITE_P(Coders, Transport, ::testing::ValuesIn(OurCoders()),
                         [](const auto& c) { return c.param.name; });

TEST_P(Transport, RecordsAndPlaysThroughAFile) {
  const test::TempFolder folder;
  const std::string file = folder.path() + "/drive.gdp";
  test::Pipeline recorder(Sender("num-buffers=24") + " ! gdppay ! filesink location=" + file);
  recorder.Play();
  EXPECT_TRUE(recorder.Ends());
  test::Pipeline player("filesrc location=" + file + " ! gdpdepay ! " + Receiver());
  player.Play();
  EXPECT_TRUE(player.Ends());
  EXPECT_EQ(test::StatOf(player.Get("dec").get(), "slices"), 24U);
  EXPECT_EQ(test::StatOf(player.Get("depay").get(), "scans-complete"), 3U);
}

TEST_P(Transport, GoesThroughSrtpUnderCongestionControl) {
  const ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  if (!srtp) GTEST_SKIP() << "srtpenc (gstreamer1.0-plugins-bad) is not installed";
  g_setenv("LIDAR_TRANSPORT_KEY", std::string(60, '7').c_str(), TRUE);
  const std::string key = " srtp-key=env:LIDAR_TRANSPORT_KEY";
  test::Pipeline receiver("screamsrc name=in address=127.0.0.1 port=0" + key + " ! " + Receiver());
  receiver.Play();
  const ElementPtr in = receiver.Get("in");
  gst_element_get_state(in.get(), nullptr, nullptr, test::kPatience_ns);
  const guint port = test::PortOf(in.get());
  EXPECT_NE(port, 0U);
  // The source is not live, so it waits while the sender's queue is full. Nothing is dropped,
  // because no frame waits longer than max-queue-delay.
  test::Pipeline sender(
      Sender("num-buffers=24") +
      " ! screamsink max-queue-delay=30000000000 start-bitrate=20000000 host=127.0.0.1 port=" +
      std::to_string(port) + key);
  sender.Play();
  EXPECT_TRUE(sender.Ends());
  const ElementPtr dec = receiver.Get("dec");
  EXPECT_TRUE(test::Eventually([&] { return test::StatOf(dec.get(), "slices") == 24; }));
  EXPECT_EQ(test::StatOf(dec.get(), "slices-dropped"), 0U);
}

}  // namespace
}  // namespace lidar::gst
