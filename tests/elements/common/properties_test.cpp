// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the tables of properties and statistics, with a GObject that is made for this test.
#include "gst/common/properties.h"

#include <gtest/gtest.h>

#include <mutex>

#include "gst/common/enum_type.h"
#include "gst/common/stats.h"

namespace lidar::gst {
// The namespace needs a name, because types at file scope have members of its types.
inline namespace properties_test {

enum class Colour { kRed, kGreen = 7 };
GType ColourType() {
  static const GEnumValue values[] = {
      {0, "Red", "red"}, {7, "Green", "green"}, {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("TestColour", values);
  return type;
}

struct Nested {
  gdouble factor = 0.7;
  Duration wait = std::chrono::milliseconds(60);
  DataSize packet = DataSize::Bytes(1000);
  DataRate rate = DataRate::BitsPerSecond(50e3);
  struct Deeper {
    bool on = true;
  } deeper;
};

struct Settings {
  guint port = 5004;
  gint level = -1;
  guint64 ns = 5;
  std::string host = "here";
  std::string empty;
  Colour colour = Colour::kGreen;
  gint plain_enum = 7;
  SharedCaps caps;
  Nested nested;
};

struct State {
  std::mutex mutex;
  Settings settings;
  int changes = 0;
};

}  // namespace properties_test
}  // namespace lidar::gst

struct TestThing {
  GObject parent;
  lidar::gst::State* state;
};
struct TestThingClass {
  GObjectClass parent;
};
static GType test_thing_get_type();
G_DEFINE_TYPE(TestThing, test_thing, G_TYPE_OBJECT)

/// A bin with the property `port` of its child TestThing, but with another default.
struct TestBin {
  GObject parent;
  struct State {
    std::mutex mutex;
    lidar::gst::Settings settings;
    GObject* thing;
  } * state;
};
struct TestBinClass {
  GObjectClass parent;
};
static GType test_bin_get_type();
G_DEFINE_TYPE(TestBin, test_bin, G_TYPE_OBJECT)

namespace lidar::gst {
namespace {

StructurePtr Stats(GObject*) { return StructurePtr(gst_structure_new_empty("counts")); }
guint Changes(GObject* o) {
  State& state = *reinterpret_cast<TestThing*>(o)->state;
  const std::lock_guard lock(state.mutex);  // would block for ever if the caller held the lock
  return static_cast<guint>(state.changes);
}
void Changed(GObject* o, GParamSpec*) { ++reinterpret_cast<TestThing*>(o)->state->changes; }

const std::array<Property<Nested>, 2> kNestedRows = {{
    {"factor", "Factor", &Nested::factor, 0.1, 1},
    {"wait", "Time [ns]", &Nested::wait, 1e6, 60e9},
}};
const std::array<Property<Settings>, 15> kProperties = {{
    {"port", "UDP port", &Settings::port, 1, 65535},
    {"level", "Level", &Settings::level, -1, 63, GST_PARAM_MUTABLE_PLAYING},
    {"ns", "Time [ns]", &Settings::ns, 0, 1e30},
    {"host", "Host", &Settings::host},
    {"empty", "Empty", &Settings::empty, 0, 0, G_PARAM_WRITABLE},
    {"colour", "Colour", EnumField<Settings, Colour>{&Settings::colour, ColourType}},
    {"plain-enum", "Colour", EnumField<Settings>{&Settings::plain_enum, ColourType}},
    {"caps", "Caps", &Settings::caps},
    Within<&Settings::nested>(kNestedRows, "factor"),
    {"wait", "Time [ns]", At<&Settings::nested, &Nested::wait>, 1e6, 60e9},
    {"packet", "Size [bytes]", At<&Settings::nested, &Nested::packet>, 100, 65535},
    {"rate", "Rate [bit/s]", At<&Settings::nested, &Nested::rate>, 1000, 4294967295.0},
    {"on", "Switch", At<&Settings::nested, &Nested::deeper, &Nested::Deeper::on>},
    {"stats", "Counters", Stats},
    {"changes", "Changes", Changes},
}};

GObject* ThingOf(GObject* bin) { return reinterpret_cast<TestBin*>(bin)->state->thing; }
const Settings& BinDefaults() {
  static const Settings defaults = [] {
    Settings s;
    s.port = 99;
    return s;
  }();
  return defaults;
}
const std::array<Property<Settings>, 3>& BinProperties() {
  static const std::array<Property<Settings>, 3> table = {{
      {"own", "Of the bin", &Settings::host},
      Proxy<Settings>(kProperties, "port", ThingOf, &BinDefaults()),
      Proxy<Settings>(kProperties, "changes", ThingOf),
  }};
  return table;
}

struct Counts {
  guint64 packets = 3;
  DataSize bytes = DataSize::Bytes(3600);
  Duration delay = std::chrono::milliseconds(2);
  DataRate rate = DataRate::BitsPerSecond(1e6);
  guint sockets = 2;
  bool on = true;
  const char* state() const { return "good"; }
};
const std::array<Stat<Counts>, 7> kStats = {{
    {"packets", &Counts::packets},
    {"bytes", &Counts::bytes},
    {"delay", &Counts::delay},
    {"rate", &Counts::rate},
    {"sockets", &Counts::sockets},
    {"on", &Counts::on},
    {"state", +[](const Counts& c) { return c.state(); }},
}};

class PropertyTable : public ::testing::Test {
 protected:
  PropertyTable() : thing_(static_cast<GObject*>(g_object_new(test_thing_get_type(), nullptr))) {}
  ~PropertyTable() override { g_object_unref(thing_); }
  GParamSpec* Spec(const char* name) {
    return g_object_class_find_property(G_OBJECT_GET_CLASS(thing_), name);
  }
  template <class T>
  T Get(const char* name) {
    T value{};
    g_object_get(thing_, name, &value, nullptr);
    return value;
  }
  const Settings& settings() { return reinterpret_cast<TestThing*>(thing_)->state->settings; }
  GObject* thing_;
};

TEST_F(PropertyTable, TakesDefaultsAndRangesFromTheFields) {
  auto* port = G_PARAM_SPEC_UINT(Spec("port"));
  EXPECT_EQ(port->default_value, 5004U);
  EXPECT_EQ(port->minimum, 1U);
  EXPECT_EQ(port->maximum, 65535U);
  EXPECT_EQ(G_PARAM_SPEC_UINT64(Spec("ns"))->maximum, G_MAXUINT64);
  EXPECT_DOUBLE_EQ(G_PARAM_SPEC_DOUBLE(Spec("factor"))->default_value, 0.7);
  EXPECT_EQ(G_PARAM_SPEC_UINT64(Spec("wait"))->default_value, 60 * GST_MSECOND);
  EXPECT_EQ(G_PARAM_SPEC_UINT(Spec("packet"))->default_value, 1000U);
  EXPECT_EQ(G_PARAM_SPEC_UINT(Spec("rate"))->default_value, 50'000U);
  EXPECT_EQ(G_PARAM_SPEC_UINT(Spec("rate"))->maximum, G_MAXUINT);
  EXPECT_EQ(G_PARAM_SPEC_ENUM(Spec("colour"))->default_value, 7);
  EXPECT_EQ(G_PARAM_SPEC_UINT(Spec("changes"))->maximum, G_MAXUINT);
  EXPECT_STREQ(G_PARAM_SPEC_STRING(Spec("host"))->default_value, "here");
  EXPECT_EQ(Spec("caps")->value_type, GST_TYPE_CAPS);
  EXPECT_EQ(Spec("stats")->value_type, GST_TYPE_STRUCTURE);
}

TEST_F(PropertyTable, SaysWhoMayReadAndWrite) {
  EXPECT_EQ(Spec("port")->flags & G_PARAM_READWRITE, G_PARAM_READWRITE);
  EXPECT_TRUE(Spec("port")->flags & GST_PARAM_MUTABLE_READY);
  EXPECT_TRUE(Spec("level")->flags & GST_PARAM_MUTABLE_PLAYING);
  EXPECT_EQ(Spec("empty")->flags & G_PARAM_READWRITE, G_PARAM_WRITABLE);
  EXPECT_EQ(Spec("stats")->flags & G_PARAM_READWRITE, G_PARAM_READABLE);
  EXPECT_FALSE(Spec("stats")->flags & GST_PARAM_MUTABLE_READY);
}

TEST_F(PropertyTable, SetsAndReadsEachKind) {
  const CapsPtr caps(gst_caps_new_empty_simple("x/y"));
  g_object_set(thing_, "port", 7U, "level", 5, "ns", guint64{9}, "host", "there", "empty", "x",
               "colour", 0, "plain-enum", 0, "caps", caps.get(), "factor", 0.5, "wait",
               guint64{2'000'000}, "packet", 900U, "rate", 2'000U, "on", FALSE, nullptr);
  const Settings& s = settings();
  EXPECT_EQ(s.empty, "x");
  EXPECT_EQ(s.colour, Colour::kRed);
  EXPECT_EQ(s.nested.wait, std::chrono::milliseconds(2));
  EXPECT_EQ(s.nested.packet, DataSize::Bytes(900));
  EXPECT_EQ(s.nested.rate, DataRate::BitsPerSecond(2000));
  EXPECT_FALSE(s.nested.deeper.on);
  EXPECT_EQ(Get<guint>("port"), 7U);
  EXPECT_EQ(Get<gint>("level"), 5);
  EXPECT_EQ(Get<guint64>("ns"), 9U);
  EXPECT_EQ(Get<guint64>("wait"), 2'000'000U);
  EXPECT_EQ(Get<guint>("packet"), 900U);
  EXPECT_EQ(Get<gint>("colour"), 0);
  EXPECT_EQ(Get<gdouble>("factor"), 0.5);
  EXPECT_EQ(CapsPtr(Get<GstCaps*>("caps")).get(), caps.get());
  EXPECT_STREQ(StringPtr(Get<gchar*>("host")).get(), "there");
}

TEST_F(PropertyTable, FreesWhatAFieldHeld) {
  const CapsPtr caps(gst_caps_new_empty_simple("x/y"));
  g_object_set(thing_, "caps", caps.get(), nullptr);
  EXPECT_EQ(GST_CAPS_REFCOUNT_VALUE(caps.get()), 2);
  g_object_set(thing_, "caps", nullptr, nullptr);
  EXPECT_EQ(GST_CAPS_REFCOUNT_VALUE(caps.get()), 1);
  EXPECT_EQ(Get<GstCaps*>("caps"), nullptr);
}

TEST_F(PropertyTable, ReadsFunctionsOfTheObjectAndTellsOfChanges) {
  EXPECT_TRUE(gst_structure_has_name(StructurePtr(Get<GstStructure*>("stats")).get(), "counts"));
  g_object_set(thing_, "port", 7U, nullptr);
  g_object_set(thing_, "level", 7, nullptr);
  EXPECT_EQ(Get<guint>("changes"), 2U);
}

TEST_F(PropertyTable, ShowsTheRowsOfAChildOnItsBin) {
  auto* bin = static_cast<GObject*>(g_object_new(test_bin_get_type(), nullptr));
  auto* port = g_object_class_find_property(G_OBJECT_GET_CLASS(bin), "port");
  EXPECT_EQ(G_PARAM_SPEC_UINT(port)->default_value, 99U);
  EXPECT_EQ(G_PARAM_SPEC_UINT(port)->maximum, 65535U);
  g_object_set(bin, "port", 7U, nullptr);  // there is no child yet
  reinterpret_cast<TestBin*>(bin)->state->thing = thing_;
  g_object_set(bin, "port", 8U, "own", "x", nullptr);
  EXPECT_EQ(Get<guint>("port"), 8U);
  guint seen = 0;
  guint changes = 0;
  g_object_get(bin, "port", &seen, "changes", &changes, nullptr);
  EXPECT_EQ(seen, 8U);
  EXPECT_EQ(changes, 1U);
  g_object_unref(bin);
}

TEST(PropertyTableDeathTest, EndsTheProgramWhereARowIsAskedForThatIsNotThere) {
  EXPECT_DEATH(FindRow(kNestedRows, "wiat"), "no property row is called \"wiat\"");
}

/// Returns the number that a value of kind T becomes in statistics, or, if `type` is guint, in a
/// property.
template <class T>
guint64 Shown(T value, GType type = Kind<T>::Type()) {
  GValue v = G_VALUE_INIT;
  g_value_init(&v, type);
  Kind<T>::Get(value, &v);
  return G_VALUE_HOLDS_UINT64(&v) ? g_value_get_uint64(&v) : g_value_get_uint(&v);
}

TEST(Kinds, ShowNumbersBeyondTheirRangeAsItsEnds) {
  EXPECT_EQ(Shown(Duration{-1}), 0U);
  EXPECT_EQ(Shown(DataSize::Bytes(-1)), 0U);
  EXPECT_EQ(Shown(DataSize::Bytes(-1), G_TYPE_UINT), 0U);
  EXPECT_EQ(Shown(DataSize::Bytes(5'000'000'000)), 5'000'000'000U);
  EXPECT_EQ(Shown(DataSize::Bytes(5'000'000'000), G_TYPE_UINT), G_MAXUINT);
  EXPECT_EQ(Shown(DataRate::BitsPerSecond(-1)), 0U);
  EXPECT_EQ(Shown(DataRate::BitsPerSecond(1e12)), G_MAXUINT);
  EXPECT_EQ(Kind<gint>::Clamp(-1e12), G_MININT);
  EXPECT_EQ(Kind<gint>::Clamp(1e12), G_MAXINT);
  EXPECT_EQ(Kind<gint64>::Clamp(1e30), G_MAXINT64);
}

TEST(Kinds, TakeTheLongestTimeOfAPropertyForALongOne) {
  GValue v = G_VALUE_INIT;
  g_value_init(&v, G_TYPE_UINT64);
  for (const guint64 ns : {guint64{G_MAXINT64}, guint64{G_MAXINT64} + 1, guint64{G_MAXUINT64}}) {
    g_value_set_uint64(&v, ns);
    Duration duration{};
    Kind<Duration>::Set(&duration, &v);
    EXPECT_EQ(duration, Duration::max()) << ns;
  }
}

TEST(StatTable, ShowsEachFieldUnderItsNameAndType) {
  const StructurePtr s = ToStructure("counts", kStats, Counts{});
  const StructurePtr wanted(gst_structure_new(
      "counts", "packets", G_TYPE_UINT64, guint64{3}, "bytes", G_TYPE_UINT64, guint64{3600},
      "delay", G_TYPE_UINT64, guint64{2'000'000}, "rate", G_TYPE_UINT, 1'000'000U, "sockets",
      G_TYPE_UINT, 2U, "on", G_TYPE_BOOLEAN, TRUE, "state", G_TYPE_STRING, "good", nullptr));
  EXPECT_TRUE(gst_structure_is_equal(s.get(), wanted.get()))
      << StringPtr(gst_structure_to_string(s.get())).get();
}

TEST(StatTable, SumsNumbersOnly) {
  Counts sum;
  sum.on = false;
  AddCounts(kStats, Counts{}, &sum);
  EXPECT_EQ(sum.packets, 6U);
  EXPECT_EQ(sum.bytes, DataSize::Bytes(7200));
  EXPECT_EQ(sum.sockets, 4U);
  EXPECT_FALSE(sum.on);
}

}  // namespace
}  // namespace lidar::gst

static void test_thing_init(TestThing* self) { self->state = new lidar::gst::State; }
static void test_thing_class_init(TestThingClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->finalize = [](GObject* o) {
    delete reinterpret_cast<TestThing*>(o)->state;
    G_OBJECT_CLASS(test_thing_parent_class)->finalize(o);
  };
  lidar::gst::ServeProperties<TestThing, lidar::gst::kProperties, lidar::gst::Changed>(object);
}

static void test_bin_init(TestBin* self) { self->state = new TestBin::State{}; }
static void test_bin_class_init(TestBinClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->finalize = [](GObject* o) {
    delete reinterpret_cast<TestBin*>(o)->state;
    G_OBJECT_CLASS(test_bin_parent_class)->finalize(o);
  };
  lidar::gst::ServeProperties<TestBin, lidar::gst::BinProperties>(object);
}
