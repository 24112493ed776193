// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of bitrateadapter after real encoders, and after stand-ins for encoders that need hardware.
#include <gst/base/gstbasetransform.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "gst/lidar/gstlidar.h"
#include "tests/support/harness.h"

namespace {

using lidar::gst::ElementPtr;
using lidar::gst::EventPtr;
using lidar::gst::PadPtr;
using lidar::gst::StructurePtr;

// A stand-in for an encoder. It passes all buffers unchanged, and has the bitrate properties of all
// known encoders.
struct StandIn {
  GstBaseTransform parent;
  guint bitrate;
  gint target_bitrate;
  guint bps;
  GstStructure* controls;
};
struct StandInClass {
  GstBaseTransformClass parent;
};
G_DEFINE_TYPE(StandIn, stand_in, GST_TYPE_BASE_TRANSFORM)

void stand_in_init(StandIn* self) {
  self->controls = gst_structure_new("controls", "h264_profile", G_TYPE_INT, 4, nullptr);
  gst_base_transform_set_passthrough(&self->parent, TRUE);
}

void SetStandIn(GObject* o, guint id, const GValue* v, GParamSpec*) {
  auto* self = reinterpret_cast<StandIn*>(o);
  if (id == 1) self->bitrate = g_value_get_uint(v);
  if (id == 2) self->target_bitrate = g_value_get_int(v);
  if (id == 3) self->bps = g_value_get_uint(v);
  if (id != 4) return;
  gst_structure_free(self->controls);
  self->controls = gst_structure_copy(gst_value_get_structure(v));
}

void GetStandIn(GObject* o, guint id, GValue* v, GParamSpec*) {
  auto* self = reinterpret_cast<StandIn*>(o);
  if (id == 1) g_value_set_uint(v, self->bitrate);
  if (id == 2) g_value_set_int(v, self->target_bitrate);
  if (id == 3) g_value_set_uint(v, self->bps);
  if (id == 4) gst_value_set_structure(v, self->controls);
}

void stand_in_class_init(StandInClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetStandIn;
  object->get_property = GetStandIn;
  object->finalize = [](GObject* o) {
    gst_structure_free(reinterpret_cast<StandIn*>(o)->controls);
    G_OBJECT_CLASS(stand_in_parent_class)->finalize(o);
  };
  constexpr auto flags = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
  g_object_class_install_property(object, 1,
                                  g_param_spec_uint("bitrate", "", "", 1, 2'048'000'000, 1, flags));
  g_object_class_install_property(
      object, 2, g_param_spec_int("target-bitrate", "", "", 0, G_MAXINT, 0, flags));
  g_object_class_install_property(object, 3,
                                  g_param_spec_uint("bps", "", "", 0, G_MAXUINT, 0, flags));
  g_object_class_install_property(
      object, 4, g_param_spec_boxed("extra-controls", "", "", GST_TYPE_STRUCTURE, flags));
  auto* element = GST_ELEMENT_CLASS(klass);
  static GstStaticPadTemplate sink =
      GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);
  static GstStaticPadTemplate src =
      GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);
  gst_element_class_add_static_pad_template(element, &sink);
  gst_element_class_add_static_pad_template(element, &src);
  gst_element_class_set_static_metadata(element, "Stand-in", "Codec/Encoder/Video", "For tests",
                                        "The gst-lidar developers");
}

/// Registers the stand-in as `factory`. Each factory gets its own type, because GStreamer finds the
/// factory of an element by the element's type.
void RegisterStandIn(const std::string& factory) {
  if (GstElementFactory* known = gst_element_factory_find(factory.c_str()); known != nullptr) {
    gst_object_unref(known);
    return;
  }
  GTypeQuery query;
  g_type_query(stand_in_get_type(), &query);
  const GType type = g_type_register_static_simple(
      stand_in_get_type(), ("StandIn-" + factory).c_str(), static_cast<guint16>(query.class_size),
      nullptr, static_cast<guint16>(query.instance_size), nullptr, static_cast<GTypeFlags>(0));
  gst_element_register(nullptr, factory.c_str(), GST_RANK_NONE, type);
}

/// A chain of elements that ends in the bitrateadapter `a`. Only `a` is started: the bitrate of an
/// encoder can be set without the hardware that the encoder needs to run.
class Chain {
 public:
  explicit Chain(const std::string& description)
      : bin_(GST_ELEMENT(gst_object_ref_sink(
            gst_parse_launch((description + " ! fakesink name=end").c_str(), nullptr)))) {
    gst_element_set_state(Find("a").get(), GST_STATE_PAUSED);
    const PadPtr pad(gst_element_get_static_pad(Find("end").get(), "sink"));
    gst_pad_set_active(pad.get(), TRUE);
  }
  ~Chain() { gst_element_set_state(bin_.get(), GST_STATE_NULL); }

  /// Sends a target bitrate upstream, from the end of the chain.
  bool Send(guint bps) {
    const GstLidarTargetBitrate target{bps, 1, 0, 0, 0, 0, "update"};
    const ElementPtr end(Find("end"));
    const PadPtr pad(gst_element_get_static_pad(end.get(), "sink"));
    return gst_pad_push_event(pad.get(), gst_lidar_event_new_target_bitrate(&target)) != FALSE;
  }
  ElementPtr Find(const char* name) const {
    return ElementPtr(gst_bin_get_by_name(GST_BIN(bin_.get()), name));
  }
  GstElement* get() { return bin_.get(); }

 private:
  ElementPtr bin_;
};

guint Uint(const ElementPtr& element, const char* property) {
  guint value = 0;
  g_object_get(element.get(), property, &value, nullptr);
  return value;
}

struct Known {
  const char* factory;
  const char* property;
  gint64 at_2_mbps;
};

class KnownEncoders : public ::testing::TestWithParam<Known> {};

TEST_P(KnownEncoders, GetTheTargetInTheirOwnUnit) {
  const Known known = GetParam();
  RegisterStandIn(known.factory);
  // A known property keeps its unit if the user names the property.
  for (const std::string& said : {std::string(), std::string(" property=") + known.property}) {
    Chain chain(std::string(known.factory) + " name=e ! identity ! bitrateadapter name=a" + said);
    EXPECT_TRUE(chain.Send(2'000'000));
    const ElementPtr encoder = chain.Find("e");
    GValue value = G_VALUE_INIT;
    g_value_init(&value, G_TYPE_INT64);
    g_object_get_property(G_OBJECT(encoder.get()), known.property, &value);
    EXPECT_EQ(g_value_get_int64(&value), known.at_2_mbps) << said;
    EXPECT_EQ(Uint(chain.Find("a"), "bitrate"), 2'000'000U) << said;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, KnownEncoders,
    ::testing::Values(Known{"x264enc", "bitrate", 2000}, Known{"openh264enc", "bitrate", 2000000},
                      Known{"vp8enc", "target-bitrate", 2000000},
                      Known{"av1enc", "target-bitrate", 2000}, Known{"nvh264enc", "bitrate", 2000},
                      Known{"nvv4l2h264enc", "bitrate", 2000000},
                      Known{"omxh264enc", "target-bitrate", 2000000},
                      Known{"vah264enc", "bitrate", 2000}, Known{"vaapih265enc", "bitrate", 2000},
                      Known{"qsvh264enc", "bitrate", 2000}, Known{"msdkh264enc", "bitrate", 2000},
                      Known{"amfh264enc", "bitrate", 2000}, Known{"mpph264enc", "bps", 2000000}),
    [](const auto& known) { return std::string(known.param.factory); });

TEST(BitrateAdapter, ChangesOneOfTheControlsOfAV4l2EncoderAndLeavesTheOthers) {
  RegisterStandIn("v4l2h264enc");
  Chain chain("v4l2h264enc name=e ! bitrateadapter name=a");
  EXPECT_TRUE(chain.Send(1'500'000));
  GstStructure* controls = nullptr;
  g_object_get(chain.Find("e").get(), "extra-controls", &controls, nullptr);
  const StructurePtr owner(controls);
  gint bitrate = 0;
  gint profile = 0;
  EXPECT_TRUE(gst_structure_get_int(controls, "video_bitrate", &bitrate));
  EXPECT_TRUE(gst_structure_get_int(controls, "h264_profile", &profile));
  EXPECT_EQ(bitrate, 1'500'000);
  EXPECT_EQ(profile, 4);
  EXPECT_TRUE(chain.Send(4'000'000'000));
  EXPECT_EQ(Uint(chain.Find("a"), "bitrate"), 2'147'483'647U) << "the most that a control holds";
}

TEST(BitrateAdapter, KeepsToItsLimitsAndItsFraction) {
  Chain chain("vp8enc name=e ! bitrateadapter name=a min=300000 max=3000000 fraction=0.5");
  const auto target = [&] {
    gint value = 0;
    g_object_get(chain.Find("e").get(), "target-bitrate", &value, nullptr);
    return value;
  };
  chain.Send(2'000'000);
  EXPECT_EQ(target(), 1'000'000);
  chain.Send(40'000'000);
  EXPECT_EQ(target(), 3'000'000);
  chain.Send(1);
  EXPECT_EQ(target(), 300'000);
}

TEST(BitrateAdapter, SaysThatItsBitrateHasChangedWhereItHas) {
  Chain chain("vp8enc name=e ! bitrateadapter name=a max=3000000");
  unsigned changes = 0;
  const ElementPtr adapter = chain.Find("a");
  g_signal_connect(
      adapter.get(), "notify::bitrate",
      G_CALLBACK(+[](GObject*, GParamSpec*, gpointer n) { ++*static_cast<unsigned*>(n); }),
      &changes);
  for (const auto& [bps, expected] :
       {std::pair(2'000'000U, 1U), std::pair(2'000'000U, 1U), std::pair(5'000'000U, 2U),
        std::pair(6'000'000U, 2U), std::pair(1'000'000U, 3U)}) {
    chain.Send(bps);
    EXPECT_EQ(changes, expected) << bps;
    EXPECT_EQ(Uint(adapter, "bitrate"), std::min(bps, 3'000'000U));
  }
}

TEST(BitrateAdapter, LeavesNoEncoderToItsOwnChoice) {
  RegisterStandIn("mpph264enc");
  Chain chain("mpph264enc name=e ! bitrateadapter name=a fraction=0.001");
  EXPECT_TRUE(chain.Send(1));
  EXPECT_EQ(Uint(chain.Find("e"), "bps"), 1U) << "0 is automatic";
}

TEST(BitrateAdapter, TellsItsLimitsDownstreamBehindTheCaps) {
  struct Case {
    const char* properties;
    guint min, nominal, max;
  };
  constexpr guint kNone = G_MAXUINT;
  gst_lidar_init();
  for (const Case& want :
       {Case{"min=500000 max=2000000", 500'000, 2'000'000, 2'000'000},
        Case{"min=500000 max=2000000 fraction=0.25", 2'000'000, 8'000'000, 8'000'000},
        Case{"min=500000", 500'000, kNone, kNone}, Case{"max=2000000", 0, 2'000'000, 2'000'000},
        Case{"min=3 max=4000000000 fraction=0.5", 6, kNone, kNone},
        Case{"fraction=0.5", 0, 0, 0}}) {
    const lidar::test::Harness h(
        gst_harness_new_parse((std::string("bitrateadapter ") + want.properties).c_str()));
    gst_harness_set_src_caps_str(h.get(), "video/x-h264");
    GstLidarBitrateBounds bounds{};
    while (const EventPtr event{gst_harness_try_pull_event(h.get())})
      if (gst_lidar_event_parse_bitrate_bounds(event.get(), &bounds)) break;
    EXPECT_EQ(bounds.min_bitrate, want.min) << want.properties;
    EXPECT_EQ(bounds.nominal_bitrate, want.nominal) << want.properties;
    EXPECT_EQ(bounds.max_bitrate, want.max) << want.properties;
  }
}

TEST(BitrateAdapter, TellsChangedLimitsDownstreamWithTheNextBuffer) {
  gst_lidar_init();
  const lidar::test::Harness h(gst_harness_new_parse("bitrateadapter name=a max=2000000"));
  gst_harness_set_src_caps_str(h.get(), "video/x-h264");
  const ElementPtr adapter(gst_bin_get_by_name(GST_BIN(h->element), "a"));
  const auto told_max = [&] {
    EXPECT_EQ(gst_harness_push(h.get(), gst_buffer_new()), GST_FLOW_OK);
    guint max = 0;
    GstLidarBitrateBounds bounds{};
    while (const EventPtr event{gst_harness_try_pull_event(h.get())})
      if (gst_lidar_event_parse_bitrate_bounds(event.get(), &bounds)) max = bounds.max_bitrate;
    return max;
  };
  EXPECT_EQ(told_max(), 2'000'000U);
  EXPECT_EQ(told_max(), 0U);
  g_object_set(adapter.get(), "max", 5'000'000, nullptr);
  EXPECT_EQ(told_max(), 5'000'000U);
  g_object_set(adapter.get(), "max", G_MAXUINT, nullptr);
  EXPECT_EQ(told_max(), G_MAXUINT);
}

TEST(BitrateAdapter, HasToldNothingYetInASecondRun) {
  Chain chain("vp8enc name=e ! bitrateadapter name=a");
  chain.Send(700'000);
  EXPECT_EQ(Uint(chain.Find("a"), "bitrate"), 700'000U);
  gst_element_set_state(chain.Find("a").get(), GST_STATE_READY);
  gst_element_set_state(chain.Find("a").get(), GST_STATE_PAUSED);
  EXPECT_EQ(Uint(chain.Find("a"), "bitrate"), 0U);
}

TEST(BitrateAdapter, FindsTheEncoderWithinABinAndPastParsers) {
  Chain chain("( vp8enc name=e ! identity ) ! queue ! capsfilter ! bitrateadapter name=a");
  EXPECT_TRUE(chain.Send(700'000));
  gint value = 0;
  g_object_get(chain.Find("e").get(), "target-bitrate", &value, nullptr);
  EXPECT_EQ(value, 700'000);
}

TEST(BitrateAdapter, ObeysWhatTheUserSaysOfAnUnknownEncoder) {
  RegisterStandIn("foreignenc");
  Chain chain("foreignenc name=e ! bitrateadapter name=a encoder=e property=bps scale=0.01");
  EXPECT_TRUE(chain.Send(1'000'000));
  EXPECT_EQ(Uint(chain.Find("e"), "bps"), 10'000U);
}

TEST(BitrateAdapter, FindsNoEncoderBehindAnElementOfSeveralStreams) {
  Chain chain("vp8enc name=e ! f. vp8enc name=other ! f. funnel name=f ! bitrateadapter name=a");
  gint before = 0;
  g_object_get(chain.Find("e").get(), "target-bitrate", &before, nullptr);
  chain.Send(700'000);
  EXPECT_EQ(Uint(chain.Find("a"), "bitrate"), 0U);
  for (const char* name : {"e", "other"}) {
    gint after = 0;
    g_object_get(chain.Find(name).get(), "target-bitrate", &after, nullptr);
    EXPECT_EQ(after, before) << name;
  }
}

TEST(BitrateAdapter, FindsTheEncoderInFrontOfItsBin) {
  RegisterStandIn("mpph264enc");
  Chain chain("mpph264enc name=e ! ( identity ! bitrateadapter name=a )");
  const ElementPtr bin(GST_ELEMENT(gst_object_get_parent(GST_OBJECT(chain.Find("a").get()))));
  gst_element_set_state(bin.get(), GST_STATE_PAUSED);
  EXPECT_TRUE(chain.Send(700'000));
  EXPECT_EQ(Uint(chain.Find("e"), "bps"), 700'000U);
}

TEST(BitrateAdapter, LetsTheEventPassAndSaysSoWhereTheEncoderTakesNoBitrate) {
  RegisterStandIn("foreignenc");
  for (const char* said : {"", " property=nothing", " property=extra-controls"}) {
    Chain chain(std::string("foreignenc name=e ! bitrateadapter name=a") + said);
    GstBus* bus = gst_bus_new();
    gst_element_set_bus(chain.get(), bus);
    const PadPtr pad(gst_element_get_static_pad(chain.Find("a").get(), "sink"));
    guint passed = 0;
    gst_pad_add_probe(
        pad.get(), GST_PAD_PROBE_TYPE_EVENT_UPSTREAM,
        [](GstPad*, GstPadProbeInfo* info, gpointer count) {
          const bool target = GST_EVENT_TYPE(info->data) == GST_EVENT_CUSTOM_UPSTREAM;
          *static_cast<guint*>(count) += target ? 1U : 0U;
          return GST_PAD_PROBE_OK;
        },
        &passed, nullptr);
    for (int i = 0; i < 2; ++i) chain.Send(1'000'000);
    EXPECT_EQ(passed, 2U) << said;
    const lidar::gst::MessagePtr first(gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING));
    const lidar::gst::MessagePtr second(gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING));
    ASSERT_TRUE(first) << said;
    EXPECT_FALSE(second) << said;
    GError* error = nullptr;
    gst_message_parse_warning(first.get(), &error, nullptr);
    EXPECT_STREQ(error->message, "The bitrate of this encoder cannot be set.");
    g_error_free(error);
    gst_element_set_bus(chain.get(), nullptr);
    gst_object_unref(bus);
  }
}

TEST(BitrateAdapter, LetsTheEventPassAndWarnsOnceWhereThereIsNoEncoder) {
  Chain chain("identity ! bitrateadapter name=a");
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(chain.get(), bus);
  for (int run = 0; run < 2; ++run) {
    chain.Send(1'000'000);
    chain.Send(2'000'000);
    const lidar::gst::MessagePtr first(gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING));
    const lidar::gst::MessagePtr second(gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING));
    EXPECT_TRUE(first) << run;
    EXPECT_FALSE(second) << run;
    EXPECT_EQ(Uint(chain.Find("a"), "bitrate"), 0U);
    gst_element_set_state(chain.Find("a").get(), GST_STATE_READY);
    gst_element_set_state(chain.Find("a").get(), GST_STATE_PAUSED);
  }
  gst_element_set_bus(chain.get(), nullptr);
  gst_object_unref(bus);
}

}  // namespace
