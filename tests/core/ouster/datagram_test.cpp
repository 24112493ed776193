// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "src/base/byte_writer.h"
#include "src/ouster/pcap_reader.h"
#include "src/ouster/udp_datagram.h"
#include "tests/support/files.h"

namespace lidar::ouster {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Payload(std::size_t n) {
  Bytes payload(n);
  for (std::size_t i = 0; i < n; ++i) payload[i] = static_cast<std::uint8_t>(i * 7);
  return payload;
}

Bytes Udp(const Bytes& payload) {
  Bytes out;
  ByteWriter w(&out);
  w.Be16(1234);
  w.Be16(7502);
  w.Be16(static_cast<std::uint16_t>(payload.size() + 8));
  w.Be16(0);
  w.Bytes({payload.data(), payload.size()});
  return out;
}

struct Part {
  std::size_t offset = 0;
  bool more = false;
  std::uint16_t id = 1;
  std::uint8_t host = 2;  // the last byte of the source address
};

Bytes Ipv4(const Bytes& body, Part part = {}) {
  Bytes out;
  ByteWriter w(&out);
  w.U8(0x45);
  w.U8(0);
  w.Be16(static_cast<std::uint16_t>(body.size() + 20));
  w.Be16(part.id);
  w.Be16(static_cast<std::uint16_t>(part.offset / 8 | (part.more ? 0x2000U : 0U)));
  w.U8(64);
  w.U8(17);
  w.Be16(0);
  w.Be32(0x0a000000U | part.host);
  w.Be32(0x0a000001);
  w.Bytes({body.data(), body.size()});
  return out;
}

Bytes Ipv6(const Bytes& body, std::optional<Part> part = {}) {
  Bytes out;
  ByteWriter w(&out);
  w.Be32(0x60000000);
  w.Be16(static_cast<std::uint16_t>(body.size() + (part ? 8 : 0)));
  w.U8(part ? 44 : 17);
  w.U8(64);
  w.Zeros(15);
  w.U8(2);
  w.Zeros(15);
  w.U8(1);
  if (part) {
    w.U8(17);
    w.U8(0);
    w.Be16(static_cast<std::uint16_t>(part->offset | (part->more ? 1U : 0U)));
    w.Be32(part->id);
  }
  w.Bytes({body.data(), body.size()});
  return out;
}

Bytes Ethernet(const Bytes& ip, std::uint16_t type, int vlan_tags = 0) {
  Bytes out(12, 0xaa);
  ByteWriter w(&out);
  for (int i = 0; i < vlan_tags; ++i) {
    w.Be16(i == 0 ? 0x88a8 : 0x8100);
    w.Be16(42);
  }
  w.Be16(type);
  w.Bytes({ip.data(), ip.size()});
  return out;
}

ByteView View(const Bytes& b) { return {b.data(), b.size()}; }

TEST(Datagrams, ComeOutOfEveryKindOfFrame) {
  const Bytes payload = Payload(100);
  const Bytes v4 = Ipv4(Udp(payload));
  const Bytes v6 = Ipv6(Udp(payload));
  Bytes padded = Ethernet(v4, 0x0800);
  padded.resize(padded.size() + 10);
  Bytes sll(16);
  sll.insert(sll.end(), v4.begin(), v4.end());
  Bytes sll2(20);
  sll2.insert(sll2.end(), v6.begin(), v6.end());
  Bytes loopback(4);
  loopback.insert(loopback.end(), v4.begin(), v4.end());
  Bytes offloaded = v4;  // This packet was captured before the network card set its length.
  offloaded[2] = offloaded[3] = 0;
  const std::vector<std::pair<LinkType, Bytes>> frames = {
      {LinkType::kIpv4, offloaded},
      {LinkType::kEthernet, Ethernet(v4, 0x0800)},
      {LinkType::kEthernet, Ethernet(v6, 0x86dd)},
      {LinkType::kEthernet, Ethernet(v4, 0x0800, 2)},
      {LinkType::kEthernet, padded},
      {LinkType::kLinuxSll, sll},
      {LinkType::kLinuxSll2, sll2},
      {LinkType::kNull, loopback},
      {LinkType::kRaw, v6},
      {LinkType::kIpv4, v4}};
  for (const auto& [link, frame] : frames) {
    UdpExtractor extractor;
    const auto datagram = extractor.Extract(link, View(frame));
    ASSERT_TRUE(datagram) << static_cast<int>(link);
    EXPECT_EQ(datagram->payload, payload);
  }
}

/// The file has the number 101 for raw IP packets. libpcap uses another number for this link type.
TEST(Datagrams, ComeOutOfACaptureOfRawIp) {
  constexpr std::uint32_t kRawIp = 101;
  const Bytes ip = Ipv4(Udp(Payload(100)));
  const auto size = static_cast<std::uint32_t>(ip.size());
  Bytes file;
  ByteWriter w(&file);
  for (const std::uint32_t word :
       {0xa1b23c4dU, 0x00040002U, 0U, 0U, 65'535U, kRawIp, 1U, 0U, size, size})
    w.Le32(word);
  w.Bytes(View(ip));
  const test::TempFolder folder;
  const std::string path = folder.path() + "/raw.pcap";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  std::string error;
  const auto reader = PcapReader::Open(path, &error);
  ASSERT_TRUE(reader) << error;
  const auto captured = reader->Next();
  ASSERT_TRUE(captured);
  EXPECT_EQ(captured->datagram.payload, Payload(100));
}

class Fragments : public ::testing::TestWithParam<bool> {
 protected:
  /// Cuts the datagram into IP packets with up to `size` bytes of payload each.
  std::vector<Bytes> Cut(const Bytes& udp, std::size_t size, Part part = {}) const {
    std::vector<Bytes> packets;
    for (std::size_t at = 0; at < udp.size(); at += size) {
      part.offset = at;
      part.more = at + size < udp.size();
      const Bytes body(udp.begin() + static_cast<std::ptrdiff_t>(at),
                       udp.begin() + static_cast<std::ptrdiff_t>(std::min(udp.size(), at + size)));
      packets.push_back(GetParam() ? Ipv6(body, part) : Ipv4(body, part));
    }
    return packets;
  }
};

TEST_P(Fragments, ArePutTogetherInAnyOrder) {
  const Bytes payload = Payload(24'832);
  auto packets = Cut(Udp(payload), 1480);
  for (int round = 0; round < 2; ++round) {
    UdpExtractor extractor;
    int complete = 0;
    for (const Bytes& packet : packets) {
      const auto datagram = extractor.Extract(LinkType::kRaw, View(packet));
      if (!datagram) continue;
      ++complete;
      EXPECT_EQ(datagram->payload, payload);
    }
    EXPECT_EQ(complete, 1);
    std::reverse(packets.begin(), packets.end());
  }
}

TEST_P(Fragments, OfTwoDatagramsDoNotMix) {
  const Bytes a = Payload(4000);
  Bytes b = Payload(4000);
  std::reverse(b.begin(), b.end());
  const auto of_a = Cut(Udp(a), 1480);
  const auto of_b = Cut(Udp(b), 1480, {0, false, 9});
  UdpExtractor extractor;
  std::vector<Bytes> out;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    for (const Bytes* packet : {&of_a[i], &of_b[i]})
      if (auto datagram = extractor.Extract(LinkType::kRaw, View(*packet)))
        out.push_back(datagram->payload);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0], a);
  EXPECT_EQ(out[1], b);
}

TEST(Ipv4Fragments, OfTwoHostsWithTheSameIdentifierDoNotMix) {
  const Bytes a = Payload(2000);
  Bytes b = Payload(2000);
  std::reverse(b.begin(), b.end());
  UdpExtractor extractor;
  std::vector<Bytes> out;
  for (const std::size_t at : {0U, 1480U}) {
    for (const auto& [payload, host] : {std::pair(a, 2), std::pair(b, 3)}) {
      const Bytes udp = Udp(payload);
      const std::size_t end = std::min<std::size_t>(udp.size(), at + 1480);
      const Bytes body(udp.begin() + static_cast<std::ptrdiff_t>(at),
                       udp.begin() + static_cast<std::ptrdiff_t>(end));
      const Part part{at, end < udp.size(), 7, static_cast<std::uint8_t>(host)};
      if (auto datagram = extractor.Extract(LinkType::kRaw, View(Ipv4(body, part))))
        out.push_back(datagram->payload);
    }
  }
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0], a);
  EXPECT_EQ(out[1], b);
}

TEST_P(Fragments, ThatComeTwiceCountOnce) {
  const Bytes payload = Payload(4000);
  const auto packets = Cut(Udp(payload), 1480);
  UdpExtractor extractor;
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(packets[0])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(packets[1])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(packets[1])));
  const auto datagram = extractor.Extract(LinkType::kRaw, View(packets[2]));
  ASSERT_TRUE(datagram);
  EXPECT_EQ(datagram->payload, payload);
}

TEST_P(Fragments, ThatContradictEachOtherDiscardTheirDatagram) {
  Bytes other = Payload(4000);
  std::reverse(other.begin(), other.end());
  const auto of_one = Cut(Udp(Payload(4000)), 1480);
  const auto of_other = Cut(Udp(other), 1480);
  UdpExtractor extractor;
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(of_one[0])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(of_one[1])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(of_other[1])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(of_one[2])));
}

// With 640 packets per second, the identifiers of IPv4 repeat every 102 s.
TEST_P(Fragments, OfAnIncompleteDatagramAreForgottenBeforeTheirIdentifierComesRound) {
  Bytes next = Payload(4000);
  std::reverse(next.begin(), next.end());
  const auto lost = Cut(Udp(Payload(4000)), 1480);
  const auto whole = Cut(Udp(next), 1480);
  for (const Bytes& left : lost) {
    UdpExtractor extractor;
    EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(left), Time(std::chrono::seconds(1000))));
    std::optional<UdpDatagram> datagram;
    for (const Bytes& packet : whole)
      datagram = extractor.Extract(LinkType::kRaw, View(packet), Time(std::chrono::seconds(1088)));
    ASSERT_TRUE(datagram);
    EXPECT_EQ(datagram->payload, next);
  }
}

TEST_P(Fragments, WithoutEndHoldNoMoreThanSomeMemory) {
  UdpExtractor extractor;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const auto packets = Cut(Udp(Payload(4000)), 1480, {0, false, static_cast<std::uint16_t>(i)});
    EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(packets[0])));
  }
}

TEST_P(Fragments, OfTheOldestDatagramMakeRoomForThoseOfA33rd) {
  const Bytes payload = Payload(2000);
  UdpExtractor extractor;
  const auto extract = [&](std::uint16_t id, std::size_t fragment) {
    return extractor.Extract(LinkType::kRaw,
                             View(Cut(Udp(payload), 1480, {0, false, id})[fragment]));
  };
  for (std::uint16_t id = 0; id < 33; ++id) EXPECT_FALSE(extract(id, 0));
  for (std::uint16_t id = 1; id < 33; ++id) {
    const auto datagram = extract(id, 1);
    ASSERT_TRUE(datagram) << id;
    EXPECT_EQ(datagram->payload, payload) << id;
  }
  EXPECT_FALSE(extract(0, 1)) << "its first fragment is forgotten";
}

TEST_P(Fragments, BehindTheEndDiscardTheirDatagram) {
  const auto longer = Cut(Udp(Payload(4000)), 1480);
  const auto shorter = Cut(Udp(Payload(1592)), 1480);
  UdpExtractor extractor;
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(shorter[1])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(longer[2])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(shorter[0])));
}

TEST_P(Fragments, AreWholeUnitsOfEightBytesButForTheLast) {
  auto packets = Cut(Udp(Payload(4000)), 1476);
  UdpExtractor extractor;
  for (const Bytes& packet : packets) EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(packet)));
  // The fragment must not disturb the next datagram with the same identifier.
  const Bytes next = Payload(2000);
  std::optional<UdpDatagram> datagram;
  UdpExtractor other;
  EXPECT_FALSE(other.Extract(LinkType::kRaw, View(packets[0])));
  for (const Bytes& packet : Cut(Udp(next), 1480))
    datagram = other.Extract(LinkType::kRaw, View(packet));
  ASSERT_TRUE(datagram);
  EXPECT_EQ(datagram->payload, next);
}

TEST_P(Fragments, OfAnIdentifierThatComesAgainMakeAnotherDatagram) {
  UdpExtractor extractor;
  for (const std::size_t size : {4000U, 2000U, 3000U}) {
    std::optional<UdpDatagram> datagram;
    for (const Bytes& packet : Cut(Udp(Payload(size)), 1480))
      datagram = extractor.Extract(LinkType::kRaw, View(packet));
    ASSERT_TRUE(datagram) << size;
    EXPECT_EQ(datagram->payload, Payload(size));
  }
}

/// The second fragment begins at the same byte as the first fragment, but is longer.
TEST_P(Fragments, ThatOverlapInPartDiscardTheirDatagram) {
  const Bytes udp = Udp(Payload(4000));
  const auto packets = Cut(udp, 1480);
  const auto longer = Cut(udp, 2960);
  UdpExtractor extractor;
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(packets[0])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(longer[0])));
  EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(longer[1])));
}

INSTANTIATE_TEST_SUITE_P(BothVersions, Fragments, ::testing::Bool());

TEST(Datagrams, OfIpv6AreToldFromOtherPackets) {
  const Bytes whole = Ipv6(Udp(Payload(100)));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    UdpExtractor extractor;
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(cut))) << n;
  }
  constexpr std::uint8_t kTcp = 6;
  Bytes tcp = whole;
  tcp[6] = kTcp;
  Bytes extended = Ipv6(Udp(Payload(100)));
  extended[6] = 60;
  extended[40] = kTcp;  // the protocol after an extension with destination options
  extended[41] = 0;
  Bytes endless = Ipv6(Bytes(80));  // ten extensions, each followed by another extension
  endless[6] = 0;
  Bytes beyond = Ipv6({17, 200, 0, 0, 0, 0, 0, 0});  // an extension that is longer than its packet
  beyond[6] = 60;
  for (const Bytes& packet : {tcp, extended, endless, beyond}) {
    UdpExtractor extractor;
    EXPECT_FALSE(extractor.Extract(LinkType::kRaw, View(packet)));
  }
  UdpExtractor extractor;
  const auto datagram = extractor.Extract(LinkType::kRaw, View(whole));
  ASSERT_TRUE(datagram);
  EXPECT_TRUE(datagram->addresses.is_ipv6);
}

TEST(Datagrams, StandBehindTheExtensionsOfIpv6) {
  const Bytes payload = Payload(100);
  for (const std::uint8_t type : Bytes{0, 43, 60}) {
    for (const std::uint8_t units : Bytes{0, 1, 5}) {
      Bytes body = {17, units};
      body.resize(8 + std::size_t{units} * 8);
      const Bytes udp = Udp(payload);
      body.insert(body.end(), udp.begin(), udp.end());
      Bytes packet = Ipv6(body);
      packet[6] = type;
      UdpExtractor extractor;
      const auto datagram = extractor.Extract(LinkType::kRaw, View(packet));
      ASSERT_TRUE(datagram) << int{type} << " " << int{units};
      EXPECT_EQ(datagram->payload, payload);
    }
  }
}

TEST(Datagrams, AreAsLongAsTheirHeaderAtLeast) {
  for (std::uint8_t length = 0; length < 12; ++length) {
    Bytes udp = Udp(Payload(4));
    udp[5] = length;
    UdpExtractor extractor;
    const auto datagram = extractor.Extract(LinkType::kRaw, View(Ipv4(udp)));
    ASSERT_EQ(datagram.has_value(), length >= 8) << int{length};
    if (datagram) {
      EXPECT_EQ(datagram->payload.size(), length - 8U);
    }
  }
}

TEST(Datagrams, ACutFrameGivesNone) {
  const Bytes whole = Ethernet(Ipv4(Udp(Payload(100))), 0x0800);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    UdpExtractor extractor;
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(extractor.Extract(LinkType::kEthernet, View(cut))) << n;
  }
}

}  // namespace
}  // namespace lidar::ouster
