// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of properties that all elements have in common. All plugins of this project are in one
// process.
#include <gst/gst.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "gst/common/refs.h"

#include "tests/support/element_bus.h"
#include "tests/support/patience.h"

namespace lidar::gst {
namespace {

/// Returns the names of this project's elements.
std::vector<std::string> OurElements() {
  std::set<std::string> names;
  GstRegistry* registry = gst_registry_get();
  GList* plugins = gst_registry_get_plugin_list(registry);
  for (GList* p = plugins; p != nullptr; p = p->next) {
    auto* plugin = static_cast<GstPlugin*>(p->data);
    if (std::string(gst_plugin_get_package(plugin)) != "gst-lidar") continue;
    GList* features =
        gst_registry_get_feature_list_by_plugin(registry, gst_plugin_get_name(plugin));
    for (GList* f = features; f != nullptr; f = f->next)
      if (GST_IS_ELEMENT_FACTORY(f->data)) names.insert(GST_OBJECT_NAME(f->data));
    gst_plugin_feature_list_free(features);
  }
  gst_plugin_list_free(plugins);
  return {names.begin(), names.end()};
}

ElementPtr Make(const std::string& factory) {
  ElementPtr element(gst_element_factory_make(factory.c_str(), nullptr));
  if (element) gst_object_ref_sink(element.get());
  return element;
}

/// Sets the ports of the element to 0, so that the system chooses free ports. Tests run at the same
/// time, so fixed ports could be taken.
void AvoidFixedPorts(GstElement* element) {
  for (const char* name : {"port", "lidar-port", "imu-port", "bind-port"}) {
    GParamSpec* spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), name);
    if (spec == nullptr || (spec->flags & G_PARAM_WRITABLE) == 0) continue;
    GValue zero = G_VALUE_INIT;
    g_value_init(&zero, spec->value_type);
    g_param_value_validate(spec, &zero);
    g_object_set_property(G_OBJECT(element), name, &zero);
    g_value_unset(&zero);
  }
}

class EveryElement : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryElement, ReadsAllItsPropertiesAndTakesItsDefaults) {
  const ElementPtr element = Make(GetParam());
  ASSERT_TRUE(element);
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element.get()), &count);
  for (guint i = 0; i < count; ++i) {
    GParamSpec* spec = specs[i];
    EXPECT_STRNE(g_param_spec_get_blurb(spec), nullptr) << spec->name;
    if (spec->flags & G_PARAM_READABLE) {
      GValue value = G_VALUE_INIT;
      g_value_init(&value, spec->value_type);
      g_object_get_property(G_OBJECT(element.get()), spec->name, &value);
      // In a new element, each property has the value that the element's documentation calls the
      // default.
      const bool settable = (spec->flags & G_PARAM_WRITABLE) != 0;
      if (settable && spec->owner_type == G_OBJECT_TYPE(element.get())) {
        EXPECT_TRUE(g_param_value_defaults(spec, &value)) << spec->name;
      }
      g_value_unset(&value);
    }
    const std::string name = spec->name;
    if ((spec->flags & G_PARAM_WRITABLE) && !(spec->flags & G_PARAM_CONSTRUCT_ONLY) &&
        name != "name" && name != "parent") {
      g_object_set_property(G_OBJECT(element.get()), spec->name,
                            g_param_spec_get_default_value(spec));
    }
  }
  g_free(specs);
}

TEST_P(EveryElement, HasMetadataThatSaysWhatItIs) {
  const ElementPtr element = Make(GetParam());
  auto* klass = GST_ELEMENT_GET_CLASS(element.get());
  for (const char* key : {GST_ELEMENT_METADATA_LONGNAME, GST_ELEMENT_METADATA_KLASS,
                          GST_ELEMENT_METADATA_DESCRIPTION, GST_ELEMENT_METADATA_AUTHOR}) {
    const gchar* text = gst_element_class_get_metadata(klass, key);
    ASSERT_NE(text, nullptr) << key;
    EXPECT_STRNE(text, "") << key;
  }
}

// Here an element has no peer, and may lack a setting that it needs. Therefore it may refuse to
// play. But it must be able to stop and start again.
TEST_P(EveryElement, GoesUpAndDownAgainAndAgain) {
  const ElementPtr pipeline(gst_pipeline_new(nullptr));
  GstElement* element = gst_element_factory_make(GetParam().c_str(), nullptr);
  ASSERT_NE(element, nullptr);
  AvoidFixedPorts(element);
  ASSERT_TRUE(gst_bin_add(GST_BIN(pipeline.get()), element));
  for (int cycle = 0; cycle < 3; ++cycle) {
    for (const GstState state : {GST_STATE_READY, GST_STATE_PAUSED, GST_STATE_PLAYING}) {
      if (gst_element_set_state(pipeline.get(), state) == GST_STATE_CHANGE_FAILURE) break;
      gst_element_get_state(pipeline.get(), nullptr, nullptr, 20 * GST_MSECOND);
    }
    EXPECT_EQ(gst_element_set_state(pipeline.get(), GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  }
}

/// Returns the number of heap bytes that are in use. With another allocator than glibc's, the
/// number is constant.
std::size_t HeapInUse() { return mallinfo2().uordblks; }

/// Expects that repeated calls of `make_and_free` do not increase the memory that is in use.
template <class MakeAndFree>
void ExpectNothingLeft(MakeAndFree make_and_free) {
  constexpr std::size_t kTimes = 60;
  constexpr std::size_t kLeast = 64;  // smaller than the state of any element
  // The first calls fill the caches of libraries.
  for (std::size_t i = 0; i < kTimes; ++i) make_and_free();
  const std::size_t before = HeapInUse();
  for (std::size_t i = 0; i < kTimes; ++i) make_and_free();
  EXPECT_LT(HeapInUse(), before + kTimes * kLeast);
}

TEST_P(EveryElement, LeavesNothingOnTheHeap) {
  ExpectNothingLeft([] { EXPECT_TRUE(Make(GetParam())); });
}

TEST_P(EveryElement, GivesItsRequestPadsAndTakesThemBack) {
  const ElementPtr element = Make(GetParam());
  auto* klass = GST_ELEMENT_GET_CLASS(element.get());
  for (GList* t = gst_element_class_get_pad_template_list(klass); t != nullptr; t = t->next) {
    auto* pad_template = GST_PAD_TEMPLATE(t->data);
    if (GST_PAD_TEMPLATE_PRESENCE(pad_template) != GST_PAD_REQUEST) continue;
    for (int again = 0; again < 2; ++again) {
      const PadPtr pad(gst_element_request_pad(element.get(), pad_template, nullptr, nullptr));
      ASSERT_TRUE(pad) << GST_PAD_TEMPLATE_NAME_TEMPLATE(pad_template);
      gst_element_release_request_pad(element.get(), pad.get());
    }
  }
}

std::string NameOf(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (g_ascii_isalnum(c) == FALSE) c = '_';
  return name;
}

// The list is written here because the registry is available only after gst_init(). The test below
// checks that the list is complete.
const std::vector<std::string> kElements = {
    "bitrateadapter",  "lidarenc",      "lidardec",     "dracodec",      "dracoenc",
    "ecnudpsink",      "ecnudpsrc",     "foxglovesink", "lidarodometry", "lidartestsrc",
    "mcapsink",        "mcapsrc",       "natssink",     "natssrc",       "pointcloudfilter",
    "pointcloudmerge", "ouster_src",    "pcdenc",       "plyenc",        "pointcloudparse",
    "pointcloudview",  "rtplidardepay", "ros2sink",     "ros2src",       "rtplidarpay",
    "scanassembler",   "screamaux",     "screamrx",     "screamsink",    "screamsrc",
    "screamtx"};

std::vector<std::string> Built() {
  gst_init(nullptr, nullptr);
  return OurElements();
}
INSTANTIATE_TEST_SUITE_P(All, EveryElement, ::testing::ValuesIn(Built()), NameOf);

class EveryBin : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(
    All, EveryBin,
    ::testing::Values(
        "screamsink bind-port=0", "screamsrc port=0", "screamaux",
        "screamsink bonding-addresses=127.0.0.1:5004@127.0.0.1,127.0.0.1:5006@127.0.0.2"));

TEST_P(EveryBin, LeavesNothingOfTheElementsThatItMade) {
  ExpectNothingLeft([] {
    const ElementPtr bin(gst_parse_launch(GetParam(), nullptr));
    ASSERT_TRUE(bin);
    const PadPtr pad(gst_element_request_pad_simple(bin.get(), "sink_%u"));
    for (const GstState state : {GST_STATE_READY, GST_STATE_NULL})
      EXPECT_EQ(gst_element_set_state(bin.get(), state), GST_STATE_CHANGE_SUCCESS);
    if (pad) gst_element_release_request_pad(bin.get(), pad.get());
  });
}

/// A pad of an element, and the pads to which the element forwards the events and queries of this
/// pad.
struct PadLinks {
  const char* factory;
  const char* pad;
  std::vector<std::string> others;
};

class LinkedPads : public ::testing::TestWithParam<PadLinks> {};
INSTANTIATE_TEST_SUITE_P(All, LinkedPads,
                         ::testing::Values(PadLinks{"screamrx", "sink", {"src"}},
                                           PadLinks{"screamrx", "src", {"sink"}},
                                           PadLinks{"screamrx", "rtcp_src", {}},
                                           PadLinks{"screamtx", "sink_0", {"src"}},
                                           PadLinks{"screamtx", "sink_1", {"src"}},
                                           PadLinks{"screamtx", "src", {"sink_0", "sink_1"}},
                                           PadLinks{"screamtx", "rtcp_sink", {"rtcp_src"}},
                                           PadLinks{"screamtx", "rtcp_src", {"rtcp_sink"}},
                                           PadLinks{"pointcloudfilter", "sink", {"src"}},
                                           PadLinks{"pointcloudfilter", "src", {"sink"}}));

TEST_P(LinkedPads, LeadToThePadsOfTheSameData) {
  const ElementPtr element = Make(GetParam().factory);
  ASSERT_TRUE(element);
  const bool merges = GetParam().factory == std::string("screamtx");
  const PadPtr first(merges ? gst_element_request_pad_simple(element.get(), "sink_0") : nullptr);
  const PadPtr second(merges ? gst_element_request_pad_simple(element.get(), "sink_1") : nullptr);
  const PadPtr pad(gst_element_get_static_pad(element.get(), GetParam().pad));
  ASSERT_TRUE(pad);
  std::vector<std::string> others;
  GstIterator* links = gst_pad_iterate_internal_links(pad.get());
  ASSERT_EQ(links == nullptr, GetParam().others.empty());
  if (links == nullptr) return;
  gst_iterator_foreach(
      links,
      [](const GValue* link, gpointer names) {
        static_cast<std::vector<std::string>*>(names)->emplace_back(
            GST_OBJECT_NAME(g_value_get_object(link)));
      },
      &others);
  gst_iterator_free(links);
  std::sort(others.begin(), others.end());
  EXPECT_EQ(others, GetParam().others);
}

TEST(AllPlugins, LoadIntoOneProcessAndHoldTheseElements) {
  const auto built = OurElements();
  ASSERT_GE(built.size(), 14U);  // elements that need an external library may be missing
  for (const std::string& name : built)
    EXPECT_EQ(std::count(kElements.begin(), kElements.end(), name), 1) << name << " is not listed";
}

/// Returns false if the pipeline contains an optional element that is not built.
bool IsBuilt(const std::string& description) {
  const auto built = OurElements();
  for (const std::string& name : kElements)
    if (description.find(name) != std::string::npos &&
        std::count(built.begin(), built.end(), name) == 0)
      return false;
  return true;
}

class TypicalPipelines : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(
    All, TypicalPipelines,
    ::testing::Values(
        "lidartestsrc model=os1-32 mode=512x10 ! scanassembler ! tee name=t "
        "t. ! queue ! pcdenc ! fakesink t. ! queue ! plyenc ! fakesink "
        "t. ! queue ! pointcloudview width=320 height=180 ! fakesink",
        "lidartestsrc is-live=true model=os1-32 mode=512x10 ! scanassembler ! fakesink sync=true",
        "lidartestsrc model=os1-32 mode=512x10 ! lidarenc ! lidardec ! scanassembler ! fakesink",
        "lidartestsrc model=os1-32 mode=512x10 ! dracoenc ! dracodec ! scanassembler ! fakesink",
        "lidartestsrc model=os1-32 mode=512x10 ! lidarenc ! rtplidarpay ! rtplidardepay ! lidardec "
        "! fakesink",
        "lidartestsrc model=os1-32 mode=512x10 ! dracoenc ! rtplidarpay ! rtplidardepay ! dracodec "
        "! fakesink",
        "lidartestsrc is-live=true model=os1-32 mode=512x10 ! lidarenc ! rtplidarpay ! screamtx ! "
        "screamrx ! rtplidardepay ! lidardec ! scanassembler ! fakesink"));

TEST_P(TypicalPipelines, PlayFourTimesInARow) {
  if (!IsBuilt(GetParam())) GTEST_SKIP() << "an element is not built";
  GError* error = nullptr;
  const ElementPtr pipeline(gst_parse_launch(GetParam(), &error));
  ASSERT_EQ(error, nullptr) << error->message;
  const test::ElementBus bus(pipeline.get());
  for (int cycle = 0; cycle < 4; ++cycle) {
    ASSERT_NE(gst_element_set_state(pipeline.get(), GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
    // In every second cycle the pipeline is stopped before it has reached PLAYING.
    if (cycle % 2 == 0) {
      EXPECT_EQ(gst_element_get_state(pipeline.get(), nullptr, nullptr, test::kPatience_ns),
                GST_STATE_CHANGE_SUCCESS);
    }
    EXPECT_EQ(gst_element_set_state(pipeline.get(), GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
    EXPECT_FALSE(message);
  }
}

}  // namespace
}  // namespace lidar::gst
