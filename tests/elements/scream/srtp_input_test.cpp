// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of what a receiver with a key accepts: other keys, replays, recordings, wrapped sequence
// numbers and floods. The test sets the clock.
#include <dlfcn.h>
#include <gst/check/gstharness.h>
#include <gtest/gtest.h>

#include <ctime>
#include <set>

#include "gst/scream/rtp_packet.h"
#include "gst/scream/srtp/input.h"
#include "tests/elements/scream/frozen_clock.h"
#include "tests/elements/scream/srtp_protector.h"
#include "tests/support/element_bus.h"

using lidar::test::frozen_at;

/// Replaces GLib's function in this program. The function is hidden from libraries, because
/// GStreamer's system clock would otherwise sleep until a time that the test has set.
extern "C" __attribute__((visibility("hidden"))) gint64 g_get_monotonic_time() {
  ++lidar::test::looks;
  if (lidar::test::on_look) lidar::test::on_look();
  if (frozen_at != 0) return frozen_at;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return gint64{now.tv_sec} * G_USEC_PER_SEC + now.tv_nsec / 1'000;
}

namespace lidar::gst {
namespace {

TEST(FrozenClock, IsNotThatOfGStreamer) {
  frozen_at = 7;
  EXPECT_EQ(g_get_monotonic_time(), 7);
  auto* of_libraries = reinterpret_cast<gint64 (*)()>(dlsym(RTLD_DEFAULT, "g_get_monotonic_time"));
  EXPECT_NE(of_libraries(), 7);
  frozen_at = 0;
}

class SrtpIn : public ::testing::Test {
 protected:
  SrtpIn()
      : bin_(GST_ELEMENT(gst_object_ref_sink(gst_bin_new(nullptr)))),
        socket_(gst_pad_new("socket", GST_PAD_SRC)),
        target_(gst_pad_new("target", GST_PAD_SINK)) {
    frozen_at = 1'000 * G_USEC_PER_SEC;
    gst_element_set_state(bin_.get(), GST_STATE_PLAYING);
    for (GstPad* pad : {socket_, target_}) gst_object_ref_sink(pad);
    gst_pad_set_element_private(target_, this);
    gst_pad_set_chain_function(target_, [](GstPad* pad, GstObject*, GstBuffer* buffer) {
      auto* self = static_cast<SrtpIn*>(gst_pad_get_element_private(pad));
      self->passed_.insert(ReadRtpHeader(buffer)->seq);
      gst_buffer_unref(buffer);
      return GST_FLOW_OK;
    });
    input_ = std::make_unique<SrtpInput>(bin_.get(), kPolicy,
                                         [this](const SrtpKey& key) { new_keys_.push_back(key); });
    EXPECT_TRUE(input_->AddKey(Key(5)));
    gst_pad_set_active(target_, TRUE);
    EXPECT_TRUE(input_->Link(socket_, target_));
    gst_pad_set_active(socket_, TRUE);
    gst_pad_push_event(socket_, gst_event_new_stream_start("socket"));
    gst_pad_push_event(socket_, test::NewSegment());
  }
  ~SrtpIn() override {
    frozen_at = 0;
    gst_pad_set_active(socket_, FALSE);
    input_.reset();
    gst_pad_set_active(target_, FALSE);
    for (GstPad* pad : {socket_, target_}) gst_object_unref(pad);
    gst_element_set_state(bin_.get(), GST_STATE_NULL);
  }

  /// Pushes the datagram. Returns true if it passes.
  bool Passes(const BufferPtr& datagram) {
    const std::size_t before = passed_.size();
    gst_pad_push(socket_, gst_buffer_ref(datagram.get()));
    return passed_.size() > before;
  }
  void Forge(unsigned count, guint32 ssrc = kSsrc) {
    for (unsigned i = 0; i < count; ++i)
      EXPECT_FALSE(Passes(Forged(static_cast<guint16>(i), ssrc)));
  }
  static void Wait(double seconds) {
    frozen_at += static_cast<gint64>(seconds * static_cast<double>(G_USEC_PER_SEC));
  }
  std::size_t Warnings() { return bus_.Texts(GST_MESSAGE_WARNING).size(); }

  ElementPtr bin_;
  const test::ElementBus bus_{bin_.get()};
  GstPad* socket_;
  GstPad* target_;
  std::unique_ptr<SrtpInput> input_;
  std::multiset<guint16> passed_;
  std::vector<SrtpKey> new_keys_;
};

TEST_F(SrtpIn, BelievesItsKeyAndNoOther) {
  Protector sender(Key(5));
  Protector stranger(Key(6));
  for (guint16 seq = 1; seq <= 50; ++seq) {
    EXPECT_TRUE(Passes(sender.Protect(seq))) << seq;
    EXPECT_FALSE(Passes(stranger.Protect(seq))) << seq;
  }
  EXPECT_EQ(input_->counts().received, 100U);
  EXPECT_EQ(input_->counts().refused, 50U);
  EXPECT_EQ(input_->counts().key_changes, 0U);
}

TEST_F(SrtpIn, RefusesWhatWasChangedOrRepeated) {
  Protector sender(Key(5));
  const BufferPtr first = sender.Protect(1);
  EXPECT_TRUE(Passes(first));
  EXPECT_FALSE(Passes(first));
  const BufferPtr second = sender.Protect(2);
  for (gsize at = 0; at < gst_buffer_get_size(second.get()); at += 3) {
    const BufferPtr changed(gst_buffer_copy_deep(second.get()));
    guint8 byte = 0;
    gst_buffer_extract(changed.get(), at, &byte, 1);
    byte ^= 4;
    gst_buffer_fill(changed.get(), at, &byte, 1);
    EXPECT_FALSE(Passes(changed)) << at;
  }
  EXPECT_TRUE(Passes(second));
}

TEST_F(SrtpIn, CountsNoPacketAsPassedWhileItIsDecoded) {
  Protector sender(Key(5));
  EXPECT_TRUE(Passes(sender.Protect(1)));
  unsigned looks = 0;
  test::on_look = [&] {
    ++looks;
    EXPECT_EQ(input_->counts().received - input_->counts().refused, 1U);
  };
  Forge(3, 99);
  test::on_look = nullptr;
  EXPECT_GE(looks, 3U);
  EXPECT_EQ(input_->counts().received, 4U);
}

TEST_F(SrtpIn, WarnsOnceOfPacketsThatDoNotFit) {
  Forge(19);
  EXPECT_EQ(Warnings(), 0U);
  Forge(100);
  const auto warnings = bus_.Texts(GST_MESSAGE_WARNING);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0], "Packets that do not match the SRTP key arrive and are dropped.");
}

TEST_F(SrtpIn, TakesAStreamThatBeginsBehindAForgery) {
  Forge(1);
  Protector sender(Key(5));
  EXPECT_TRUE(Passes(sender.Protect(1)));
}

TEST_F(SrtpIn, JoinsAStreamThatHasWrapped) {
  Protector sender(Key(5));
  sender.Protect(5);
  sender.Wrap();
  EXPECT_TRUE(Passes(sender.Protect(100)));
  EXPECT_TRUE(Passes(sender.Protect(500)));
}

TEST_F(SrtpIn, JoinsAStreamThatHasWrappedOftenAfterAFewPackets) {
  Protector sender(Key(5));
  sender.Protect(5);
  for (int turns = 0; turns < 200; ++turns) sender.Wrap();
  int tried = 0;
  for (guint16 seq = 100; !Passes(sender.Protect(seq)); ++seq) {
    // Each packet tries 32 values: 3 packets for the rounds of 4, 16 and 64 values, and 8 packets
    // for the round of 256 values.
    ASSERT_LE(++tried, 11);
    Wait(0.2);
  }
}

TEST_F(SrtpIn, JoinsAStreamThatHasWrappedWhoseReportsComeFirst) {
  Protector sender(Key(5));
  sender.Protect(5);
  for (int turns = 0; turns < 200; ++turns) sender.Wrap();
  int refused = 0;
  EXPECT_TRUE(Passes(sender.ProtectReport()));
  for (guint16 seq = 100; !Passes(sender.Protect(seq)); ++seq) {
    EXPECT_TRUE(Passes(sender.ProtectReport()));
    ASSERT_LE(++refused, 11);
    Wait(0.2);
  }
  EXPECT_GE(refused, 2) << "so reports came in between";
  // After the media was found, reports still pass, but replayed reports do not.
  const BufferPtr report = sender.ProtectReport();
  EXPECT_TRUE(Passes(report));
  EXPECT_FALSE(Passes(report));
  EXPECT_TRUE(Passes(sender.Protect(500)));
}

TEST_F(SrtpIn, RefusesReportsFromBeforeTheMediaWasFound) {
  Protector sender(Key(5));
  const BufferPtr report = sender.ProtectReport();
  EXPECT_TRUE(Passes(report));
  EXPECT_TRUE(Passes(sender.Protect(1)));
  EXPECT_FALSE(Passes(report));
}

TEST_F(SrtpIn, FollowsAWrap) {
  Protector sender(Key(5));
  for (const guint16 seq : Sequences{65'500, 65'535, 0, 1, 30'000, 60'000, 2, 3})
    EXPECT_TRUE(Passes(sender.Protect(seq))) << seq;
  EXPECT_EQ(input_->counts().refused, 0U);
}

TEST_F(SrtpIn, RefusesARecordingOfAStreamThatFellSilent) {
  Protector sender(Key(5));
  std::vector<BufferPtr> recording;
  for (const guint16 seq : Sequences{20'000, 40'000, 60'000, 5, 6}) {  // the numbers wrap
    recording.push_back(sender.Protect(seq));
    EXPECT_TRUE(Passes(recording.back()));
  }
  Wait(3);
  Forge(30);
  for (int round = 0; round < 20; ++round)
    for (const BufferPtr& packet : recording) EXPECT_FALSE(Passes(packet));
  // The live stream still passes, so the replays have not changed its state.
  EXPECT_TRUE(Passes(sender.Protect(7)));
}

TEST_F(SrtpIn, FindsAStreamThatWrappedInSilence) {
  Protector sender(Key(5));
  for (const guint16 seq : Sequences{40'000, 60'000, 5}) EXPECT_TRUE(Passes(sender.Protect(seq)));
  sender.Wrap();
  Wait(3);
  int refused = 0;
  for (guint16 seq = 10; !Passes(sender.Protect(seq)); ++seq) ASSERT_LT(++refused, 40);
  EXPECT_GE(refused, 19);  // fewer refused packets in a row may just be damaged packets
  EXPECT_TRUE(Passes(sender.Protect(1'000)));
}

TEST_F(SrtpIn, FindsAStreamThatWrappedWhileOnlyItsReportsPassed) {
  Protector sender(Key(5));
  for (const guint16 seq : Sequences{40'000, 60'000, 5}) EXPECT_TRUE(Passes(sender.Protect(seq)));
  sender.Wrap();
  int refused = 0;
  for (guint16 seq = 10; !Passes(sender.Protect(seq)); ++seq) {
    ASSERT_LT(++refused, 40);
    Wait(0.2);
    EXPECT_TRUE(Passes(sender.ProtectReport()));
  }
}

TEST_F(SrtpIn, NoRecordingOfAReportMovesAStreamThatFellSilent) {
  Protector sender(Key(5));
  const BufferPtr report = sender.ProtectReport();
  EXPECT_TRUE(Passes(sender.Protect(1)));
  EXPECT_TRUE(Passes(report));
  Wait(3);
  Forge(30);
  for (int round = 0; round < 30; ++round) EXPECT_FALSE(Passes(report));
  EXPECT_TRUE(Passes(sender.Protect(2)));
  EXPECT_TRUE(Passes(sender.ProtectReport()));
}

TEST_F(SrtpIn, ForgersDoNotMakeAStreamLost) {
  Protector sender(Key(5));
  EXPECT_TRUE(Passes(sender.Protect(1)));
  Forge(3'000);
  EXPECT_TRUE(Passes(sender.Protect(2)));
  // A packet with an unknown SSRC still passes, so the forged packets did not use up the allowed
  // trials.
  EXPECT_TRUE(Passes(sender.Protect(1, 99)));
}

TEST_F(SrtpIn, TriesFiveHundredStrangersASecond) {
  Protector sender(Key(5));
  EXPECT_TRUE(Passes(sender.Protect(1)));
  for (guint32 ssrc = 1'000; ssrc < 1'600; ++ssrc) Forge(1, ssrc);
  EXPECT_TRUE(Passes(sender.Protect(2)));       // the SSRC is known
  EXPECT_FALSE(Passes(sender.Protect(1, 99)));  // a new SSRC has to wait
  Wait(0.1);
  EXPECT_TRUE(Passes(sender.Protect(2, 99)));
}

TEST_F(SrtpIn, KeepsHalfOfWhatMayBeTriedForFirstTries) {
  Protector sender(Key(5));
  Forge(40, 77);  // each causes trials of up to 32 rollover counters
  for (guint32 ssrc = 1; ssrc <= 200; ++ssrc) EXPECT_TRUE(Passes(sender.Protect(1, ssrc))) << ssrc;
}

TEST_F(SrtpIn, FindsAStreamThatComesAfterMoreForgersThanItRemembers) {
  Protector sender(Key(5));
  for (int turns = 0; turns < 20; ++turns) sender.Wrap(99);
  for (guint32 ssrc = 1'000; ssrc < 3'200; ++ssrc) {
    if (ssrc % 100 == 0) Wait(1);
    Forge(2, ssrc);
  }
  int refused = 0;
  for (guint16 seq = 100; !Passes(sender.Protect(seq, 99)); ++seq) {
    ASSERT_LE(++refused, 8);
    Wait(0.2);
  }
}

TEST_F(SrtpIn, RefusesReportsThatBeginAnewUnderTheSameKeyAndSsrc) {
  Protector sender(Key(5));
  for (int n = 0; n < 3; ++n) EXPECT_TRUE(Passes(sender.ProtectReport()));
  Protector restarted(Key(5));
  Wait(3);
  EXPECT_FALSE(Passes(restarted.ProtectReport()));
  EXPECT_TRUE(Passes(restarted.ProtectReport(kSsrc + 1)));
}

TEST_F(SrtpIn, KnowsItsStreamsAmongAnyNumberOfOthers) {
  Protector sender(Key(5));
  const BufferPtr recorded = sender.Protect(5);
  // More than the 4 and 16 values that are tried first.
  for (int turns = 0; turns < 20; ++turns) sender.Wrap();
  for (guint16 seq = 100; !Passes(sender.Protect(seq)); ++seq) ASSERT_LT(seq, 300);
  for (guint32 ssrc = 0; ssrc < 2'200; ++ssrc) {
    if (ssrc % 100 == 0) Wait(1);
    Forge(2, 100'000 + ssrc);
  }
  EXPECT_FALSE(Passes(recorded));
  // Decoded with the rollover counter of the known stream.
  EXPECT_TRUE(Passes(sender.Protect(400)));
}

/// Each packet causes trials of 32 values. Therefore three packets cover the rounds of 4, 16 and 64
/// values.
TEST_F(SrtpIn, GoesOnWithItsSearchWhereGarbageComesFromMoreSsrcsThanItRemembers) {
  constexpr guint32 kStreams = 16;
  Protector sender(Key(5));
  for (guint32 ssrc = 1; ssrc <= kStreams; ++ssrc)
    for (int turns = 0; turns < 50; ++turns) sender.Wrap(ssrc);
  std::set<guint32> found;
  const auto send = [&](guint16 seq) {
    for (guint32 ssrc = 1; ssrc <= kStreams; ++ssrc) {
      Wait(1);
      if (Passes(sender.Protect(seq, ssrc))) found.insert(ssrc);
    }
  };
  send(100);
  send(101);
  for (guint32 ssrc = 0; ssrc < 2'100; ++ssrc) {
    if (ssrc % 100 == 0) Wait(1);
    Forge(1, 100'000 + ssrc);
  }
  send(102);
  EXPECT_EQ(found.size(), kStreams);
}

TEST_F(SrtpIn, TakesANewKeyAndForgetsTheOldOne) {
  Protector before(Key(5));
  Protector after(Key(6));
  EXPECT_TRUE(Passes(before.Protect(1)));
  EXPECT_TRUE(input_->AddKey(Key(6)));
  EXPECT_EQ(input_->waiting_keys(), 1U);
  EXPECT_TRUE(Passes(before.Protect(2)));
  EXPECT_TRUE(new_keys_.empty());
  EXPECT_TRUE(Passes(after.Protect(3)));
  EXPECT_EQ(new_keys_, (std::vector<SrtpKey>{Key(6)}));
  EXPECT_EQ(input_->waiting_keys(), 0U);
  EXPECT_EQ(input_->counts().key_changes, 1U);
  Wait(9);
  EXPECT_TRUE(Passes(before.Protect(4)));  // packets with the new key overtook this one
  EXPECT_EQ(new_keys_.size(), 1U);
  Wait(2);
  EXPECT_FALSE(Passes(before.Protect(5)));
  EXPECT_TRUE(Passes(after.Protect(6)));
}

TEST_F(SrtpIn, FindsAStreamThatHasWrappedLessOftenUnderItsNewKeyThanUnderTheOldOne) {
  Protector before(Key(5));
  for (int turns = 0; turns < 5; ++turns)
    for (const guint16 seq : Sequences{20'000, 40'000, 60'000, 5})
      EXPECT_TRUE(Passes(before.Protect(seq)));
  EXPECT_TRUE(input_->AddKey(Key(6)));
  Protector after(Key(6));
  for (int turns = 0; turns < 2; ++turns) after.Wrap();
  Wait(3);
  int refused = 0;
  for (guint16 seq = 10; !Passes(after.Protect(seq)); ++seq) ASSERT_LT(++refused, 40);
  EXPECT_EQ(new_keys_, (std::vector<SrtpKey>{Key(6)}));
  EXPECT_TRUE(Passes(after.Protect(1'000)));
}

TEST_F(SrtpIn, RefusesARecordingOfTheKeyBefore) {
  Protector before(Key(5));
  Protector after(Key(6));
  const BufferPtr old = before.Protect(1);
  EXPECT_TRUE(Passes(old));
  EXPECT_TRUE(input_->AddKey(Key(6)));
  EXPECT_TRUE(Passes(after.Protect(2)));
  Wait(3);
  Forge(30);
  EXPECT_FALSE(Passes(old));
  EXPECT_TRUE(Passes(after.Protect(3)));
}

TEST_F(SrtpIn, IsNotStoppedWhileItMayDecode) {
  // The bin stops only its socket. If it also stopped srtpdec, srtpdec would warn of a packet that
  // it decodes at this moment.
  Protector sender(Key(5));
  const BufferPtr first = sender.Protect(1);
  EXPECT_TRUE(Passes(first));
  gst_element_set_state(bin_.get(), GST_STATE_READY);
  EXPECT_TRUE(Passes(sender.Protect(2)));
  // After a stream-start event no stream is known, so the first packet passes again.
  gst_element_set_state(bin_.get(), GST_STATE_PLAYING);
  EXPECT_FALSE(Passes(first));
  gst_pad_push_event(socket_, gst_event_new_stream_start("again"));
  EXPECT_TRUE(Passes(first));
}

/// Returns a copy of the datagram whose source address is `host`.
BufferPtr From(const char* host, const BufferPtr& datagram) {
  BufferPtr copy(gst_buffer_copy_deep(datagram.get()));
  test::SetSource(copy.get(), host, 9);
  return copy;
}

TEST_F(SrtpIn, PassesACopyOnceFromEachAddress) {
  Protector sender(Key(5));
  EXPECT_TRUE(Passes(From("10.0.0.1", sender.Protect(1))));
  // From now on, packets come from several addresses.
  EXPECT_TRUE(Passes(From("10.0.0.2", sender.Protect(2))));
  const BufferPtr third = sender.Protect(3);
  EXPECT_TRUE(Passes(From("10.0.0.1", third)));
  EXPECT_TRUE(Passes(From("10.0.0.2", third)));
  for (const char* host : {"10.0.0.1", "10.0.0.2"}) EXPECT_FALSE(Passes(From(host, third)));
  EXPECT_EQ(input_->counts().copies, 1U);
  EXPECT_EQ(input_->counts().refused, 2U);
}

TEST_F(SrtpIn, PassesCopiesFromAsManyAddressesAsASenderMayHave) {
  Protector sender(Key(5));
  Passes(From("10.0.0.1", sender.Protect(1)));
  Passes(From("10.0.0.2", sender.Protect(2)));
  const BufferPtr third = sender.Protect(3);
  std::size_t passed = 0;
  for (int host = 1; host <= 20; ++host)
    passed += Passes(From(("10.0.0." + std::to_string(host)).c_str(), third)) ? 1U : 0U;
  EXPECT_EQ(passed, SrtpCopies::kMaxAddresses);
}

TEST_F(SrtpIn, PassesNothingThatOnlyLooksLikeACopy) {
  Protector sender(Key(5));
  Passes(From("10.0.0.1", sender.Protect(1)));
  Passes(From("10.0.0.2", sender.Protect(2)));
  const BufferPtr third = sender.Protect(3);
  EXPECT_TRUE(Passes(From("10.0.0.1", third)));
  const BufferPtr changed = From("10.0.0.2", third);
  const guint8 byte = 0xff;
  gst_buffer_fill(changed.get(), gst_buffer_get_size(changed.get()) - 1, &byte, 1);
  EXPECT_FALSE(Passes(changed));
  EXPECT_FALSE(Passes(From("10.0.0.2", Forged(3))));
  EXPECT_EQ(input_->counts().copies, 0U);
}

TEST_F(SrtpIn, TakesWhatComesLateByALinkBehindAGap) {
  Protector sender(Key(5));
  std::vector<BufferPtr> waiting;
  for (guint16 seq = 1; seq <= 50; ++seq) waiting.push_back(sender.Protect(seq));
  for (guint16 seq = 51; seq <= 1'000; ++seq)
    EXPECT_TRUE(Passes(From("10.0.0.1", sender.Protect(seq)))) << seq;
  for (const BufferPtr& datagram : waiting) EXPECT_TRUE(Passes(From("10.0.0.2", datagram)));
}

TEST_F(SrtpIn, RemembersSoManyCopiesOnly) {
  Protector sender(Key(5));
  Passes(From("10.0.0.1", sender.Protect(1)));
  Passes(From("10.0.0.2", sender.Protect(2)));
  const BufferPtr old = sender.Protect(3);
  EXPECT_TRUE(Passes(From("10.0.0.1", old)));
  std::vector<BufferPtr> newer;
  for (guint16 seq = 4; seq <= 3 + SrtpCopies::kMaxDatagrams; ++seq) {
    newer.push_back(sender.Protect(seq));
    EXPECT_TRUE(Passes(From("10.0.0.1", newer.back())));
  }
  EXPECT_FALSE(Passes(From("10.0.0.2", old)));
  for (const BufferPtr& datagram : newer) EXPECT_TRUE(Passes(From("10.0.0.2", datagram)));
}

TEST_F(SrtpIn, RemembersSoManyBytesOfCopiesOnly) {
  constexpr guint kLarge = 9'000;
  Protector sender(Key(5));
  Passes(From("10.0.0.1", sender.Protect(1)));
  Passes(From("10.0.0.2", sender.Protect(2)));
  const BufferPtr old = sender.Protect(3);
  EXPECT_TRUE(Passes(From("10.0.0.1", old)));
  constexpr auto kCount = static_cast<guint16>(SrtpCopies::kMaxBytes / kLarge + 2);
  std::vector<BufferPtr> newer;
  for (guint16 seq = 4; seq <= 4 + kCount; ++seq) {
    newer.push_back(sender.Protect(seq, kSsrc, kLarge));
    EXPECT_TRUE(Passes(From("10.0.0.1", newer.back())));
  }
  EXPECT_FALSE(Passes(From("10.0.0.2", old)));
  // The limit also counts headers, so the copies of the first few datagrams are already forgotten.
  for (auto datagram = newer.begin() + 5; datagram != newer.end(); ++datagram)
    EXPECT_TRUE(Passes(From("10.0.0.2", *datagram)));
}

TEST_F(SrtpIn, TakesNothingOfBeforeAStartForACopy) {
  Protector sender(Key(5));
  Passes(From("10.0.0.1", sender.Protect(1)));
  Passes(From("10.0.0.2", sender.Protect(2)));
  const BufferPtr third = sender.Protect(3);
  EXPECT_TRUE(Passes(From("10.0.0.1", third)));
  gst_pad_push_event(socket_, gst_event_new_stream_start("again"));
  EXPECT_TRUE(Passes(From("10.0.0.1", third)));
  EXPECT_FALSE(Passes(From("10.0.0.2", third))) << "one address sent until now";
  EXPECT_EQ(input_->counts().copies, 0U);
}

TEST_F(SrtpIn, KeepsTheKeyInUseAndTheTwoNewestOfManyThatNoPacketFits) {
  Protector used(Key(5));
  EXPECT_TRUE(Passes(used.Protect(1)));
  for (const std::uint8_t digit : SrtpKey{6, 7, 8, 9}) {
    EXPECT_TRUE(input_->AddKey(Key(digit)));
    EXPECT_TRUE(Passes(used.Protect(digit)));
  }
  EXPECT_EQ(input_->waiting_keys(), 2U);
  EXPECT_FALSE(Passes(Protector(Key(7)).Protect(10)));
  EXPECT_TRUE(Passes(Protector(Key(8)).Protect(11)));
  EXPECT_TRUE(Passes(Protector(Key(9)).Protect(12)));
  EXPECT_EQ(input_->waiting_keys(), 0U);
  EXPECT_TRUE(Passes(used.Protect(13))) << "overtaken";
}

TEST_F(SrtpIn, OfFourKeysTheOneBeforeThatInUseGoes) {
  EXPECT_TRUE(input_->AddKey(Key(6)));
  EXPECT_TRUE(Passes(Protector(Key(6)).Protect(1)));
  for (const std::uint8_t digit : SrtpKey{7, 8}) EXPECT_TRUE(input_->AddKey(Key(digit)));
  EXPECT_FALSE(Passes(Protector(Key(5)).Protect(2)));
  EXPECT_TRUE(Passes(Protector(Key(7)).Protect(3)));
}

}  // namespace
}  // namespace lidar::gst
