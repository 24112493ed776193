// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/statistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gst/common/refs.h"

namespace {

/// An element whose property `stats` the test sets.
struct TalkingElement {
  GstElement parent;
  GstStructure* stats;
};
using TalkingElementClass = GstElementClass;
GType talking_element_get_type();
G_DEFINE_TYPE(TalkingElement, talking_element, GST_TYPE_ELEMENT)

void talking_element_init(TalkingElement* self) { self->stats = nullptr; }

void talking_element_finalize(GObject* object) {
  gst_structure_free(reinterpret_cast<TalkingElement*>(object)->stats);
  G_OBJECT_CLASS(talking_element_parent_class)->finalize(object);
}

void talking_element_class_init(TalkingElementClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->finalize = talking_element_finalize;
  object->get_property = [](GObject* self, guint, GValue* value, GParamSpec*) {
    gst_value_set_structure(value, reinterpret_cast<TalkingElement*>(self)->stats);
  };
  g_object_class_install_property(
      object, 1,
      g_param_spec_boxed("stats", nullptr, nullptr, GST_TYPE_STRUCTURE,
                         static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

}  // namespace

namespace lidar::web {
namespace {

GstElement* Talking(const char* name, const char* stats) {
  auto* element =
      static_cast<GstElement*>(g_object_new(talking_element_get_type(), "name", name, nullptr));
  reinterpret_cast<TalkingElement*>(element)->stats = gst_structure_from_string(stats, nullptr);
  return element;
}

TEST(Statistics, SumUpWhatElementsTellInTheirUnits) {
  const gst::ElementPtr pipeline(GST_ELEMENT(gst_object_ref_sink(gst_pipeline_new("robot"))));
  GstElement* net = Talking(
      "net",
      "s,target-bitrate=(guint64)8000000,sent-bitrate=(guint64)7000000,"
      "estimated-capacity=(guint64)9000000,queue-delay=(guint64)3000000,rtt=(guint64)25000000,"
      "ref-wnd=(guint64)41000,bytes-in-flight=(guint64)31000,packets-lost=(guint64)5;");
  GstElement* coder =
      Talking("coder", "s,step=(double)0.02,error-bound=(double)0.01,target-bitrate=(guint64)1;");
  GstElement* receiver = Talking("receiver", "s,packets-lost=(guint64)7,packets-ce=(guint64)2;");
  GstElement* depay = Talking("depay", "s,slices-lost=(guint64)11;");
  GstElement* odometry = Talking("odometry",
                                 "s,position-deviation=(double)0.5,scans-lost=(guint64)3,"
                                 "scans-degenerate=(guint64)4;");
  GstElement* bin = gst_bin_new("inner");
  gst_bin_add(GST_BIN(pipeline.get()), bin);
  gst_bin_add_many(GST_BIN(bin), coder, net, nullptr);
  gst_bin_add_many(GST_BIN(pipeline.get()), receiver, depay, odometry, nullptr);
  const auto message = nlohmann::json::parse(StatisticsOf(coder));
  const std::vector<std::pair<const char*, double>> expected = {
      {"target_bitrate", 8e6},     {"sent_bitrate", 7e6}, {"estimated_capacity", 9e6},
      {"queue_delay", 3},          {"rtt", 25},           {"ref_wnd", 41000},
      {"bytes_in_flight", 31000},  {"step", 0.02},        {"error_bound", 0.01},
      {"packets_lost", 7},         {"packets_ce", 2},     {"slices_lost", 11},
      {"position_deviation", 0.5}, {"poses_lost", 3},     {"poses_degenerate", 4}};
  for (const auto& [name, value] : expected)
    EXPECT_DOUBLE_EQ(message.value(name, -1.0), value) << name;
  EXPECT_EQ(message["elements"].size(), 5U);
  EXPECT_EQ(message["elements"]["net"]["rtt"], 25'000'000);
  const auto now = static_cast<double>(g_get_real_time()) / 1e6;
  EXPECT_NEAR(message["timestamp"]["sec"].get<double>(), now, 60);
  EXPECT_LT(message["timestamp"]["nsec"].get<std::uint64_t>(), 1'000'000'000U);
}

/// Returns the statistics message of a single element whose property `stats` is `stats`.
nlohmann::json MessageOf(const std::string& stats) {
  const gst::ElementPtr alone(GST_ELEMENT(gst_object_ref_sink(Talking("a", stats.c_str()))));
  return nlohmann::json::parse(StatisticsOf(alone.get()));
}

/// Returns statistics with a covariance that consists of the number `first` and `zeros` zeros.
std::string StatsWithCovariance(const std::string& first, int zeros) {
  std::string stats = "s,scans-degenerate=(guint64)0,covariance=(double)<" + first;
  for (int i = 0; i < zeros; ++i) stats += ",0";
  return stats + ">;";
}

TEST(Statistics, HaveNothingOfASenderThatHasReportedNothing) {
  const std::string rtt = "s,sender-rtt=(guint64)0,sender-reports=(guint64)";
  EXPECT_FALSE(MessageOf(rtt + "0;").contains("rtt"));
  EXPECT_TRUE(MessageOf(rtt + "1;").contains("rtt"));
}

/// A path in a Foxglove plot cannot contain dashes.
TEST(Statistics, HaveNoDashInTheNameOfAFieldHoweverDeep) {
  GValue links = G_VALUE_INIT;
  gst_value_array_init(&links, 1);
  GValue link = G_VALUE_INIT;
  g_value_init(&link, GST_TYPE_STRUCTURE);
  g_value_take_boxed(&link, gst_structure_new("link", "packets-lost", G_TYPE_INT, 7, nullptr));
  const gst::StructurePtr stats(gst_structure_new("s", "the-best", GST_TYPE_STRUCTURE,
                                                  gst_value_get_structure(&link), nullptr));
  gst_value_array_append_and_take_value(&links, &link);
  gst_structure_take_value(stats.get(), "all-links", &links);
  const gst::StringPtr text(gst_structure_to_string(stats.get()));
  auto element = MessageOf(text.get())["elements"]["a"];
  EXPECT_EQ(element["the_best"]["packets_lost"], 7) << element.dump();
  EXPECT_EQ(element["all_links"][0]["packets_lost"], 7) << element.dump();
}

TEST(Statistics, HaveACovarianceOf36FiniteNumbersOnly) {
  const auto message = MessageOf(StatsWithCovariance("0.25", 35));
  ASSERT_TRUE(message.contains("pose_covariance"));
  EXPECT_EQ(message["pose_covariance"].size(), 36U);
  EXPECT_EQ(message["pose_covariance"][0], 0.25);
  const std::string others[] = {StatsWithCovariance("0.25", 34), StatsWithCovariance("0.25", 36),
                                StatsWithCovariance("inf", 35), StatsWithCovariance("nan", 35),
                                "s,scans-degenerate=(guint64)0,covariance=(double)0.25;"};
  for (const std::string& other : others)
    EXPECT_FALSE(MessageOf(other).contains("pose_covariance")) << other;
}

TEST(Statistics, HaveNoSummaryOfAnArrayOrATextOrAnInfiniteNumber) {
  for (const char* rtt : {"(double)<1,2>", "(double)<>", "(string)slow", "(double)inf"}) {
    const std::string stats = std::string("s,ref-wnd=(guint64)41000,rtt=") + rtt + ";";
    nlohmann::json message;
    ASSERT_NO_THROW(message = MessageOf(stats)) << stats;
    EXPECT_EQ(message["ref_wnd"], 41'000);
    EXPECT_FALSE(message.contains("rtt")) << stats;
  }
}

TEST(Statistics, OfAnElementWithoutAPipelineAreItsOwn) {
  const gst::ElementPtr alone(GST_ELEMENT(gst_object_ref_sink(Talking("a", "s,rtt=(guint64)1;"))));
  const auto message = nlohmann::json::parse(StatisticsOf(alone.get()));
  EXPECT_EQ(message["elements"].size(), 1U);
  EXPECT_FALSE(message.contains("rtt"));  // the element is not a sender
}

}  // namespace
}  // namespace lidar::web
