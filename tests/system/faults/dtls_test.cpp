// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests GStreamer's own elements for DTLS-SRTP around screamtx and screamrx, as
// pipelines/secure-dtls.sh uses them.
#include <gtest/gtest.h>

#include "tests/support/patience.h"
#include "tests/system/faults/ends.h"
#include "tests/system/faults/fault_link.h"

namespace lidar::test {
namespace {

/// A sender and a receiver that are connected by DTLS-SRTP. Each of them makes its own certificate,
/// and accepts any certificate of its peer.
struct DtlsPath {
  DtlsPath()
      : port(FreePort()),
        back(FreePort()),
        link(port),
        receiver("ecnudpsrc caps=application/x-srtp port=" + std::to_string(port) +
                 " ! capssetter caps=application/x-srtp ! dtlssrtpdec name=dec connection-id=edge "
                 "dec.rtp_src ! capssetter caps=application/x-rtp,media=application,"
                 "clock-rate=90000,encoding-name=X-LIDAR-DRACO,payload=96 ! screamrx name=rx ! "
                 "rtplidardepay name=depay ! dracodec ! fakesink sync=false async=false "
                 "rx.rtcp_src ! enc.rtcp_sink_0 dtlssrtpenc name=enc connection-id=edge ! "
                 "ecnudpsink host=127.0.0.1 sync=false async=false port=" +
                 std::to_string(back)),
        sender(
            "lidartestsrc is-live=true model=os0-32 mode=512x10 ! dracoenc max-error=0.05 ! "
            "rtplidarpay ! screamtx name=tx packet-overhead=38 ! enc.rtp_sink_0 "
            "dtlssrtpenc name=enc connection-id=robot is-client=true ! ecnudpsink "
            "host=127.0.0.1 sync=false async=false port=" +
            std::to_string(link.port()) +
            " ecnudpsrc caps=application/x-srtcp port=" + std::to_string(back) +
            " ! capssetter caps=application/x-srtcp ! dtlssrtpdec name=dec connection-id=robot "
            "dec.rtcp_src ! tx.rtcp_sink") {
    receiver.SetState(GST_STATE_PLAYING);
    sender.SetState(GST_STATE_PLAYING);
  }
  std::uint16_t port;
  std::uint16_t back;
  FaultLink link;
  Pipeline receiver;
  Pipeline sender;
};

TEST(Dtls, ShowsTheMarksOfTheNetworkToTheCongestionControl) {
  DtlsPath path;
  const auto marked = [&] { return path.receiver.Stat("rx", "packets-ce"); };
  const auto shown = [&] { return path.receiver.Stat("depay", "slices-received"); };
  ASSERT_TRUE(Eventually([&] { return shown() > 50; }));
  EXPECT_EQ(marked(), 0U);
  Fault marks;
  marks.mark = 0.5;
  path.link.Set(marks);
  EXPECT_TRUE(Eventually([&] { return marked() > 100; }));
  path.link.Set({});
  EXPECT_TRUE(Eventually([&] { return shown() > 200; }));
  EXPECT_TRUE(Eventually([&] { return path.sender.Stat("tx", "feedback-accepted") > 100; }));
  // The receiver's reports are encrypted, too. The sender decrypts them, so it counts each mark
  // that the receiver counted.
  EXPECT_TRUE(Eventually([&] { return path.sender.Stat("tx", "packets-ce") == marked(); }));
  // The packets are encrypted, so the link recognises slices in them only by chance. No slice is
  // damaged.
  EXPECT_LT(path.link.counts().slices, 3U);
  EXPECT_EQ(path.receiver.Stat("depay", "slices-damaged"), 0U);
  EXPECT_EQ(path.sender.Error() + path.receiver.Error(), "");
}

TEST(Dtls, ShowsNothingThatIsNotOfThePeerOrWasThereBefore) {
  DtlsPath path;
  const auto shown = [&] { return path.receiver.Stat("depay", "slices-received"); };
  ASSERT_TRUE(Eventually([&] { return shown() > 50; }));
  const auto before = shown();
  Fault garbage;
  garbage.garbage_ratio = 5;
  garbage.valid_garbage = true;
  garbage.duplicate = 0.5;
  path.link.Set(garbage);
  EXPECT_TRUE(Eventually([&] { return shown() > before + 150; }));
  path.link.Set({});
  EXPECT_TRUE(Eventually([&] { return shown() > before + 200; }));
  EXPECT_EQ(path.receiver.Stat("depay", "slices-lost"), 0U);
  EXPECT_EQ(path.receiver.Stat("depay", "packets-invalid"), 0U);
  EXPECT_EQ(path.receiver.Stat("depay", "packets-duplicate"), 0U);
  EXPECT_EQ(path.receiver.Error(), "");
}

}  // namespace
}  // namespace lidar::test
