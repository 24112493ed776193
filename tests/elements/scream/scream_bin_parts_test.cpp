// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of how screamsink and screamsrc set up their child elements. Most of them send no packet.
#include <glib/gstdio.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/elements/scream/pipeline.h"
#include "tests/elements/scream/rtp_support.h"
#include "tests/support/free_ports.h"
#include "tests/support/ipv6.h"

namespace lidar::test {
namespace {

using OwnedElement = std::unique_ptr<GstElement, gst::Unref>;
using OwnedSocket = std::unique_ptr<GSocket, gst::Unref>;

class ScreamBin : public ::testing::Test {
 protected:
  void Make(const char* factory) {
    bin_.reset(GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make(factory, nullptr))));
  }
  void TearDown() override {
    if (bin_) gst_element_set_state(bin_.get(), GST_STATE_NULL);
  }
  GstStateChangeReturn To(GstState state) { return gst_element_set_state(bin_.get(), state); }
  ElementPtr Child(const char* name) {
    return ElementPtr(gst_bin_get_by_name(GST_BIN(bin_.get()), name));
  }
  template <class T>
  T Of(GstElement* element, const char* property) {
    T value{};
    g_object_get(element, property, &value, nullptr);
    return value;
  }
  /// Returns the first element of the bin whose factory is `name`.
  ElementPtr OfFactory(const char* name) {
    GstIterator* all = gst_bin_iterate_all_by_element_factory_name(GST_BIN(bin_.get()), name);
    GValue value = G_VALUE_INIT;
    ElementPtr found;
    if (gst_iterator_next(all, &value) == GST_ITERATOR_OK)
      found.reset(GST_ELEMENT(g_value_dup_object(&value)));
    if (G_IS_VALUE(&value)) g_value_unset(&value);
    gst_iterator_free(all);
    return found;
  }
  std::string NickOf(GstElement* element, const char* property) {
    const GParamSpec* spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), property);
    const GEnumValue* value =
        g_enum_get_value(G_PARAM_SPEC_ENUM(spec)->enum_class, Of<gint>(element, property));
    return value->value_nick;
  }
  OwnedSocket SocketOf(GstElement* element, const char* property = "socket") {
    return OwnedSocket(Of<GSocket*>(element, property));
  }

  // These records of the bin's signals must outlive the bin, because the bin emits signals while it
  // is freed.
  std::string added_, removed_;
  int notified_ = 0;
  OwnedElement bin_;
};

TEST_F(ScreamBin, TheSinkCountsTheHeadersOfItsAddressFamily) {
  for (const auto& [host, overhead] :
       {std::pair<std::string, guint>{"127.0.0.1", 28}, {"::1", 48}}) {
    if (host == "::1" && !HasIpv6()) continue;
    Make("screamsink");
    g_object_set(bin_.get(), "host", host.c_str(), nullptr);
    ASSERT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
    EXPECT_EQ(Of<guint>(Child("screamtx").get(), "packet-overhead"), overhead);
    To(GST_STATE_NULL);
  }
}

TEST_F(ScreamBin, TheSinkCountsWhatSrtpAdds) {
  const ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  if (!srtp) GTEST_SKIP() << "srtpenc is not installed";
  const struct {
    const char* cipher;
    const char* auth;
    std::size_t digits;
    guint tag;
  } kinds[] = {{"aes-128-icm", "hmac-sha1-80", 60, 10}, {"aes-128-icm", "hmac-sha1-32", 60, 4},
               {"aes-256-icm", "hmac-sha1-80", 92, 10}, {"aes-256-icm", "hmac-sha1-32", 92, 4},
               {"aes-128-gcm", "hmac-sha1-80", 56, 16}, {"aes-256-gcm", "hmac-sha1-80", 88, 16}};
  for (const auto& kind : kinds) {
    Make("screamsink");
    g_object_set(bin_.get(), "srtp-key", std::string(kind.digits, '5').c_str(), "srtp-cipher",
                 kind.cipher, "srtp-auth", kind.auth, nullptr);
    ASSERT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS) << kind.cipher;
    EXPECT_EQ(Of<guint>(Child("screamtx").get(), "packet-overhead"), 28 + kind.tag)
        << kind.cipher << " " << kind.auth;
    // Reports are encrypted with the same cipher and authentication, because the peer's decoder
    // would refuse others.
    const bool authenticates = std::string(kind.cipher).find("gcm") != std::string::npos;
    const ElementPtr encoder = OfFactory("srtpenc");
    ASSERT_TRUE(encoder);
    for (const char* cipher : {"rtp-cipher", "rtcp-cipher"})
      EXPECT_EQ(NickOf(encoder.get(), cipher), kind.cipher);
    EXPECT_EQ(NickOf(encoder.get(), "rtp-auth"), authenticates ? "null" : kind.auth);
    EXPECT_EQ(NickOf(encoder.get(), "rtcp-auth"), authenticates ? "null" : "hmac-sha1-80");
    To(GST_STATE_NULL);
  }
}

/// If the bin dropped its key when it refuses another one, it would start the next time without
/// encryption.
TEST_F(ScreamBin, AKeyThatIsRefusedWhileItRunsLeavesTheOneBefore) {
  const ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  if (!srtp) GTEST_SKIP() << "srtpenc is not installed";
  for (const char* factory : {"screamsink", "screamsrc"}) {
    g_setenv("LIDAR_BIN_PARTS_KEY", std::string(60, '5').c_str(), TRUE);
    Make(factory);
    g_object_set(bin_.get(), "srtp-key", "env:LIDAR_BIN_PARTS_KEY", nullptr);
    if (std::string(factory) == "screamsrc") g_object_set(bin_.get(), "port", 0, nullptr);
    ASSERT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
    g_object_set(bin_.get(), "srtp-key", "env:LIDAR_NO_SUCH_KEY", nullptr);
    To(GST_STATE_NULL);
    EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS) << factory;
    To(GST_STATE_NULL);
    g_unsetenv("LIDAR_BIN_PARTS_KEY");
    EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_FAILURE) << factory << " does without a key";
    To(GST_STATE_NULL);
  }
}

TEST_F(ScreamBin, AKeyThatWasInUseIsRefusedAndSoIsAThirdThatWaits) {
  const ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  if (!srtp) GTEST_SKIP() << "srtpenc is not installed";
  const auto refusal = [this](char digit) {
    const ElementBus bus(bin_.get());
    g_object_set(bin_.get(), "srtp-key", std::string(60, digit).c_str(), nullptr);
    return bus.Text(GST_MESSAGE_WARNING);
  };
  const std::string stays = "The SRTP key stays as it is: ";
  for (const char* factory : {"screamsink", "screamsrc"}) {
    const bool receives = std::string(factory) == "screamsrc";
    Make(factory);
    g_object_set(bin_.get(), "srtp-key", std::string(60, '5').c_str(), nullptr);
    if (receives) g_object_set(bin_.get(), "port", 0, nullptr);
    ASSERT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
    EXPECT_EQ(refusal('6'), "") << factory;
    EXPECT_EQ(refusal('7'), "") << factory;
    EXPECT_EQ(refusal('7'), "") << factory << ": it is the newest";
    EXPECT_EQ(refusal('6'), stays + "this key was in use before; set a new key.") << factory;
    EXPECT_EQ(refusal('8'),
              receives ? stays + "two new keys already wait for the sender to use them." : "")
        << factory;
    const char newest = receives ? '7' : '8';
    To(GST_STATE_NULL);
    ASSERT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
    EXPECT_EQ(refusal(newest), "") << factory;
    EXPECT_EQ(refusal('5'), "") << factory << " starts with the newest key, not with the first";
    To(GST_STATE_NULL);
  }
}

TEST_F(ScreamBin, AKeyInAFileMayEndWithANewline) {
  const ElementPtr srtp(gst_element_factory_make("srtpenc", nullptr));
  if (!srtp) GTEST_SKIP() << "srtpenc is not installed";
  gchar* name = nullptr;
  const int fd = g_file_open_tmp("lidar-key-XXXXXX", &name, nullptr);
  ASSERT_GE(fd, 0);
  g_close(fd, nullptr);
  const std::string path = name;
  g_free(name);
  g_file_set_contents(path.c_str(), (std::string(60, '5') + "\r\n").c_str(), -1, nullptr);
  Make("screamsink");
  g_object_set(bin_.get(), "srtp-key", ("file:" + path).c_str(), nullptr);
  EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
  g_unlink(path.c_str());
}

TEST_F(ScreamBin, TheSinkSaysGoodbyeAndReportsEachSecond) {
  Make("screamsink");
  for (const OwnedElement& element : {OwnedElement(GST_ELEMENT(gst_object_ref(bin_.get()))),
                                      OwnedElement(Child("screamtx").release())})
    EXPECT_TRUE(Of<gboolean>(element.get(), "send-bye"));
  EXPECT_EQ(Of<guint64>(bin_.get(), "sender-report-interval"), GST_SECOND);
  const ElementPtr udp = Child("ecnudpsink");
  EXPECT_FALSE(Of<gboolean>(udp.get(), "sync"));
  EXPECT_FALSE(Of<gboolean>(udp.get(), "async"));
}

TEST_F(ScreamBin, TheSinkIsNotLiveTheSourceIs) {
  Make("screamsink");
  EXPECT_EQ(To(GST_STATE_PAUSED), GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(To(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  Make("screamsrc");
  g_object_set(bin_.get(), "port", 0, nullptr);
  EXPECT_EQ(To(GST_STATE_PAUSED), GST_STATE_CHANGE_NO_PREROLL);
}

TEST_F(ScreamBin, SocketsStayWhileTheBinIsReadyAndGoWithIt) {
  Make("screamsrc");
  g_object_set(bin_.get(), "port", 0, nullptr);
  To(GST_STATE_PLAYING);
  const OwnedSocket used = SocketOf(bin_.get(), "used-socket");
  ASSERT_TRUE(used);
  To(GST_STATE_READY);
  EXPECT_EQ(SocketOf(bin_.get(), "used-socket"), used);
  To(GST_STATE_NULL);
  EXPECT_FALSE(SocketOf(bin_.get(), "used-socket"));
  EXPECT_TRUE(g_socket_is_closed(used.get()));
  Make("screamsink");
  To(GST_STATE_PLAYING);
  const ElementPtr udp = Child("ecnudpsink");
  const OwnedSocket sending = SocketOf(udp.get());
  ASSERT_TRUE(sending);
  EXPECT_EQ(SocketOf(Child("ecnudpsrc").get()), sending);
  EXPECT_FALSE(Of<gboolean>(udp.get(), "close-socket"));
  To(GST_STATE_READY);
  EXPECT_EQ(SocketOf(udp.get()), sending);
  To(GST_STATE_NULL);
  EXPECT_FALSE(SocketOf(udp.get()));
  EXPECT_TRUE(g_socket_is_closed(sending.get()));
}

TEST_F(ScreamBin, WhatCannotBeSecuredIsAnErrorThatSaysWhyAndKeepsNoSocket) {
  const std::string digits(59, '5');
  const std::string wrong = "the SRTP key must be 60 hexadecimal digits (master key and salt) for ";
  struct Case {
    std::string key, why;
    const char* cipher = "aes-128-icm";
    const char* auth = "hmac-sha1-80";
  };
  const Case cases[] = {
      {"env:LIDAR_NO_SUCH_KEY", "the environment has no variable LIDAR_NO_SUCH_KEY"},
      {"file:/no-such-folder/key", "No such file or directory"},
      {digits, wrong + "aes-128-icm"},
      {digits + "g", wrong + "aes-128-icm"},
      {"g" + digits, wrong + "aes-128-icm"},
      {digits + "5", "must be 88 hexadecimal digits (master key and salt) for aes-256-gcm",
       "aes-256-gcm"},
      {digits + "5", "srtp-cipher must be aes-128-icm, aes-256-icm, aes-128-gcm or aes-256-gcm",
       "aes"},
      {digits + "5", "srtp-auth must be hmac-sha1-80 or hmac-sha1-32", "aes-128-icm", "null"},
  };
  for (const char* factory : {"screamsink", "screamsrc"})
    for (const Case& c : cases) {
      Make(factory);
      const ElementBus bus(bin_.get());
      g_object_set(bin_.get(), "srtp-key", c.key.c_str(), "srtp-cipher", c.cipher, "srtp-auth",
                   c.auth, nullptr);
      if (std::string(factory) == "screamsrc") g_object_set(bin_.get(), "port", 0, nullptr);
      EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_FAILURE) << c.why;
      const std::string text = bus.Text(GST_MESSAGE_ERROR);
      EXPECT_EQ(text.find("SRTP cannot be used: "), 0U) << text;
      EXPECT_NE(text.find(c.why + "."), std::string::npos) << text;
      EXPECT_FALSE(SocketOf(Child("ecnudpsink").get())) << factory;
      EXPECT_FALSE(SocketOf(Child("ecnudpsrc").get())) << factory;
      To(GST_STATE_NULL);
    }
}

TEST_F(ScreamBin, TheSinkKeepsNoLinkOfAStartThatFailed) {
  Make("screamsink");
  g_object_set(bin_.get(), "bonding-addresses", "127.0.0.1:9@127.0.0.1,127.0.0.1:9@127.0.0.2",
               "srtp-key", "env:LIDAR_NO_SUCH_KEY", nullptr);
  const gst::PadPtr pad(gst_element_request_pad_simple(bin_.get(), "sink_%u"));
  for (int start = 0; start < 2; ++start) {
    EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_FAILURE);
    EXPECT_EQ(GST_BIN_NUMCHILDREN(bin_.get()), 3) << "one link, and no bond";
    const gst::PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(pad.get())));
    ASSERT_TRUE(target);
    EXPECT_EQ(GST_OBJECT_PARENT(target.get()), GST_OBJECT(Child("screamtx").get()));
    To(GST_STATE_NULL);
  }
  g_object_set(bin_.get(), "srtp-key", "", nullptr);
  EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(GST_BIN_NUMCHILDREN(bin_.get()), 7);
  To(GST_STATE_NULL);
  gst_element_release_request_pad(bin_.get(), pad.get());
}

TEST_F(ScreamBin, TheSourceDoesNotStartWhereItsPortIsTaken) {
  Make("screamsrc");
  g_object_set(bin_.get(), "port", FreePort(), nullptr);
  ASSERT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
  const OwnedElement first = std::move(bin_);
  Make("screamsrc");
  g_object_set(bin_.get(), "port", PortOf(first.get()), nullptr);
  EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_FAILURE);
  EXPECT_FALSE(SocketOf(bin_.get(), "used-socket"));
  gst_element_set_state(first.get(), GST_STATE_NULL);
  EXPECT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
}

TEST_F(ScreamBin, TheSourceNamesAMissingNextElementOnlyWhereThereIsNone) {
  Make("screamsrc");
  g_object_set(bin_.get(), "port", 0, nullptr);
  ASSERT_EQ(To(GST_STATE_READY), GST_STATE_CHANGE_SUCCESS);
  const ElementBus bus(bin_.get());
  const ElementPtr udp = Child("ecnudpsrc");
  const gst::ErrorPtr error(
      g_error_new_literal(GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_READ, "Receiving failed"));
  const auto text_of_error = [&](GstFlowReturn flow) {
    gst_element_post_message(
        udp.get(), gst_message_new_error_with_details(
                       GST_OBJECT(udp.get()), error.get(), "of the test",
                       gst_structure_new("details", "flow-return", G_TYPE_INT, flow, nullptr)));
    return bus.Text(GST_MESSAGE_ERROR);
  };
  EXPECT_EQ(text_of_error(GST_FLOW_NOT_LINKED),
            "The src pad is not linked; its stream is application/x-rtp.");
  EXPECT_EQ(text_of_error(GST_FLOW_ERROR), "Receiving failed");
  gst_element_post_message(udp.get(),
                           gst_message_new_error(GST_OBJECT(udp.get()), error.get(), ""));
  EXPECT_EQ(bus.Text(GST_MESSAGE_ERROR), "Receiving failed") << "without details";
  const gst::PadPtr src(gst_element_get_static_pad(bin_.get(), "src"));
  const gst::PadPtr next(GST_PAD(gst_object_ref_sink(gst_pad_new("sink", GST_PAD_SINK))));
  ASSERT_EQ(gst_pad_link(src.get(), next.get()), GST_PAD_LINK_OK);
  EXPECT_EQ(text_of_error(GST_FLOW_NOT_LINKED), "Receiving failed");
  gst_pad_unlink(src.get(), next.get());
}

TEST_F(ScreamBin, PadsOfTheSinkAreItsChildren) {
  Make("screamsink");
  auto* proxy = GST_CHILD_PROXY(bin_.get());
  const auto note =
      +[](GstChildProxy*, GObject*, const gchar* name, std::string* to) { *to = name; };
  g_signal_connect(proxy, "child-added", G_CALLBACK(note), &added_);
  g_signal_connect(proxy, "child-removed", G_CALLBACK(note), &removed_);
  EXPECT_EQ(gst_child_proxy_get_children_count(proxy), 3U);
  To(GST_STATE_READY);
  const gst::PadPtr ready(gst_element_request_pad_simple(bin_.get(), "sink_%u"));
  EXPECT_FALSE(gst_pad_is_active(ready.get()));
  To(GST_STATE_PAUSED);
  const gst::PadPtr pad(gst_element_request_pad_simple(bin_.get(), "sink_%u"));
  ASSERT_TRUE(pad);
  EXPECT_TRUE(gst_pad_is_active(pad.get()));
  EXPECT_EQ(added_, "sink_1");
  ASSERT_EQ(gst_child_proxy_get_children_count(proxy), 5U);
  for (guint i = 0; i < 6; ++i) {
    const std::unique_ptr<GObject, void (*)(gpointer)> child(
        gst_child_proxy_get_child_by_index(proxy, i), [](gpointer o) {
          if (o != nullptr) g_object_unref(o);
        });
    EXPECT_EQ(GST_IS_ELEMENT(child.get()), i < 3) << i;
    EXPECT_EQ(GST_IS_PAD(child.get()), i == 3 || i == 4) << i;
  }
  gst_element_release_request_pad(bin_.get(), pad.get());
  EXPECT_EQ(removed_, "sink_1");
  EXPECT_EQ(gst_child_proxy_get_children_count(proxy), 4U);
  gst_element_release_request_pad(bin_.get(), ready.get());
}

TEST_F(ScreamBin, APadOfTheSinkIsActiveWhereTheBinIs) {
  Make("screamsink");
  for (const auto& [state, active] : {std::pair(GST_STATE_NULL, false),
                                      {GST_STATE_READY, false},
                                      {GST_STATE_PAUSED, true},
                                      {GST_STATE_PLAYING, true}}) {
    To(state);
    const gst::PadPtr pad(gst_element_request_pad_simple(bin_.get(), "sink_%u"));
    EXPECT_EQ(gst_pad_is_active(pad.get()), active) << gst_element_state_get_name(state);
    gst_element_release_request_pad(bin_.get(), pad.get());
  }
}

TEST_F(ScreamBin, PadsOfTheReceiverComeAndGoAtTheSource) {
  Make("screamsrc");
  const ElementPtr rx = Child("screamrx");
  const auto shown = [this](const char* name) {
    return gst::PadPtr(gst_element_get_static_pad(bin_.get(), name)) != nullptr;
  };
  GstPad* stream = gst_pad_new("src_7", GST_PAD_SRC);
  GstPad* other = gst_pad_new("another", GST_PAD_SRC);
  gst_element_add_pad(rx.get(), stream);
  gst_element_add_pad(rx.get(), other);
  EXPECT_TRUE(shown("src_7"));
  EXPECT_FALSE(shown("another"));
  gst_element_remove_pad(rx.get(), stream);
  gst_element_remove_pad(rx.get(), other);
  EXPECT_FALSE(shown("src_7"));
  EXPECT_TRUE(shown("src"));
}

TEST_F(ScreamBin, StatisticsHaveWhatTheSocketsCount) {
  Make("screamsink");
  EXPECT_EQ(Stats(bin_.get())["send-errors"], 0U);
  g_signal_connect(bin_.get(), "notify::estimated-bitrate",
                   G_CALLBACK(+[](GObject*, GParamSpec*, int* n) { ++*n; }), &notified_);
  g_object_notify(G_OBJECT(Child("screamtx").get()), "estimated-bitrate");
  EXPECT_EQ(notified_, 1);
  Make("screamsrc");
  EXPECT_EQ(Stats(bin_.get())["dropped-by-kernel"], 0U);
}

/// A screamsink to which the test pushes feedback as its socket source does: single buffers or
/// lists.
class ScreamFeedbackFilter : public ScreamBin {
 protected:
  void Start(const char* host, bool strict) {
    Make("screamsink");
    g_object_set(bin_.get(), "host", host, "port", 5004, "strict-feedback", strict, nullptr);
    ASSERT_EQ(To(GST_STATE_PLAYING), GST_STATE_CHANGE_SUCCESS);
    const gst::PadPtr behind(gst_element_get_static_pad(Child("screamtx").get(), "rtcp_sink"));
    taken_ = 0;
    const auto count = [](GstPad*, GstPadProbeInfo*, gpointer n) -> GstPadProbeReturn {
      ++*static_cast<guint64*>(n);
      return GST_PAD_PROBE_OK;
    };
    gst_pad_add_probe(behind.get(), GST_PAD_PROBE_TYPE_BUFFER, count, &taken_, nullptr);
    // ecnudpsrc itself pushes nothing while its socket receives nothing, so the test can push from
    // its source pad.
    pad_.reset(gst_element_get_static_pad(Child("ecnudpsrc").get(), "src"));
    gst_pad_push_event(pad_.get(), gst_event_new_stream_start("feedback"));
    const gst::CapsPtr caps(gst_caps_new_empty_simple("application/x-rtcp"));
    gst_pad_push_event(pad_.get(), gst_event_new_caps(caps.get()));
    gst_pad_push_event(pad_.get(), NewSegment());
  }
  static GstBuffer* From(const char* address, guint port) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, 12, nullptr);
    gst_buffer_memset(buffer, 0, 0, 12);  // not RTCP
    GSocketAddress* from = g_inet_socket_address_new_from_string(address, port);
    gst_buffer_add_net_address_meta(buffer, from);
    g_object_unref(from);
    return buffer;
  }
  /// Returns the number of packets that passed and the number of packets that were dropped.
  std::pair<guint64, guint64> Counts() {
    return {taken_, Stats(bin_.get())["feedback-foreign-address"]};
  }
  using Pair = std::pair<guint64, guint64>;

  gst::PadPtr pad_;
  guint64 taken_ = 0;
};

TEST_F(ScreamFeedbackFilter, TakesItFromHostAndPortOrFromTheHost) {
  for (const bool strict : {true, false}) {
    Start("127.0.0.1", strict);
    gst_pad_push(pad_.get(), From("127.0.0.1", 5004));
    EXPECT_EQ(Counts(), Pair(1, 0));
    gst_pad_push(pad_.get(), From("127.0.0.1", 5005));
    EXPECT_EQ(Counts(), strict ? Pair(1, 1) : Pair(2, 0));
    gst_pad_push(pad_.get(), From("127.0.0.2", 5004));
    EXPECT_EQ(Counts(), strict ? Pair(1, 2) : Pair(2, 1));
    gst_pad_push(pad_.get(), gst_buffer_new_allocate(nullptr, 12, nullptr));  // has no address
    EXPECT_EQ(Counts(), strict ? Pair(1, 3) : Pair(2, 2));
    To(GST_STATE_NULL);
    To(GST_STATE_READY);
    EXPECT_EQ(Counts().second, 0U);
    To(GST_STATE_NULL);
  }
}

TEST_F(ScreamFeedbackFilter, LooksAtEachPacketOfAList) {
  Start("127.0.0.1", true);
  const auto push = [this](std::initializer_list<guint> ports) {
    GstBufferList* list = gst_buffer_list_new();
    for (const guint port : ports) gst_buffer_list_add(list, From("127.0.0.1", port));
    gst_pad_push_list(pad_.get(), list);
  };
  push({5004, 1, 5004, 2, 5004});
  EXPECT_EQ(Counts(), Pair(3, 2));
  push({1, 5004});
  EXPECT_EQ(Counts(), Pair(4, 3));
  push({1, 2});
  EXPECT_EQ(Counts(), Pair(4, 5));
}

TEST_F(ScreamFeedbackFilter, TakesItFromAnyReceiverOfAGroup) {
  Start("239.255.7.7", true);
  gst_pad_push(pad_.get(), From("127.0.0.2", 9));
  EXPECT_EQ(Counts(), Pair(1, 0));
}

}  // namespace
}  // namespace lidar::test
