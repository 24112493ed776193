// SPDX-License-Identifier: LGPL-2.1-or-later
// What the programs of a fleet tell of themselves.
#include <nlohmann/json.hpp>

#include "ext/nats/jetstream.h"
#include "src/tools/common/printable.h"
#include "src/tools/fleet/exposition.h"
#include "src/tools/fleet/reporter.h"
#include "tests/elements/nats/nats_server.h"

namespace lidar::test {
namespace {

TEST(FleetExposition, HasNumbersByTheirNames) {
  const gst::StructurePtr stats(
      gst_structure_new("s", "packets-lost", G_TYPE_UINT64, guint64{7}, "connected", G_TYPE_BOOLEAN,
                        TRUE, "age", G_TYPE_UINT64, G_MAXUINT64, "reason", G_TYPE_STRING, "x",
                        "rate", G_TYPE_DOUBLE, 0.5, nullptr));
  fleet::Exposition exposition;
  exposition.Add("natssink", "{robot=\"a\"}", stats.get());
  exposition.Add("lidar_edge_x", "", 1);
  EXPECT_EQ(
      exposition.text(),
      "# TYPE lidar_edge_x untyped\nlidar_edge_x 1\n"
      "# TYPE lidar_natssink_connected untyped\nlidar_natssink_connected{robot=\"a\"} 1\n"
      "# TYPE lidar_natssink_packets_lost untyped\nlidar_natssink_packets_lost{robot=\"a\"} 7\n"
      "# TYPE lidar_natssink_rate untyped\nlidar_natssink_rate{robot=\"a\"} 0.5\n");
  EXPECT_EQ(fleet::ToJson(stats.get()).dump(),
            R"({"connected":true,"packets-lost":7,"rate":0.5,"reason":"x"})");
}

TEST(Printable, IsALineThatGivesATerminalNoOrders) {
  EXPECT_EQ(tools::Printable("r7: Gerät 1"), "r7: Gerät 1");
  EXPECT_EQ(tools::Printable("a\x1b[2J\nb\x7f"), "a\\x1b[2J\\x0ab\\x7f");
  EXPECT_EQ(tools::Printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(tools::Printable("\xff\xc3"), "\\xff\\xc3") << "no UTF-8";
  EXPECT_EQ(tools::Printable("\u009b"), "\\xc2\\x9b") << "begins an order in some terminals";
  EXPECT_EQ(tools::Printable(""), "");
}

using FleetReporter = NatsTest;

TEST_F(FleetReporter, SendsTheNewestAsSoonAsThereIsAServer) {
  server_.Start();
  nats::ConnectionSettings settings;
  settings.url = server_.url();
  std::string why;
  const auto connection = nats::Connection::Open(settings, nullptr, &why);
  ASSERT_TRUE(connection) << why;
  const auto js = nats::OpenJetStream(connection->get());
  nats::StreamSettings stream;
  stream.name = "told";
  ASSERT_TRUE(nats::EnsureStream(js.get(), stream, {"told.>"}, &why)) << why;
  server_.Kill();
  fleet::Reporter reporter(settings);
  reporter.Publish({{"told.r1", "old"}, {"told.r2", "old"}});
  reporter.Publish({{"told.r1", "new"}});
  server_.Restart();
  natsMsg* raw = nullptr;
  ASSERT_TRUE(Eventually([&] {
    return js_GetLastMsg(&raw, js.get(), "told", "told.r1", nullptr, nullptr) == NATS_OK;
  }));
  const nats::MessagePtr last(raw);
  EXPECT_EQ(std::string(natsMsg_GetData(raw), static_cast<std::size_t>(natsMsg_GetDataLength(raw))),
            "new");
  EXPECT_EQ(natsMsg_GetSequence(raw), 1U) << "it alone";
}

}  // namespace
}  // namespace lidar::test
