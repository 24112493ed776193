// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares a receiver's slices and counts with golden files. Packets are lost, late, repeated and
// damaged.
#include "src/rtp/delivery.h"
#include "src/rtp/unit_check.h"
#include "tests/core/rtp/stream.h"
#include "tests/support/golden_lines.h"

namespace lidar::rtp {
namespace {
using lidar::test::Line;
using lidar::test::Lines;
using test::Sender;
using test::Wire;

class Play {
 public:
  explicit Play(Lines* lines) : lines_(*lines) {}
  void Give(const Wire& w) {
    for (const ReceivedSlice& s : test::Deliver(&receiver_, w)) {
      const bool equal = s.bytes == test::SliceBytes(s.info.scan_id, s.id.index, s.bytes.size());
      given_ += Line(" ", s.info.scan_id, ".", s.id.index, "/", s.id.count, "#", s.id.scan_number,
                     s.discont ? "!" : "", equal ? "" : "?", s.config ? "" : " no config");
    }
  }
  void Give(const std::vector<Wire>& packets) {
    for (const Wire& w : packets) Give(w);
  }
  void Note(const std::string& what) {
    const ReceiverAccounts a = receiver_.accounts();
    const SliceAccounts& s = a.slices;
    const PacketAccounts& p = a.packets;
    lines_.push_back("- " + what + ":" + std::exchange(given_, ""));
    lines_.push_back(Line("slices received ", s.slices_received, " lost ", s.slices_lost,
                          " damaged ", s.slices_damaged, " mismatch ", s.slices_config_mismatch,
                          " skipped ", s.slices_skipped, "; scans complete ", s.scans_complete,
                          " incomplete ", s.scans_incomplete, " lost ", s.scans_lost, " skipped ",
                          s.scans_skipped, "; packets ", a.packets_received, " invalid ", p.invalid,
                          " duplicate ", p.duplicate, " late ", p.late, " config damaged ",
                          p.config_damaged, "; configs ", a.configs_received, " restarts ",
                          a.restarts, " outages ", a.outages, " rival ",
                          receiver_.rival().value_or(0), " ssrc ", receiver_.ssrc().value_or(0)));
  }
  Receiver& receiver() { return receiver_; }

 private:
  Lines& lines_;
  Receiver receiver_{test::kReorder};
  std::string given_;
};

std::vector<Wire> Part(const std::vector<Wire>& all, std::uint32_t first, std::uint32_t end) {
  std::vector<Wire> part;
  for (const Wire& w : all)
    if (!w.config && w.scan >= first && w.scan < end) part.push_back(w);
  return part;
}

TEST(RtpGolden, Receiver) {
  Lines lines;
  Play play(&lines);
  Sender sender;
  const std::vector<Wire> all = sender.Scans(0, 60);
  auto packets = Part(all, 0, 2);
  play.Give({packets.begin(), packets.begin() + 2});
  play.Note("without a config");
  play.Give(all.front());
  play.Give({packets.begin() + 2, packets.end()});
  play.Note("two scans");
  packets = Part(all, 2, 5);
  test::Lose(&packets, [](const Wire& w) { return w.scan == 3 && w.index == 1; });
  play.Give(packets);
  play.Give(Part(all, 5, 7));
  play.Note("a slice is lost");
  packets = Part(all, 7, 9);
  std::swap(packets[2], packets[7]);
  std::reverse(packets.begin() + 12, packets.end());
  packets.push_back(packets[3]);
  play.Give(packets);
  play.Note("other order, a copy");
  packets = Part(all, 9, 13);
  packets[4].payload.back() ^= 1;
  packets[13].payload.resize(3);
  packets[20].payload.clear();
  play.Give(packets);
  play.Note("damage");
  play.Give(Part(all, 3, 4));
  play.Note("late");
  play.Give(Part(all, 15, 16));
  play.Give(Part(all, 18, 19));
  play.Note("scans are lost");
  play.Give(Part(all, 30, 33));
  play.Note("an outage");
  test::SenderOptions other;
  other.ssrc = 99;
  other.slices = 2;
  other.slice_size = 300;
  Sender rival(other);
  const std::vector<Wire> theirs = rival.Scans(33, 60);
  for (std::size_t i = 0; i < 110; ++i) {
    Wire w = theirs[i];
    w.sent = Part(all, 32, 33).back().sent;
    play.Give(w);
    if (i % 20 == 0)
      play.Give(Part(all, 33 + static_cast<std::uint32_t>(i / 20),
                     34 + static_cast<std::uint32_t>(i / 20)));
  }
  play.Note("a rival");
  play.Give(Part(theirs, 60, 64));
  play.Note("another sender");
  other.config_id = 10;
  Sender next(other);
  play.Give(Part(next.Scans(95, 2), 95, 97));
  play.Note("another config, which is missing");
  play.Give(next.Scans(97, 1));
  play.Note("and comes");
  ScanCounter counter(other.scan_number + 98);
  std::vector<Wire> some;
  for (const auto& [scan, index] :
       {std::pair{98U, 0}, std::pair{99U, 1}, std::pair{102U, 0}, std::pair{102U, 1}})
    next.Slice(scan, static_cast<std::uint16_t>(index), &some, &counter);
  play.Give(some);
  play.Note("slices are skipped");
  play.receiver().Finish();
  play.Note("the end");
  play.Give(Part(all, 50, 52));
  play.Note("after the end");
  lidar::test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/receiver.txt");
}

TEST(RtpGolden, Payloads) {
  Lines lines;
  const auto bytes = test::SliceBytes(1, 2, 150);
  Unit unit;
  unit.config_id = 0x5A;
  unit.slice = {0x01020304, 0x0506, 0x0708};
  unit.info = {0x090A0B0C, 0x0D0E, 0x0F101112, 0x131415161718191A, 0x1B1C1D1E1F202122};
  const auto note = [&](const std::string& what, const std::vector<std::uint8_t>& payload) {
    lines.push_back(Line("- ", what, ", ", payload.size()));
    for (const Unit& u : ParsePayload({payload.data(), payload.size()}))
      lines.push_back(Line("type ", static_cast<int>(u.type), " unit ", static_cast<int>(u.unit),
                           " config ", static_cast<int>(u.config_id), " scan ", u.slice.scan_number,
                           " ", u.slice.index, "/", u.slice.count, " id ", u.info.scan_id,
                           " column ", u.info.first_column, " duration ", u.info.duration_ns,
                           " capture ", u.info.capture_ntp, " skipped ", u.info.skipped, " length ",
                           u.length, " crc ", u.crc, " ticks ", u.timestamp_ticks, " body ",
                           u.body.size));
  };
  const auto whole = [&](const Packet& p, const std::vector<std::uint8_t>& of) {
    auto payload = p.header;
    const auto at = of.begin() + static_cast<std::ptrdiff_t>(p.body_offset);
    payload.insert(payload.end(), at, at + static_cast<std::ptrdiff_t>(p.body_size));
    return payload;
  };
  for (const auto type : {UnitType::kStreamConfig, UnitType::kSlice, UnitType::kSliceAfterSkip})
    for (const std::size_t most : {std::size_t{64}, std::size_t{100}, std::size_t{1000}}) {
      unit.unit = type;
      for (const Packet& p : Packetize(unit, {bytes.data(), bytes.size()}, most))
        note(p.marker ? "packet, marked" : "packet", whole(p, bytes));
    }
  Aggregator aggregator;
  unit.unit = UnitType::kSlice;
  const ByteView small{bytes.data(), 40};
  for (const std::uint64_t ticks : std::initializer_list<std::uint64_t>{100, 350, 65'635, 65'636}) {
    const bool added = aggregator.Add(unit, small, 400, ticks);
    lines.push_back(Line(ticks, added ? " added" : " refused"));
  }
  lines.push_back(aggregator.Add(unit, {bytes.data(), 150}, 400, 400) ? "added" : "no room");
  const auto together = aggregator.Take();
  ASSERT_TRUE(together);
  note(together->marker ? "together, marked" : "together", together->header);
  lines.push_back(aggregator.empty() && !aggregator.Take() ? "empty" : "not empty");
  for (std::size_t i = 0; i < together->header.size(); i += 3) {
    auto cut = together->header;
    cut.resize(i);
    auto damaged = together->header;
    damaged[i] = static_cast<std::uint8_t>(damaged[i] + 0x31);
    lines.push_back(Line(i, ": ", ParsePayload({cut.data(), cut.size()}).size(), " of the cut, ",
                         ParsePayload({damaged.data(), damaged.size()}).size(), " of the damaged"));
  }
  lidar::test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/payloads.txt");
}

TEST(RtpGolden, Deliveries) {
  Lines lines;
  Delivery delivery;
  for (std::uint16_t i = 0; i < 12; ++i)
    delivery.OnSent({5, static_cast<std::uint16_t>(65530 + i), {i / 3U, i % 2U}, i % 3 == 2});
  const auto receive = [&](std::uint32_t ssrc, std::uint16_t first, std::uint16_t last) {
    std::string text = Line(first, " to ", last, ":");
    for (const auto& s : delivery.OnReceived(ssrc, first, last))
      text += Line(" ", s.scan_id, ".", s.index);
    lines.push_back(text);
  };
  receive(4, 65530, 65532);
  receive(5, 65530, 65531);
  receive(5, 65530, 65532);
  receive(5, 65535, 0);
  receive(5, 65533, 65534);
  receive(5, 1, 9);
  delivery.OnSent({5, 7, {9, 1}, true});
  receive(5, 6, 7);
  delivery.OnSent({5, 8, {9, 2}, false});
  delivery.OnSent({6, 9, {9, 3}, true});
  receive(5, 8, 8);
  receive(6, 8, 9);
  UnitCheck check;
  const auto packets = Sender().Scans(0, 3);
  std::string checked;
  for (std::size_t i = 0; i < packets.size(); ++i)
    if (i != 7)
      checked +=
          check.Push(packets[i].sequence, {packets[i].payload.data(), packets[i].payload.size()})
              ? '+'
              : '.';
  lines.push_back(checked);
  lidar::test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/deliveries.txt");
}

}  // namespace
}  // namespace lidar::rtp
