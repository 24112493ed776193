// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares each report of a fixed sequence of arrivals, with its size and the counters, with golden
// files.
#include <cmath>

#include "src/rtcp/ccfb.h"
#include "src/rtcp/feedback_generator.h"
#include "src/rtcp/sender_report.h"
#include "src/rtcp/twcc_mapper.h"
#include "tests/support/golden_lines.h"

namespace lidar::rtcp {
namespace {
using test::Line;
using test::Lines;

std::string Hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (const std::uint8_t b : bytes) {
    text += "0123456789abcdef"[b >> 4];
    text += "0123456789abcdef"[b & 15];
  }
  return text;
}

std::string Described(const CongestionFeedback& report) {
  std::string text = Line("from ", report.sender_ssrc, " at ", report.report_timestamp);
  for (const SsrcReport& block : report.blocks) {
    text += Line("; ", block.ssrc, " from ", block.begin_seq, ":");
    for (const PacketMetric& m : block.metrics)
      text += m.received
                  ? Line(" ", static_cast<int>(m.ecn), "@",
                         m.arrival_offset ? std::llround(Milliseconds(*m.arrival_offset)) : -1)
                  : std::string(" -");
  }
  return text;
}

const Time kBegin{1000s};

/// A receiver that takes the due reports every millisecond.
class Session {
 public:
  explicit Session(Lines* lines, const FeedbackConfig& config = {})
      : lines_(*lines), config_(config), generator_(config) {}
  void Arrive(std::uint32_t ssrc, std::uint16_t seq, Ecn ecn = Ecn::kEct1, bool marker = false,
              std::int64_t size = 1000) {
    generator_.OnPacket(now_, {ssrc, seq, ecn, marker, DataSize::Bytes(size)});
  }
  void Pass(Duration time) {
    for (const Time end = now_ + time; now_ < end; now_ += 1ms)
      for (int i = 0; i < 4; ++i)
        if (const auto report = generator_.Take(now_)) {
          const auto bytes = BuildCcfb(*report, config_.num_reports);
          lines_.push_back(
              Line(Milliseconds(now_ - kBegin), " ms: ", Described(*report), " = ", bytes.size()));
        }
  }
  void Note(const std::string& what) {
    const auto& s = generator_.stats();
    const Time due = generator_.NextDue();
    lines_.push_back(Line("- ", what, ": packets ", s.packets, " ce ", s.ce_packets, " duplicates ",
                          s.duplicates, " reordered ", s.reordered, " stale ", s.stale, " lost ",
                          s.lost, " reports ", s.reports, " received ", s.received.bytes(),
                          " sent ", s.sent.bytes(), " due ",
                          due == Time::max() ? -1 : Milliseconds(due - now_)));
  }
  FeedbackGenerator& generator() { return generator_; }

 private:
  Lines& lines_;
  FeedbackConfig config_;
  FeedbackGenerator generator_;
  Time now_ = kBegin;
};

TEST(RtcpGolden, Reports) {
  Lines lines;
  Session s(&lines);
  s.Arrive(1, 65530);
  s.Pass(5ms);
  s.Note("first");
  for (std::uint16_t i = 0; i < 20; ++i) {
    s.Arrive(1, static_cast<std::uint16_t>(65531 + i));
    s.Pass(2ms);
  }
  s.Pass(60ms);
  s.Note("twenty");
  s.Arrive(1, 20, Ecn::kCe);
  s.Pass(3ms);
  s.Arrive(1, 19);
  s.Pass(10ms);
  s.Note("a gap, CE, and a late one");
  s.Arrive(1, 20, Ecn::kCe);
  s.Arrive(1, 21, Ecn::kEct0, true);
  s.Pass(1ms);
  s.Note("a copy, and a marker");
  s.Arrive(1, 9000);
  s.Pass(1ms);
  s.Note("far");
  s.Arrive(1, 9001);
  s.Pass(50ms);
  s.Note("a restart");
  s.Arrive(2, 5, Ecn::kNotEct);
  s.Arrive(1, 9003);
  s.Arrive(3, 7, Ecn::kEct1, true);
  s.Pass(50ms);
  s.Note("three streams");
  s.Pass(29s);
  s.Arrive(2, 6);
  s.Pass(2s);
  s.Arrive(4, 1);
  s.Pass(100ms);
  s.Note("two are forgotten");
  for (std::uint16_t i = 0; i < 700; ++i) s.Arrive(4, static_cast<std::uint16_t>(2 + i));
  s.Pass(40ms);
  s.Note("many");
  s.Arrive(4, 60);
  s.Arrive(4, 705, Ecn::kEct1, true, 1);
  s.Pass(40ms);
  s.Note("stale");
  s.generator().Reset();
  s.Note("reset");
  for (std::uint16_t i = 0; i < 8; ++i) s.Arrive(1, i, Ecn::kEct1, true, 40);
  s.Pass(50ms);
  s.Note("small packets pay for few reports");
  FeedbackConfig config;
  config.sender_ssrc = 77;
  config.packets_per_feedback = 4;
  config.overlap = 2;
  config.report_on_marker = config.report_on_ce_change = false;
  config.num_reports = NumReports::kCountMinusOne;
  config.max_report = DataSize::Bytes(40);
  Session other(&lines, config);
  for (std::uint16_t i = 0; i < 40; ++i) {
    other.Arrive(1, i, i % 3 == 0 ? Ecn::kCe : Ecn::kEct1, true);
    other.Pass(Duration{i < 20 ? 7ms : 0ms});
  }
  other.Pass(40ms);
  other.Note("other settings");
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/reports.txt");
}

TEST(RtcpGolden, Packets) {
  Lines lines;
  const auto bytes_of = [](const std::vector<std::uint8_t>& b) {
    return ByteView{b.data(), b.size()};
  };
  CongestionFeedback feedback{0xA1B2C3D4, {}, 0x01020304};
  feedback.blocks.push_back({7, 65535, {{true, Ecn::kCe, 10ms}, {}, {true, Ecn::kEct0, 8s}}});
  feedback.blocks.push_back({8, 1, {}});
  feedback.blocks.push_back({9, 2, {{true, Ecn::kEct1, std::nullopt}, {true, Ecn::kNotEct, 0ms}}});
  for (const auto reading : {NumReports::kCount, NumReports::kCountMinusOne}) {
    const auto bytes = BuildCcfb(feedback, reading);
    lines.push_back(Hex(bytes));
    CcfbParser parser;
    const auto back = parser.Parse(bytes_of(bytes));
    lines.push_back(back ? Described(*back) : "refused");
    lines.push_back(parser.num_reports() == NumReports::kCount ? "count" : "count minus one");
    for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
      auto damaged = bytes;
      damaged[cut] = static_cast<std::uint8_t>(damaged[cut] ^ 0x24);
      CcfbParser other;
      const auto read = other.Parse(bytes_of(damaged));
      lines.push_back(Line("byte ", cut, ": ", read ? Described(*read) : "refused",
                           IsCcfb(bytes_of(damaged)) ? "" : ", no feedback", ", packets ",
                           SplitRtcp(bytes_of(damaged)).size()));
    }
  }
  SenderReport report;
  report.ssrc = 1;
  report.time_ms = 2;
  report.target_bitrate = DataRate::BitsPerSecond(3);
  report.estimated_capacity = DataRate::BitsPerSecond(4);
  report.sent_bitrate = DataRate::BitsPerSecond(5);
  report.ref_wnd = DataSize::Bytes(6);
  report.bytes_in_flight = DataSize::Bytes(7);
  report.queue_delay = 8us;
  report.rtt = 9us;
  report.sender_queue_delay = 10us;
  report.packets_sent = 11;
  report.packets_lost = 12;
  report.packets_ce = 13;
  report.packets_dropped = 14;
  const auto bytes = BuildSenderReport(report);
  lines.push_back(Hex(bytes));
  const auto back = ParseSenderReport(bytes_of(bytes));
  ASSERT_TRUE(back);
  lines.push_back(Hex(BuildSenderReport(*back)));
  report.target_bitrate = DataRate::BitsPerSecond(1e10);
  report.queue_delay = -1s;
  report.rtt = 5000s;
  lines.push_back(Hex(BuildSenderReport(report)));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto damaged = bytes;
    damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ 0x24);
    const auto read = ParseSenderReport(bytes_of(damaged));
    if (!read || !HasSenderReport(bytes_of(damaged)))
      lines.push_back(Line("byte ", i, ": ", read ? "read" : "refused",
                           HasSenderReport(bytes_of(damaged)) ? "" : ", no report"));
  }
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/packets.txt");
}

TEST(RtcpGolden, Twcc) {
  Lines lines;
  TwccMapper mapper;
  const auto map = [&](std::uint16_t base, std::vector<std::optional<Duration>> arrivals) {
    const auto mapped = mapper.Map({base, std::move(arrivals)});
    lines.push_back(mapped ? Described(*mapped) : "nothing");
  };
  map(0, {1s});
  for (std::uint16_t i = 0; i < 6; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(65533 + i), i % 2 + 1U,
                  static_cast<std::uint16_t>(100 + i));
  map(65533, {1s, std::nullopt, 1s + 5ms, 1s + 2ms});
  map(65532, {2s, 2s, std::nullopt});
  map(2, {kTwccPeriod - 10ms});
  map(2, {5ms, 7ms});
  map(9, {1s});
  mapper.OnSent(10, 1, 200);
  map(3, {20ms, std::nullopt, std::nullopt, std::nullopt, std::nullopt, std::nullopt, std::nullopt,
          30ms});
  for (int i = 11; i < 20'000; ++i)
    mapper.OnSent(static_cast<std::uint16_t>(i), 1, static_cast<std::uint16_t>(190 + i));
  map(10, {40ms});
  map(3615, {40ms, 41ms, 42ms});
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/twcc.txt");
}

}  // namespace
}  // namespace lidar::rtcp
