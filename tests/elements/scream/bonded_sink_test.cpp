// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of screamsink over two links. The test makes their feedback and sets the time.
#include <gst/video/video.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/elements/scream/bonded_ends.h"
#include "tests/elements/scream/rtp_support.h"
#include "tests/elements/scream/srtp_protector.h"

namespace lidar::test {
namespace {

using gst::MessagePtr;
using gst::PadPtr;

constexpr guint kPorts[] = {5'004, 5'006};
constexpr const char* kSwapped = "Feedback about one link arrives on another link";

class BondedSink : public ::testing::Test {
 protected:
  BondedSink() {
    g_object_set(sink_, "bonding-addresses", "127.0.0.1:5004@127.0.0.1,127.0.0.1:5006@127.0.0.2",
                 "bonding-method", 2, nullptr);  // method "backup", which makes few copies
  }
  ~BondedSink() override {
    h_.reset();
    bus_.reset();
    gst_object_unref(sink_);
  }
  void Start() {
    h_.reset(gst_harness_new_with_element(sink_, "sink_0", nullptr));
    gst_harness_set_src_caps_str(h_.get(), kRtpCaps);
    Open();
    Watch();
  }
  /// Stops the element and plays it again.
  void Restart() {
    gst_element_set_state(sink_, GST_STATE_READY);
    gst_pad_set_active(h_->srcpad, FALSE);
    gst_pad_set_active(h_->srcpad, TRUE);
    gst_element_set_state(sink_, GST_STATE_PLAYING);
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("again"));
    gst_harness_set_src_caps_str(h_.get(), kRtpCaps);
    Open();
    for (auto& count : packets_) count = 0;
  }
  gst::ElementPtr Child(const std::string& name) {
    return gst::ElementPtr(gst_bin_get_by_name(GST_BIN(sink_), name.c_str()));
  }
  PadPtr PadOf(const std::string& child, const std::string& pad) {
    return PadPtr(gst_element_get_static_pad(Child(child).get(), pad.c_str()));
  }
  PadPtr BondPad(std::size_t link) { return PadOf("screambond", "src_0_" + std::to_string(link)); }
  static std::string NameOf(const char* factory, std::size_t link) {
    return link == 0 ? factory : factory + std::to_string(link);
  }
  void Advance(GstClockTime by) { gst_test_clock_set_time(time_.clock(), time_.now() + by); }

  /// Wakes the links that wait for a time that has passed. Pushing a new packet does not wake them.
  void WakeLinks() {
    for (GstClockID next = nullptr; gst_test_clock_peek_next_pending_id(time_.clock(), &next);) {
      const GstClockTime due = gst_clock_id_get_time(next);
      gst_clock_id_unref(next);
      if (due > time_.now()) break;
      if (GstClockID woken = gst_test_clock_process_next_clock_id(time_.clock()))
        gst_clock_id_unref(woken);
    }
  }

  /// Returns a datagram with its source address, as the socket of a link outputs it.
  static BufferPtr From(const std::vector<std::uint8_t>& bytes, const char* host, guint port) {
    BufferPtr buffer(FromBytes(bytes));
    SetSource(buffer.get(), host, port);
    return buffer;
  }
  void Bring(std::size_t link, BufferPtr buffer) {
    gst_pad_push(PadOf(NameOf("ecnudpsrc", link), "src").get(), buffer.release());
  }
  /// Pushes a report to `link` that says that packet `seq` has arrived.
  void Report(std::size_t link, guint16 seq) {
    rtcp::CongestionFeedback report;
    report.sender_ssrc = 9;
    report.report_timestamp = static_cast<std::uint32_t>(
        gst_util_uint64_scale(time_.now(), 65536, GST_SECOND) & 0xffffffff);
    report.blocks.push_back({0x1234, seq, {{true, Ecn::kEct1, Duration{0}}}});
    Bring(link, From(rtcp::BuildCcfb(report), "127.0.0.1", kPorts[link]));
  }
  /// Pushes a slice of one packet. Returns the links to which the bond gave the packet.
  std::set<std::size_t> Send(guint16 seq, std::optional<guint> scan = std::nullopt) {
    const std::array<int, 2> before{packets_[0], packets_[1]};
    Rtp packet;
    packet.seq = seq;
    packet.timestamp = seq;
    packet.marker = true;
    packet.size = 100;
    GstBuffer* buffer = NewRtp(packet);
    const GstLidarSlice slice{scan.value_or(0), seq, 100, 0};
    if (scan) gst_lidar_buffer_set_slice(buffer, &slice);
    EXPECT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
    std::set<std::size_t> links;
    for (std::size_t i = 0; i < 2; ++i)
      if (packets_[i] > before[i]) links.insert(i);
    return links;
  }
  /// Advances the time. Returns true once the link has sent or dropped all packets that the bond
  /// gave it.
  bool HasLeft(std::size_t link) {
    // Advances the time in small steps, because the sending thread may have to wait for a
    // processor. In large steps its packet could become too old.
    constexpr int kPacing = 20, kSeldom = 100;
    int looks = 0;
    return Eventually([&] {
      const bool is_seldom = ++looks % kSeldom == 0;
      if (looks <= kPacing || is_seldom) Advance(GST_MSECOND);
      if (is_seldom) WakeLinks();
      // The number of dropped packets includes cancelled copies.
      const guint64 settled = OfLink("packets-sent", link) + OfLink("packets-dropped", link);
      return settled == static_cast<guint64>(packets_[link].load());
    });
  }
  guint64 OfLink(const char* field, std::size_t link) { return OfLinks(sink_, field)[link]; }
  /// Pushes a list of datagrams with these sizes to the socket element of a link.
  void SendDatagrams(std::size_t link, std::initializer_list<std::size_t> sizes) {
    GstBufferList* list = gst_buffer_list_new();
    for (const std::size_t size : sizes)
      gst_buffer_list_add(list, FromBytes(std::vector<std::uint8_t>(size)));
    EXPECT_EQ(gst_pad_chain_list(PadOf(NameOf("ecnudpsink", link), "sink").get(), list),
              GST_FLOW_OK);
  }
  /// Returns the next scream-link-changed message as text, or an empty string if there is none.
  std::string ChangedLink() {
    while (const MessagePtr message = bus_->Pop(GST_MESSAGE_ELEMENT)) {
      if (!gst_message_has_name(message.get(), "scream-link-changed")) continue;
      const Stats change(gst_message_get_structure(message.get()));
      return change.Text("link") + (change.True("usable") ? " is usable: " : " is not usable: ") +
             change.Text("reason");
    }
    return "";
  }
  int Warnings(const char* text) {
    int count = 0;
    for (const std::string& warning : bus_->Texts(GST_MESSAGE_WARNING))
      count += warning.find(text) != std::string::npos;
    return count;
  }

  FakeTime time_;
  GstElement* sink_ =
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("screamsink", nullptr)));
  std::optional<ElementBus> bus_{sink_};
  Harness h_;
  std::array<std::atomic<int>, 2> packets_{};  // number of packets that the bond gave to each link
  std::atomic<GstClockTime> ended_at_{0};      // when the bond passed EOS downstream

 private:
  /// Pushes the first events of the feedback streams. The links' own sources push nothing, because
  /// they wait for datagrams.
  void Open() {
    for (std::size_t i = 0; i < 2; ++i) {
      const PadPtr pad = PadOf(NameOf("ecnudpsrc", i), "src");
      const gst::CapsPtr caps(gst_caps_new_empty_simple("application/x-rtcp"));
      gst_pad_push_event(pad.get(), gst_event_new_stream_start("feedback"));
      gst_pad_push_event(pad.get(), gst_event_new_caps(caps.get()));
      gst_pad_push_event(pad.get(), NewSegment());
    }
  }
  void Watch() {
    for (std::size_t i = 0; i < 2; ++i) {
      gst_pad_add_probe(
          BondPad(i).get(), GST_PAD_PROBE_TYPE_BUFFER,
          [](GstPad*, GstPadProbeInfo*, gpointer count) -> GstPadProbeReturn {
            ++*static_cast<std::atomic<int>*>(count);
            return GST_PAD_PROBE_OK;
          },
          &packets_[i], nullptr);
    }
    gst_pad_add_probe(
        BondPad(0).get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
        [](GstPad*, GstPadProbeInfo* info, gpointer self) -> GstPadProbeReturn {
          auto* test = static_cast<BondedSink*>(self);
          if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_EOS)
            test->ended_at_ = test->time_.now();
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
  }
};

/// The receiver may ask for a key unit on each link, and each screamtx passes its request to the
/// bond. Only one of the requests may reach the encoder.
TEST_F(BondedSink, AsksForAKeyUnitOnceWhicheverLinksBringTheWish) {
  Start();
  const auto ask = [this](std::size_t link, GstEvent* event) {
    gst_pad_send_event(BondPad(link).get(), event);
    int passed = 0;
    while (const EventPtr next{gst_harness_try_pull_upstream_event(h_.get())})
      passed +=
          gst_video_event_is_force_key_unit(next.get()) || gst_event_has_name(next.get(), "other");
    return passed;
  };
  const auto key = [&](std::size_t link) {
    return ask(link, gst_video_event_new_upstream_force_key_unit(GST_CLOCK_TIME_NONE, TRUE, 0));
  };
  for (int run = 0; run < 2; ++run) {
    EXPECT_EQ(key(0), 1) << run;
    EXPECT_EQ(key(1) + key(0), 0) << run;
    Advance(399 * GST_MSECOND);
    EXPECT_EQ(key(1), 0) << run;
    Advance(GST_MSECOND);
    EXPECT_EQ(key(1), 1) << "0.4 s after the one before";
    EXPECT_EQ(key(0), 0) << run;
    for (const std::size_t link : {0U, 1U, 1U})
      EXPECT_EQ(ask(link, gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                                               gst_structure_new_empty("other"))),
                1)
          << "others are no wishes for a key unit";
    Restart();
  }
}

TEST_F(BondedSink, CountsWhatStrangersSendToAnyLink) {
  Start();
  const std::vector<std::uint8_t> no_report(12, 0);
  std::array<int, 2> taken{};
  for (std::size_t i = 0; i < 2; ++i)
    gst_pad_add_probe(
        PadOf(NameOf("screamtx", i), "rtcp_sink").get(), GST_PAD_PROBE_TYPE_BUFFER,
        [](GstPad*, GstPadProbeInfo*, gpointer count) -> GstPadProbeReturn {
          ++*static_cast<int*>(count);
          return GST_PAD_PROBE_OK;
        },
        &taken[i], nullptr);
  guint64 foreign = 0;
  for (std::size_t link = 0; link < 2; ++link) {
    const guint own = kPorts[link], other = kPorts[1 - link];
    Bring(link, From(no_report, "127.0.0.1", own));
    EXPECT_EQ(taken[link], 1) << link;
    EXPECT_EQ(Stats(sink_)["feedback-foreign-address"], foreign) << link;
    Bring(link, From(no_report, "127.0.0.1", other));
    Bring(link, From(no_report, "127.0.0.3", own));
    Bring(link, BufferPtr(FromBytes(no_report)));  // has no address
    GstBufferList* list = gst_buffer_list_new();
    for (const guint port : {own, other, own, other})
      gst_buffer_list_add(list, From(no_report, "127.0.0.1", port).release());
    gst_pad_push_list(PadOf(NameOf("ecnudpsrc", link), "src").get(), list);
    EXPECT_EQ(taken[link], 3) << link;
    EXPECT_EQ(Stats(sink_)["feedback-foreign-address"], foreign += 5) << link;
  }
  Restart();
}

/// Returns the writable properties of the element as text, except those that differ between links.
std::string SettingsOf(GstElement* element) {
  const std::set<std::string> of_link = {"name",   "parent",      "host",         "port",
                                         "socket", "used-socket", "peer-address", "stats"};
  guint count = 0;
  GParamSpec** raw = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  const std::unique_ptr<GParamSpec*, void (*)(gpointer)> specs(raw, g_free);
  std::string text;
  for (guint i = 0; i < count; ++i) {
    if ((raw[i]->flags & G_PARAM_READWRITE) != G_PARAM_READWRITE || of_link.count(raw[i]->name) > 0)
      continue;
    GValue value = G_VALUE_INIT;
    g_value_init(&value, raw[i]->value_type);
    g_object_get_property(G_OBJECT(element), raw[i]->name, &value);
    const bool is_null = G_VALUE_HOLDS_BOXED(&value) && g_value_get_boxed(&value) == nullptr;
    const gst::StringPtr shown(is_null ? g_strdup("NULL") : g_strdup_value_contents(&value));
    text += std::string(raw[i]->name) + "=" + shown.get() + "\n";
    g_value_unset(&value);
  }
  return text;
}

TEST_F(BondedSink, GivesEachLinkTheSettingsOfTheSink) {
  g_object_set(sink_, "qos-dscp", 46, "min-bitrate", 111'111, "start-bitrate", 222'222,
               "max-bitrate", 333'333, "max-total-bitrate", 444'444, "ecn-mode", 1,
               "max-queue-delay", guint64{77'000'000}, "stats-interval", guint64{5'000'000'000},
               "send-bye", FALSE, "sender-report-interval", guint64{3'000'000'000},
               "key-unit-on-loss", TRUE, nullptr);
  gst_util_set_object_arg(G_OBJECT(sink_), "tuning", "tuning,beta-loss=0.6");
  Start();
  for (const char* factory : {"screamtx", "ecnudpsink", "ecnudpsrc"})
    EXPECT_EQ(SettingsOf(Child(NameOf(factory, 1)).get()), SettingsOf(Child(factory).get()));
  EXPECT_NE(SettingsOf(Child("ecnudpsink1").get()).find("qos-dscp=46\n"), std::string::npos);
  EXPECT_NE(SettingsOf(Child("screamtx1").get()).find("max-bitrate=333333\n"), std::string::npos);
  g_object_set(sink_, "qos-dscp", 10, "max-bitrate", 555'555, "send-bye", TRUE, nullptr);
  for (const char* factory : {"screamtx", "ecnudpsink"})
    EXPECT_EQ(SettingsOf(Child(NameOf(factory, 1)).get()), SettingsOf(Child(factory).get()))
        << "while they play";
  EXPECT_NE(SettingsOf(Child("screamtx1").get()).find("max-bitrate=555555\n"), std::string::npos);
}

/// After a flush the bond must not copy packets from before the flush. Their copies would be sent
/// before the copy of the packet after the flush.
TEST_F(BondedSink, CopiesNothingOfBeforeAFlush) {
  Start();
  guint16 seq = 0;
  std::set<std::size_t> links;
  do {
    links = Send(++seq);
    for (const std::size_t link : links) {
      ASSERT_TRUE(HasLeft(link));
      Report(link, seq);
    }
  } while (links.size() > 1);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(Send(++seq).size(), 1U);
    if (i > 0) break;
    Flush(h_.get());
  }
  const int before = packets_[0] + packets_[1];
  const guint64 copies = OfAllLinks(sink_, "packets-copies");
  Advance(150 * GST_MSECOND);
  ASSERT_TRUE(Eventually([&] { return packets_[0] + packets_[1] > before; }));
  EXPECT_EQ(packets_[0] + packets_[1], before + 1);
  EXPECT_EQ(OfAllLinks(sink_, "packets-copies"), copies + 1);
}

/// The second link is blocked until a report says that the first link has delivered a slice of the
/// scan.
TEST_F(BondedSink, SendsTheRestOfAScanOfWhichAnotherLinkDeliveredASlice) {
  g_object_set(sink_, "bonding-method", 1, "max-queue-delay", guint64{5 * GST_SECOND}, nullptr);
  Start();
  std::atomic<bool> blocked{false};
  const PadPtr src = PadOf("screamtx1", "src");
  const gulong probe = gst_pad_add_probe(
      src.get(),
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_BUFFER |
                                   GST_PAD_PROBE_TYPE_BUFFER_LIST),
      [](GstPad*, GstPadProbeInfo*, gpointer flag) -> GstPadProbeReturn {
        *static_cast<std::atomic<bool>*>(flag) = true;
        return GST_PAD_PROBE_OK;
      },
      &blocked, nullptr);
  EXPECT_EQ(Send(1), (std::set<std::size_t>{0, 1}));
  ASSERT_TRUE(Eventually([&] { return blocked.load(); }));
  constexpr guint16 kLast = 16;  // more packets than a link sends at once
  for (guint16 seq = 2; seq <= kLast; ++seq) Send(seq, 7);
  ASSERT_TRUE(HasLeft(0));
  Report(0, 2);
  gst_pad_remove_probe(src.get(), probe);
  ASSERT_TRUE(HasLeft(1));
  EXPECT_EQ(OfLink("copies-cancelled", 1), 1U);
  EXPECT_EQ(OfLink("packets-sent", 1), kLast - 1U);
}

TEST_F(BondedSink, KeepsNoPacketThatIsTooOldToBeCopied) {
  Start();
  Rtp packet;
  packet.marker = true;
  const BufferPtr held(NewRtp(packet));
  ASSERT_EQ(gst_harness_push(h_.get(), gst_buffer_ref(held.get())), GST_FLOW_OK);
  for (const std::size_t link : {0U, 1U}) ASSERT_TRUE(HasLeft(link));
  EXPECT_GT(GST_MINI_OBJECT_REFCOUNT_VALUE(held.get()), 1) << "another link may need it";
  Advance(300 * GST_MSECOND);
  Send(1);
  EXPECT_TRUE(Eventually([&] { return GST_MINI_OBJECT_REFCOUNT_VALUE(held.get()) == 1; }));
}

TEST_F(BondedSink, TakesNoTargetOfTheRunBefore) {
  const auto first_target = [this] {
    GstLidarTargetBitrate target{};
    EXPECT_TRUE(Eventually([&] {
      const EventPtr event(gst_harness_try_pull_upstream_event(h_.get()));
      return event && gst_lidar_event_parse_target_bitrate(event.get(), &target);
    }));
    return target.bitrate;
  };
  g_object_set(sink_, "start-bitrate", 4'000'000, nullptr);
  Start();
  EXPECT_GT(first_target(), 3'500'000U);
  gst_element_set_state(sink_, GST_STATE_READY);
  while (const EventPtr late{gst_harness_try_pull_upstream_event(h_.get())}) continue;
  g_object_set(sink_, "start-bitrate", 800'000, nullptr);
  Restart();
  EXPECT_LT(first_target(), 900'000U);
}

TEST_F(BondedSink, AsksForNoMoreThanTheEncoderMayHaveWhereLinksAddUp) {
  g_object_set(sink_, "bonding-target", 1, "start-bitrate", 800'000, "max-bitrate", 900'000,
               nullptr);
  Start();
  GstLidarTargetBitrate target{};
  while (const EventPtr event{gst_harness_try_pull_upstream_event(h_.get())})
    gst_lidar_event_parse_target_bitrate(event.get(), &target);
  EXPECT_GT(target.max_bitrate, 850'000U);
  EXPECT_EQ(target.bitrate, target.max_bitrate);
}

TEST_F(BondedSink, TellsTheEncoderWhatTheLinkShowsThatHasTheTarget) {
  g_object_set(sink_, "start-bitrate", 800'000, nullptr);
  gst_element_set_state(sink_, GST_STATE_READY);
  for (const auto& [tx, max] : {std::pair("screamtx", 300'000U), {"screamtx1", 900'000U}})
    g_object_set(Child(tx).get(), "max-bitrate", max, nullptr);
  Start();
  GstLidarTargetBitrate target{};
  EXPECT_TRUE(Eventually([&] {
    const EventPtr event(gst_harness_try_pull_upstream_event(h_.get()));
    if (event) gst_lidar_event_parse_target_bitrate(event.get(), &target);
    return target.bitrate > 500'000;
  }));
  EXPECT_GT(target.max_bitrate, 800'000U);
}

/// A link that fails is reported by the message scream-link-changed, so it needs no warning.
TEST_F(BondedSink, WarnsOfNoErrorOfALink) {
  Start();
  for (const std::size_t link : {0U, 1U}) {
    SendDatagrams(link, {70'000});
    EXPECT_EQ(OfLink("send-errors", link), 1U);
  }
  EXPECT_EQ(Warnings("Sending failed"), 0);
}

TEST_F(BondedSink, CountsWhatSrtpRefusesOnAnyLink) {
  const gst::ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  if (!srtp) GTEST_SKIP() << "srtpenc is not installed";
  g_object_set(sink_, "srtp-key", std::string(60, '5').c_str(), nullptr);
  Start();
  const std::vector<std::uint8_t> no_srtp(12, 0);
  for (const std::size_t link : {0U, 1U, 1U}) Bring(link, From(no_srtp, "127.0.0.1", kPorts[link]));
  EXPECT_EQ(Stats(sink_)["srtp-refused"], 3U);
  EXPECT_EQ(Stats(sink_)["srtp-received"], 3U);
  EXPECT_EQ(Stats(sink_)["srtp-copies"] + Stats(sink_)["srtp-key-changes"], 0U);
}

TEST_F(BondedSink, CountsAChangeOfTheKeyOnceWhicheverLinksShowIt) {
  const gst::ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  if (!srtp) GTEST_SKIP() << "srtpenc is not installed";
  g_object_set(sink_, "srtp-key", std::string(60, '5').c_str(), nullptr);
  Start();
  g_object_set(sink_, "srtp-key", std::string(60, '6').c_str(), nullptr);
  gst::Protector receiver(gst::SrtpKey(30, 0x66));
  for (const std::size_t link : {0U, 1U}) {
    BufferPtr report = receiver.ProtectReport();
    SetSource(report.get(), "127.0.0.1", kPorts[link]);
    Bring(link, std::move(report));
    EXPECT_EQ(Stats(sink_)["srtp-key-changes"], 1U) << link;
  }
}

TEST_F(BondedSink, CountsTheErrorsOfEachLinkAsItsOwn) {
  Start();
  g_object_set(Child("ecnudpsink1").get(), "interface", "none0", nullptr);
  for (guint16 seq = 1; seq < 9; ++seq) Send(seq);
  ASSERT_GT(packets_[0], 0);
  ASSERT_GT(packets_[1], 0);
  EXPECT_TRUE(Eventually([&] {
    Advance(GST_MSECOND);
    return OfLink("send-errors", 1) > 0 && OfLink("packets-sent", 0) > 0;
  }));
  EXPECT_EQ(OfLink("send-errors", 0), 0U);
}

TEST_F(BondedSink, KeepsALinkThatSendsSomePacketsAndGivesUpOneThatSendsNone) {
  constexpr std::size_t kTooLong = 70'000;
  g_object_set(sink_, "bonding-method", 1, nullptr);  // broadcast
  Start();
  EXPECT_EQ(Send(1), (std::set<std::size_t>{0, 1}));
  for (const std::size_t link : {0U, 1U}) ASSERT_TRUE(HasLeft(link));
  SendDatagrams(0, {100, kTooLong});
  std::string changed;
  EXPECT_TRUE(Eventually([&] {
    SendDatagrams(1, {kTooLong});
    Advance(100 * GST_MSECOND);  // the bond checks all links at this time
    changed = ChangedLink();
    return !changed.empty();
  }));
  EXPECT_EQ(changed, "127.0.0.1:5006@127.0.0.2 is not usable: its packets cannot be sent");
  EXPECT_EQ(OfLink("send-errors", 0), 1U);
  EXPECT_TRUE(Stats(sink_).Of("links", 0).True("usable"));
  EXPECT_FALSE(Stats(sink_).Of("links", 1).True("usable"));
  EXPECT_EQ(Send(2), std::set<std::size_t>{0});
  EXPECT_TRUE(Eventually([&] {
    Advance(100 * GST_MSECOND);
    changed = ChangedLink();
    return !changed.empty();
  })) << "it is tried again";
  EXPECT_EQ(changed, "127.0.0.1:5006@127.0.0.2 is usable: it can be used again");
  EXPECT_EQ(Send(3), (std::set<std::size_t>{0, 1}));
}

TEST_F(BondedSink, APadThatComesWhileItPlaysSendsOverAllLinks) {
  g_object_set(sink_, "bonding-method", 1, nullptr);  // broadcast
  Start();
  EXPECT_EQ(Send(1), (std::set<std::size_t>{0, 1}));
  Harness other(gst_harness_new_with_element(sink_, "sink_1", nullptr));
  gst_harness_set_src_caps_str(other.get(), kRtpCaps);
  Rtp packet;
  packet.ssrc = 0x5678;
  packet.marker = true;
  EXPECT_EQ(gst_harness_push(other.get(), NewRtp(packet)), GST_FLOW_OK);
  EXPECT_EQ(OfAllLinks(sink_, "packets-first"), 2U);
  EXPECT_EQ(OfAllLinks(sink_, "packets-copies"), 2U);
  for (const char* tx : {"screamtx", "screamtx1"}) {
    const PadPtr pad = PadOf(tx, "sink_1");
    ASSERT_TRUE(pad) << tx;
    EXPECT_TRUE(gst_pad_is_active(pad.get())) << tx;
  }
  other.reset();
  for (const char* tx : {"screamtx", "screamtx1"}) EXPECT_FALSE(PadOf(tx, "sink_1")) << tx;
  EXPECT_EQ(Send(2), (std::set<std::size_t>{0, 1})) << "the first pad goes on";
}

TEST_F(BondedSink, GoesOnWhereALinkTakesNothing) {
  g_object_set(sink_, "bonding-method", 1, nullptr);  // broadcast
  Start();
  EXPECT_EQ(Send(1), (std::set<std::size_t>{0, 1}));
  gst_element_set_state(Child("screamtx1").get(), GST_STATE_READY);
  EXPECT_EQ(Send(2), (std::set<std::size_t>{0, 1})) << "one link is enough";
}

TEST_F(BondedSink, SendsByTheInterfaceAndToThePortOfEachLink) {
  for (const bool first : {true, false}) {
    g_object_set(sink_, "bonding-addresses",
                 first ? "127.0.0.1:5004@lo,127.0.0.1:5006@127.0.0.2"
                       : "127.0.0.1:5004@127.0.0.2,127.0.0.1:5006@lo",
                 nullptr);
    ASSERT_EQ(gst_element_set_state(sink_, GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
    for (std::size_t i = 0; i < 2; ++i) {
      gchar* interface = nullptr;
      guint port = 0;
      g_object_get(Child(NameOf("ecnudpsink", i)).get(), "interface", &interface, "port", &port,
                   nullptr);
      const gst::StringPtr owner(interface);
      const bool by_name = first == (i == 0);
      EXPECT_STREQ(interface != nullptr ? interface : "", by_name ? "lo" : "") << i;
      EXPECT_EQ(port, kPorts[i]);
    }
    gst_element_set_state(sink_, GST_STATE_NULL);
  }
}

TEST_F(BondedSink, TellsThatNobodyAnswersWhereNoLinkIsHeard) {
  Start();
  for (guint16 seq = 1; seq <= 6; ++seq) {
    for (const std::size_t link : Send(seq)) ASSERT_TRUE(HasLeft(link));
    Advance(500 * GST_MSECOND);
  }
  EXPECT_TRUE(Eventually([&] { return Warnings("No feedback from 127.0.0.1:500") > 0; }));
}

TEST_F(BondedSink, TellsThatTheOnlyLinkThatWasHeardIsSilent) {
  Start();
  std::optional<std::size_t> heard;
  for (guint16 seq = 1; seq <= 20; ++seq) {
    for (const std::size_t link : Send(seq)) {
      ASSERT_TRUE(HasLeft(link));
      if (!heard) Report(link, seq);
      heard = heard.value_or(link);
    }
    Advance(500 * GST_MSECOND);
  }
  const std::string text = "No feedback from 127.0.0.1:" + std::to_string(kPorts[*heard]);
  EXPECT_TRUE(Eventually([&] { return Warnings(text.c_str()) > 0; }));
}

TEST_F(BondedSink, WaitsAtTheEndForWhatMayStillArrive) {
  Start();
  Advance(2 * GST_SECOND);
  Send(1);
  const GstClockTime made = time_.now();
  std::thread end([this] { gst_harness_push_event(h_.get(), gst_event_new_eos()); });
  g_usleep(50'000);  // by now an EOS that does not wait would have passed
  Advance(150 * GST_MSECOND);
  g_usleep(50'000);
  Advance(51 * GST_MSECOND);
  end.join();
  EXPECT_EQ(ended_at_, made + 201 * GST_MSECOND);
}

TEST_F(BondedSink, EndsAtOnceWhereAllHasArrived) {
  Start();
  for (const bool with_packets : {false, true}) {
    if (with_packets) {
      Restart();
      const auto links = Send(1);
      ASSERT_FALSE(links.empty());
      for (const std::size_t link : links) ASSERT_TRUE(HasLeft(link));
      for (const std::size_t link : links) Report(link, 1);
    }
    ended_at_ = 0;
    gst_harness_push_event(h_.get(), gst_event_new_eos());  // the clock does not advance during EOS
    EXPECT_EQ(ended_at_, time_.now()) << with_packets;
  }
}

TEST_F(BondedSink, BeginsAnewInEachRun) {
  Start();
  std::set<guint> first_targets;
  for (int run = 0; run < 2; ++run) {
    const auto links = Send(1);
    for (const std::size_t link : links) ASSERT_TRUE(HasLeft(link));
    GstLidarTargetBitrate target{};
    EXPECT_TRUE(Eventually([&] {
      Advance(10 * GST_MSECOND);
      const EventPtr event(gst_harness_try_pull_upstream_event(h_.get()));
      const bool told = event && gst_lidar_event_parse_target_bitrate(event.get(), &target);
      if (told) {
        EXPECT_STREQ(target.reason, "start") << run;
      }
      return told;
    })) << "the encoder is told in run "
        << run;
    first_targets.insert(target.bitrate);
    for (const char* field : {"packets-first", "packets-copies", "packets-sent"})
      EXPECT_LE(OfLink(field, 0) + OfLink(field, 1), links.size()) << field;
    EXPECT_EQ(OfLink("packets-first", 0) + OfLink("packets-first", 1), 1U);
    Advance(500 * GST_MSECOND);
    while (const EventPtr late{gst_harness_try_pull_upstream_event(h_.get())}) continue;
    Restart();
  }
  EXPECT_EQ(first_targets.size(), 1U);
}

TEST_F(BondedSink, TellsOnceOfSwappedFeedbackAndInTheNextRunAgain) {
  Start();
  guint16 seq = 1;
  for (int run = 0; run < 2; ++run) {
    EXPECT_EQ(OfAllLinks(sink_, "feedback-ignored"), 0U) << run;
    for (const std::size_t link : Send(seq++)) ASSERT_TRUE(HasLeft(link));
    Advance(2 * GST_SECOND);  // by then a link sends no more copies to prove that it works
    for (int swapped = 0; swapped < 4; ++seq) {
      const auto links = Send(seq);
      if (links.size() != 1) continue;
      const std::size_t own = *links.begin(), other = 1 - own;
      const guint64 accepted = OfLink("feedback-accepted", own);
      const guint64 ignored = OfLink("feedback-ignored", other);
      ASSERT_TRUE(HasLeft(own));
      Advance(20 * GST_MSECOND);
      Report(other, seq);
      if (OfLink("feedback-ignored", other) == ignored)
        continue;  // the other link has sent a copy, so the report counts for that link
      ++swapped;
      EXPECT_EQ(OfLink("feedback-ignored", other), ignored + 1);
      ASSERT_TRUE(Eventually([&] { return OfLink("feedback-accepted", own) == accepted + 1; }))
          << "it is used for its own";
    }
    EXPECT_EQ(Warnings(kSwapped), 1) << run;
    Restart();
  }
}

}  // namespace
}  // namespace lidar::test
