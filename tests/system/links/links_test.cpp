// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests screamsink over several links while their interfaces, addresses and routes are added and
// removed.
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>

#include "tests/elements/scream/bonded_ends.h"
#include "tests/system/links/networks.h"

namespace lidar::test {
namespace {

/// The content of a message scream-link-changed.
struct Changed {
  std::string link;
  bool usable = false;
};

class Links : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!networks_.Create()) GTEST_SKIP() << "networks need root and iproute2";
  }

  void Play(const std::string& locals, const std::string& options = "") {
    networks_.EnterEdge();
    receiver_ = std::make_unique<BondReceiver>();
    networks_.EnterRobot();
    std::string addresses;
    int n = 0;
    std::istringstream parts(locals);
    for (std::string local; std::getline(parts, local, ',');) {
      addresses += addresses.empty() ? "" : ",";
      addresses += "10.9." + std::to_string(n++) + ".1:" + receiver_->port + "@" + local;
    }
    sender_ = std::make_unique<Pipeline>(Bonded(addresses, options));
    out_ = sender_->Get("out");
    g_object_set(sender_->Get("src").get(), "num-buffers", -1, nullptr);
    sender_->Play();
    WaitForMore(20);
  }

  /// Waits until the receiver has got `packets` more packets than at the time of the call.
  void WaitForMore(guint packets) {
    const guint from = receiver_->passed;
    for (int i = 0; i < 2'000 && receiver_->passed < from + packets; ++i) g_usleep(10'000);
    EXPECT_GE(receiver_->passed, from + packets);
  }
  void WaitForReportsOf(std::size_t link, guint64 reports) {
    const guint64 from = OfLinks(out_.get(), "feedback-accepted").at(link);
    for (int i = 0; i < 2'000; ++i) {
      if (OfLinks(out_.get(), "feedback-accepted").at(link) >= from + reports) return;
      g_usleep(10'000);
    }
    ADD_FAILURE() << "link " << link << " is not in use";
  }

  /// Returns the content of the next scream-link-changed message. The test fails if a warning or an
  /// error comes first.
  Changed NextChange() {
    const MessagePtr message = sender_->Wait(
        static_cast<GstMessageType>(GST_MESSAGE_ELEMENT | GST_MESSAGE_WARNING | GST_MESSAGE_ERROR));
    if (!message) {
      ADD_FAILURE() << "no message";
      return {};
    }
    const GstStructure* s = gst_message_get_structure(message.get());
    if (GST_MESSAGE_TYPE(message.get()) != GST_MESSAGE_ELEMENT) {
      ADD_FAILURE() << gst_structure_to_string(s);
      return {};
    }
    if (!gst_structure_has_name(s, "scream-link-changed")) return NextChange();
    gboolean usable = FALSE;
    gst_structure_get_boolean(s, "usable", &usable);
    return {gst_structure_get_string(s, "link"), usable != FALSE};
  }
  void ExpectChange(const std::string& local, bool usable) {
    const Changed changed = NextChange();
    EXPECT_EQ(changed.link.substr(changed.link.find('@') + 1), local);
    EXPECT_EQ(changed.usable, usable);
  }
  void End() {
    sender_->SendEos();
    EXPECT_TRUE(sender_->Ends());
  }

  Networks networks_;
  std::unique_ptr<BondReceiver> receiver_;
  std::unique_ptr<Pipeline> sender_;
  ElementPtr out_;
};

TEST_F(Links, AnInterfaceVanishesAndComesBackWithAnotherAddress) {
  networks_.Connect(0);
  networks_.Connect(1);
  Play("r0,r1");
  networks_.Disconnect(0);
  ExpectChange("r0", false);
  WaitForMore(50);
  networks_.Connect(0, 7);
  ExpectChange("r0", true);
  WaitForReportsOf(0, 3);
  networks_.Disconnect(1);
  ExpectChange("r1", false);
  WaitForMore(50);
  End();
}

TEST_F(Links, AModemGetsAnotherAddress) {
  networks_.Connect(0);
  networks_.Connect(1);
  Play("r0,r1");
  networks_.Robot("ip addr del 10.9.0.2/24 dev r0");
  ExpectChange("r0", false);
  networks_.Robot("ip addr add 10.9.0.9/24 dev r0");
  ExpectChange("r0", true);
  WaitForReportsOf(0, 3);
  End();
}

TEST_F(Links, ALocalAddressGoesAndComesBack) {
  networks_.Connect(0);
  networks_.Connect(1);
  Play("10.9.0.2,10.9.1.2");
  networks_.Robot("ip addr del 10.9.0.2/24 dev r0");
  ExpectChange("10.9.0.2", false);
  WaitForMore(20);
  networks_.Robot("ip addr add 10.9.0.2/24 dev r0");
  ExpectChange("10.9.0.2", true);
  WaitForReportsOf(0, 3);
  End();
}

TEST_F(Links, ALinkWithoutARouteAtTheStartIsUsedOnceItHasOne) {
  networks_.Connect(0);
  networks_.Connect(1);
  networks_.Robot("ip addr del 10.9.0.2/24 dev r0");
  Play("r0,r1");
  const MessagePtr warning = sender_->Wait(GST_MESSAGE_WARNING);
  ASSERT_TRUE(warning);
  networks_.Robot("ip addr add 10.9.0.2/24 dev r0");
  ExpectChange("r0", true);
  WaitForReportsOf(0, 3);
  End();
}

TEST_F(Links, AnInterfaceThatIsMissingAtTheStartIsUsedOnceItIsThere) {
  networks_.Connect(1);
  Play("r0,r1");
  const MessagePtr warning = sender_->Wait(GST_MESSAGE_WARNING);
  ASSERT_TRUE(warning);
  networks_.Connect(0);
  ExpectChange("r0", true);
  WaitForReportsOf(0, 3);
  End();
}

TEST_F(Links, AllVanishAndTheStreamGoesOnWithTheFirstThatReturns) {
  networks_.Connect(0);
  networks_.Connect(1);
  Play("r0,r1");
  networks_.Robot("ip link set r0 down; ip link set r1 down");
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(NextChange().usable);
  networks_.Robot("ip link set r1 up");
  ExpectChange("r1", true);
  WaitForMore(50);
  End();
}

TEST_F(Links, AnAddressThatChangesOftenKeepsTheOtherLinkGoing) {
  networks_.Connect(0);
  networks_.Connect(1);
  Play("r0,r1");
  for (int host = 3; host < 9; ++host) {
    networks_.Disconnect(0);
    ExpectChange("r0", false);
    networks_.Connect(0, host);
    ExpectChange("r0", true);
    WaitForMore(20);
  }
  WaitForReportsOf(0, 3);
  WaitForReportsOf(1, 3);
  End();
}

}  // namespace
}  // namespace lidar::test
