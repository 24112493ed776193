// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "src/tools/bench/demo/measurements.h"
#include "src/tools/bench/demo/summary.h"
#include "src/tools/bench/demo/verdict.h"
#include "tests/support/files.h"

namespace lidar::demo {
namespace {

constexpr std::int64_t kSecond = 1000000000;
constexpr std::int64_t kMs = 1000000;
constexpr std::int64_t kOrigin = 1700000000 * kSecond;

/// Returns measurements of 10 s over a link of 8 Mbit/s for the first half, and of 4 Mbit/s for the
/// second half.
Measurements TwoSteps() {
  Measurements m;
  m.options.duration_s = 10;
  m.options.steps_mbps = {8, 4};
  m.origin_unix_ns = kOrigin;
  m.ran_s = 10;
  return m;
}

nlohmann::json Record(const char* type, std::uint32_t scan, std::uint32_t slice,
                      std::int64_t unix_ns) {
  return {{"type", type},   {"scan", scan},       {"slice", slice},
          {"count", 2},     {"unix_ns", unix_ns}, {"due_ns", unix_ns - kMs},
          {"took_ns", kMs}, {"bytes", 1000},      {"returns", 500}};
}

void Live(Ledger* ledger, std::uint32_t scan, std::uint32_t slice, std::int64_t at) {
  ledger->Add(Record("captured", scan, slice, at));
  ledger->Add(Record("encoded", scan, slice, at + 2 * kMs));
  ledger->Add(Record("decoded", scan, slice, at + 30 * kMs));
  ledger->Add(SliceKey{scan, slice}, Comparison{500, 0, 0, 0.04, 5});
}

TEST(DemoLedger, CountsScansByWhatBecameOfTheirSlices) {
  Ledger ledger;
  for (std::uint32_t slice = 0; slice < 2; ++slice) {
    Live(&ledger, 1, slice, kOrigin);
    ledger.Add(Record("captured", 2, slice, kOrigin + kSecond));  // The encoder skips this scan.
    ledger.Add(Record("captured", 3, slice, kOrigin + 2 * kSecond));
    ledger.Add(Record("encoded", 3, slice, kOrigin + 2 * kSecond));
  }
  ledger.Add(Record("decoded", 3, 1, kOrigin + 2 * kSecond));  // Slice 0 of this scan is lost.
  // The end of the run cuts this scan off.
  ledger.Add(Record("captured", 4, 0, kOrigin + 3 * kSecond));
  const ScanCounts n = ledger.Count();
  EXPECT_EQ(n.captured, 3U);
  EXPECT_EQ(n.skipped, 1U);
  EXPECT_EQ(n.sent, 2U);
  EXPECT_EQ(n.complete, 1U);
  EXPECT_EQ(n.slices_sent, 4U);
  EXPECT_EQ(n.slices_lost, 1U);
  EXPECT_EQ(ledger.Count(kOrigin + kSecond / 2).slices_lost, 0U) << "it may still be on its way";
}

TEST(DemoLedger, AScanIsInTimeWhereEachSliceIsThereWithinAFifthOfASecond) {
  Ledger ledger;
  for (std::uint32_t slice = 0; slice < 2; ++slice) {
    Live(&ledger, 1, slice, kOrigin);
    Live(&ledger, 2, slice, kOrigin + kSecond);
  }
  // The last column was measured 1 ms before the time of `captured`, so that scan 2 is late by 1
  // ms.
  ledger.Add(Record("decoded", 1, 1, kOrigin + 199 * kMs));
  ledger.Add(Record("decoded", 2, 1, kOrigin + kSecond + 200 * kMs));
  EXPECT_EQ(ledger.Count().complete, 2U);
  EXPECT_EQ(ledger.Count().in_time, 1U);
}

TEST(DemoLedger, TakesTheRecordsOfBothEndsInAnyOrder) {
  Ledger ledger;
  for (std::uint32_t slice = 0; slice < 2; ++slice) {
    ledger.Add(Record("decoded", 1, slice, kOrigin + 30 * kMs));
    ledger.Add(Record("encoded", 1, slice, kOrigin + 2 * kMs));
    ledger.Add(Record("captured", 1, slice, kOrigin));
  }
  EXPECT_EQ(ledger.Count().complete, 1U);
  EXPECT_EQ(ledger.Count().slices_lost, 0U);
}

TEST(DemoLedger, IgnoresRecordsThatMakeNoSense) {
  Ledger ledger;
  ledger.Add(nlohmann::json{{"type", "captured"}});
  ledger.Add(Record("captured", 1, 7, kOrigin));
  EXPECT_TRUE(ledger.scans().empty());
}

TEST(DemoLinkLog, IsReadWithWhatTheLinkDidToEachPacket) {
  const std::string file = testing::TempDir() + "demo_link_log.csv";
  std::ofstream(file) << "names of the columns\n"
                         "0.5,1,0,1200,7,8,1,1,3,delivered,4.25,9\n"
                         "0.6,1,0,900,7,8,1,3,3,delivered,0.5,9\n"
                         "0.7,1,0,800,7,8,1,1,1,queue-full,0,0\n"
                         "0.8,1,0,80\n";
  const auto packets = ReadLinkLog(file);
  std::remove(file.c_str());
  ASSERT_EQ(packets.size(), 3U);
  EXPECT_EQ(packets[0].time_s, 0.5);
  EXPECT_EQ(packets[0].size, 1'200);
  EXPECT_EQ(packets[0].sojourn_ms, 4.25);
  EXPECT_TRUE(packets[0].delivered && packets[0].marked);
  EXPECT_TRUE(packets[1].delivered && !packets[1].marked) << "it came marked";
  EXPECT_FALSE(packets[2].delivered || packets[2].marked);
}

TEST(DemoLinkLog, OfTwoLinksIsInTheOrderOfTime) {
  const test::TempFolder folder;
  RunOptions options;
  options.output = folder.path();
  options.links = 2;
  const auto write = [&](std::size_t link, const char* lines) {
    std::ofstream(LinkFile(options, "packets.csv", link)) << "names of the columns\n" << lines;
  };
  // In each log, time_s is 0 at the first packet of its own link.
  write(0, "0,5000,0,1,7,8,1,1,3,delivered,1,9\n2,2000005000,0,3,7,8,1,1,3,delivered,1,9\n");
  write(1, "0,1000005000,0,2,7,8,1,1,3,delivered,1,9\n2,3000005000,0,4,7,8,1,1,3,delivered,1,9\n");
  const auto packets = ReadLinkLogs(options);
  ASSERT_EQ(packets.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(packets[i].size, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(packets[i].link, i % 2);
    EXPECT_EQ(packets[i].time_s, static_cast<double>(i));
  }
}

TEST(DemoLinks, HaveASumWhicheverHasItsFirstLineFirst) {
  const auto line = [](double bps, double p95_ms) -> nlohmann::json {
    return {{"time_s", 1},          {"capacity_bps", 2 * bps},
            {"delivered_bps", bps}, {"sojourn_ms", {{"p95", p95_ms}}},
            {"marked", 3},          {"dropped", 1}};
  };
  for (std::size_t late = 0; late < 3; ++late) {
    std::vector<nlohmann::json> lines = {line(1e6, 10), line(1e6, 30), line(1e6, 20)};
    lines[late] = nullptr;
    const auto sum = SumOfLinks(lines);
    EXPECT_EQ(sum["time_s"], 1);
    EXPECT_EQ(sum["capacity_bps"], 4e6);
    EXPECT_EQ(sum["delivered_bps"], 2e6);
    EXPECT_EQ(sum["marked"], 6);
    EXPECT_EQ(sum["dropped"], 2);
    EXPECT_EQ(sum["sojourn_ms"]["p95"], late == 1 ? 20 : 30);
  }
}

TEST(DemoSamples, HaveTheUnitsOfTheirNames) {
  const nlohmann::json encoder = {{"step", 0.03}, {"target-bitrate", 9'000'000}};
  const nlohmann::json sender = {{"target-bitrate", 1'000'000}, {"estimated-capacity", 2'000'000},
                                 {"rtt", 40'000'000},           {"queue-delay", 3'000'000},
                                 {"ref-wnd", 12'000},           {"bytes-in-flight", 8'000},
                                 {"packets-dropped", 4},        {"sender-queue-delay", 7'000'000}};
  const SenderSample s = ReadSample({{"unix_ns", 5}, {"sender", sender}, {"encoder", encoder}});
  EXPECT_EQ(s.unix_ns, 5);
  EXPECT_EQ(s.target_bps, 1e6);
  EXPECT_EQ(s.estimated_capacity_bps, 2e6);
  EXPECT_EQ(s.rtt_ms, 40);
  EXPECT_EQ(s.queue_delay_ms, 3);
  EXPECT_EQ(s.ref_wnd_bytes, 12'000);
  EXPECT_EQ(s.bytes_in_flight, 8'000);
  EXPECT_EQ(s.sender_queue_ms, 7);
  EXPECT_EQ(s.step_m, 0.03);
  EXPECT_EQ(s.packets_dropped, 4U);
  // The links of a bonded sender share one target, which is the encoder's.
  const nlohmann::json bonded = {{"links", {{{"packets-dropped", 2}}, {{"packets-dropped", 3}}}}};
  const SenderSample b = ReadSample({{"sender", bonded}, {"encoder", encoder}});
  EXPECT_EQ(b.target_bps, 9e6);
  EXPECT_EQ(b.packets_dropped, 5U);
}

TEST(DemoSummary, SteadyLeavesOutTheStartAndTheSecondAfterAStep) {
  const auto m = TwoSteps();
  EXPECT_FALSE(m.IsSteady(2.9));
  EXPECT_TRUE(m.IsSteady(3));
  EXPECT_TRUE(m.IsSteady(4.9));
  EXPECT_FALSE(m.IsSteady(5));
  EXPECT_FALSE(m.IsSteady(5.9));
  EXPECT_TRUE(m.IsSteady(6));
}

TEST(DemoSummary, CaptureToCloudRunsFromTheLastColumnToTheDecodedSlice) {
  auto m = TwoSteps();
  Live(&m.ledger, 1, 0, kOrigin + 4 * kSecond);
  Live(&m.ledger, 1, 1, kOrigin + 4 * kSecond + 50 * kMs);
  const auto s = Summarise(m);
  EXPECT_NEAR(s["capture_to_cloud_steady_ms"]["p50"].get<double>(), 31, 1e-4);
  EXPECT_NEAR(s["stages_ms"]["network"]["p50"].get<double>(), 27, 1e-4);
  EXPECT_EQ(s["bits_per_return"], 16);
  EXPECT_EQ(s["encode_ms_p50"], 2);
  EXPECT_EQ(s["scans_complete"], 1);
}

TEST(DemoSummary, UtilisationIsOfSteadyTimeAndOfWhatTheEncoderCanUse) {
  auto m = TwoSteps();
  // The rate is always 3 Mbit/s. The highest rate that the encoder can use is 6 Mbit/s on average.
  for (int i = 0; i < 1000; ++i) m.packets.push_back({i * 0.01, 3750, true, false, 1});
  m.AddBounds(kOrigin, 1e6, 5e6);
  // The link is in a gap, so this maximum is a guess.
  m.AddBounds(kOrigin + 9 * kSecond, 1e6, 15e6);
  // These bounds begin at the end, so they never hold.
  m.AddBounds(kOrigin + 10 * kSecond, 1e6, 20e6);
  m.EndBounds(kOrigin + 10 * kSecond);  // The average of the maximum is 6 Mbit/s.
  const auto s = Summarise(m);
  EXPECT_NEAR(s["mean_rate_bps"].get<double>(), 3e6, 1);
  // The steady time is 2 s at 8 Mbit/s and 4 s at 4 Mbit/s.
  EXPECT_NEAR(s["utilisation"].get<double>(), 18.0 / 32, 0.005);
  EXPECT_NEAR(s["utilisation_of_usable"].get<double>(), 18.0 / 28, 0.005);
}

TEST(DemoSummary, ATransientLastsUntilTheQueueStaysShort) {
  auto m = TwoSteps();
  m.packets = {{1, 1000, true, false, 50},
               {5.1, 1000, true, false, 40},
               {5.2, 1000, true, false, 60},
               {5.4, 1000, true, false, 3}};
  const auto transients = FindTransients(m);
  ASSERT_EQ(transients.size(), 1U);
  EXPECT_EQ(transients[0].to_bps, 4e6);
  EXPECT_EQ(transients[0].peak_ms, 60);
  EXPECT_NEAR(transients[0].settled_after_s, 0.26, 1e-9);
}

TEST(DemoSummary, ATransientKnowsItsStepWhereThePartsAreNoRoundNumber) {
  auto m = TwoSteps();
  m.options.duration_s = 20;
  m.options.steps_mbps = {8, 4, 6};
  m.ran_s = 20;
  const auto transients = FindTransients(m);
  ASSERT_EQ(transients.size(), 2U);
  EXPECT_EQ(transients[1].from_bps, 4e6);
  EXPECT_EQ(transients[1].to_bps, 6e6);
}

TEST(DemoSummary, AStepThatTheRunDidNotReachIsNoTransient) {
  auto m = TwoSteps();
  m.ran_s = 4;
  EXPECT_TRUE(FindTransients(m).empty());
}

bool AllHold(const Measurements& m) {
  for (const Guarantee& g : CheckGuarantees(m))
    if (!g.holds) return false;
  return true;
}

TEST(DemoSummary, TheGuaranteesHoldForARunInWhichAllArrivedWithinTheBound) {
  auto m = TwoSteps();
  for (std::uint32_t slice = 0; slice < 2; ++slice) Live(&m.ledger, 1, slice, kOrigin);
  EXPECT_TRUE(AllHold(m));
  EXPECT_FALSE(AllHold(TwoSteps())) << "nothing arrived";
}

TEST(DemoSummary, AnErrorAboveTheBoundBreaksAGuarantee) {
  auto m = TwoSteps();
  Live(&m.ledger, 1, 0, kOrigin);
  m.options.max_error_m = 0.039;
  EXPECT_FALSE(AllHold(m));
}

TEST(DemoSummary, ASliceThatIsLostWithoutADropBreaksAGuarantee) {
  auto m = TwoSteps();
  Live(&m.ledger, 1, 0, kOrigin);
  m.ledger.Add(Record("captured", 1, 1, kOrigin));
  m.ledger.Add(Record("encoded", 1, 1, kOrigin));
  EXPECT_FALSE(AllHold(m));
  m.packets.push_back({0, 1000, false, false, 0});
  EXPECT_TRUE(AllHold(m)) << "the link dropped it";
}

TEST(DemoSummary, APointThatAppearedFromNowhereBreaksAGuarantee) {
  auto m = TwoSteps();
  Live(&m.ledger, 1, 0, kOrigin);
  m.ledger.Add(SliceKey{1, 0}, Comparison{500, 0, 1, 0, 0});
  EXPECT_FALSE(AllHold(m));
}

/// Returns a stream of 10 s with four scans per second, of which `arrives` % arrive. Each scan has
/// two slices of 1 kB.
Measurements Stream(int arrives) {
  auto m = TwoSteps();
  m.AddBounds(kOrigin, 64e3, 8e6);
  for (int i = 0; i < 40; ++i) {
    for (std::uint32_t slice = 0; slice < 2; ++slice) {
      const auto scan = static_cast<std::uint32_t>(i);
      const std::int64_t at = kOrigin + i * kSecond / 4 + slice * 50 * kMs;
      if (i * 100 < arrives * 40)
        Live(&m.ledger, scan, slice, at);
      else
        m.ledger.Add(Record("captured", scan, slice, at));
    }
  }
  return m;
}

TEST(DemoVerdict, IsAboutTheScansThatTheLinkCouldHaveCarried) {
  EXPECT_EQ(Judge(Stream(100)).level, Verdict::Level::kUseful);
  EXPECT_EQ(Judge(Stream(70)).level, Verdict::Level::kReduced);
  const Verdict poor = Judge(Stream(20));
  EXPECT_EQ(poor.level, Verdict::Level::kPoor);
  EXPECT_NE(poor.text.find("8 of 40 scans"), std::string::npos) << poor.text;
  ASSERT_FALSE(poor.hints.empty());
  EXPECT_NE(poor.hints[0].find("left out"), std::string::npos) << poor.hints[0];
}

TEST(DemoVerdict, AsksNoMoreThanTheSourceGave) {
  auto m = Stream(100);
  m.ran_s = 11;  // The oracle has time for more scans.
  const std::string text = Judge(m).text;
  EXPECT_NE(text.find("40 of 40 scans arrived whole; a sender that knew the link: 40"),
            std::string::npos)
      << text;
}

TEST(DemoVerdict, AsksNoMoreThanALinkInAnOutageCanCarry) {
  auto m = Stream(20);
  m.options.steps_mbps = {8, 0, 0, 0, 0};
  EXPECT_EQ(Judge(m).level, Verdict::Level::kUseful);
}

TEST(DemoVerdict, SaysThatALinkIsLargerThanTheSource) {
  auto m = Stream(100);
  m.encoder_max_bps = 1e6;
  ASSERT_FALSE(Judge(m).hints.empty());
  EXPECT_NE(Judge(m).hints[0].find("more than the source can use"), std::string::npos);
}

TEST(DemoVerdict, OfARunWithoutAScanIsPoor) {
  EXPECT_EQ(Judge(TwoSteps()).level, Verdict::Level::kPoor);
}

TEST(DemoSummary, CountsGapsAndHowSoonTheSenderIsBack) {
  auto m = TwoSteps();
  m.options.steps_mbps = {8, 0.1, 8, 8};
  for (int i = 0; i < 5300; ++i)
    if (i < 2500) m.packets.push_back({i * 0.001, 1000, true, false, 1});
  for (int i = 5300; i < 10000; ++i) m.packets.push_back({i * 0.001, 1000, true, false, 1});
  const auto s = Summarise(m);
  EXPECT_EQ(s["gaps"]["count"], 1);
  EXPECT_NEAR(s["gaps"]["back_after_s"]["max"].get<double>(), 0.28, 0.03);
}

TEST(DemoOptions, ADriveHasItsMeanAndGaps) {
  RunOptions o;
  o.drive = true;
  o.duration_s = 200;
  EXPECT_NEAR(CapacitiesOf(o).front().Between({}, std::chrono::seconds(200)).bits() / 200e6, 4, 1);
  o.rate_mbps = 10;
  EXPECT_NEAR(CapacitiesOf(o).front().Between({}, std::chrono::seconds(200)).bits() / 200e6, 10, 2);
  EXPECT_TRUE(ChangesOf(o).empty());
}

TEST(DemoOptions, EachLinkHasADriveOfItsOwn) {
  RunOptions o;
  o.drive = true;
  o.links = 2;
  const auto links = CapacitiesOf(o);
  ASSERT_EQ(links.size(), 2U);
  EXPECT_NE(DriveTraceOf(o, 0), DriveTraceOf(o, 1));
  EXPECT_EQ(LinkFile(o, "packets.csv", 0), "demo-output/packets.csv");
  EXPECT_EQ(LinkFile(o, "packets.csv", 1), "demo-output/packets2.csv");
  const std::string sender = SenderPipeline(o, {{5004, 5005}, 5006});
  EXPECT_NE(sender.find("bonding-addresses=127.0.0.1:5004@127.0.0.1,127.0.0.1:5005@127.0.0.2"),
            std::string::npos);
}

TEST(DemoSummary, TellsWhatEachLinkCarriedAndLeavesOutFiguresOfOne) {
  auto m = TwoSteps();
  m.options.links = 2;
  m.ran_s = 10;
  for (int i = 0; i < 100; ++i)
    m.packets.push_back({i * 0.1, 1000, true, false, 1, static_cast<std::size_t>(i % 4 == 0)});
  m.sender_stats = {{"sender",
                     {{"links",
                       {{{"packets-sent", 75}, {"packets-first", 75}},
                        {{"packets-sent", 25}, {"packets-first", 0}, {"packets-saved", 3}}}}}}};
  const auto s = Summarise(m);
  ASSERT_EQ(s["links"].size(), 2U);
  EXPECT_NEAR(s["links"][0]["mean_rate_bps"].get<double>(), 60e3, 1);
  EXPECT_NEAR(s["links"][1]["mean_rate_bps"].get<double>(), 20e3, 1);
  EXPECT_EQ(s["links"][1]["packets_saved"], 3);
  EXPECT_TRUE(s["utilisation"].is_null());
  EXPECT_EQ(s["gaps"]["count"], 0);
}

TEST(DemoOptions, FixedBitsDivideACubeOf200Metres) {
  RunOptions o;
  EXPECT_EQ(FixedStepOf(o), 0);
  EXPECT_EQ(ErrorBoundOf(o), 0.05);
  o.fixed_bits = 10;
  EXPECT_NEAR(FixedStepOf(o), 0.1955, 1e-4);
  EXPECT_NEAR(ErrorBoundOf(o), 0.0978, 1e-4);
  o.geometry = "xyz";
  EXPECT_NEAR(ErrorBoundOf(o), 0.1693, 1e-4);
}

}  // namespace
}  // namespace lidar::demo
