// SPDX-License-Identifier: LGPL-2.1-or-later
// tcp-flow: sends a greedy flow over UDP that is controlled like TCP by Reno, Cubic or Prague. It
// competes with a flow of this project on lidar-link.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/byte_writer.h"
#include "src/sim/tcp_sender.h"
#include "src/tools/common/event_loop.h"
#include "src/tools/common/udp_socket.h"

namespace {

using lidar::ByteReader;
using lidar::ByteWriter;
using lidar::Time;
using lidar::scream::test::TcpKind;
using lidar::scream::test::TcpSender;
using lidar::tools::Datagram;
using lidar::tools::EventLoop;
using lidar::tools::Now;
using lidar::tools::UdpSocket;

constexpr std::size_t kPayload = 1472;  // 1500 bytes on the wire
constexpr std::uint8_t kEcnMask = 3;
constexpr std::uint8_t kCe = 3;
constexpr std::uint8_t kEct1 = 1;

/// Sends packets until the process gets a signal. Then prints the number of packets sent.
void Send(const std::string& to, TcpKind kind) {
  UdpSocket socket = UdpSocket::Connect(lidar::tools::ResolveAddress(to, "127.0.0.1"));
  EventLoop loop;
  lidar::tools::RequestRealtimePriority();
  TcpSender sender(kind, Now(), 1e9);
  std::uint64_t packets = 0;
  std::vector<std::uint8_t> bytes;
  loop.Watch(socket.fd(), [&] {
    const Time now = Now();
    socket.ReceiveAll([&](const Datagram& d) {
      ByteReader reader(d.payload);
      const std::uint64_t id = reader.Be64();
      const bool ce = reader.U8() == kCe;
      if (reader.ok()) sender.OnAck(now, id, ce);
    });
  });
  loop.Run([&] {
    const Time now = Now();
    sender.OnTimer(now);
    for (; sender.MaySend(now); ++packets) {
      bytes.clear();
      ByteWriter(&bytes).Be64(sender.SendPacket(now));
      bytes.resize(kPayload);
      socket.Send({bytes.data(), bytes.size()}, kind == TcpKind::kPrague ? kEct1 : 0, nullptr);
    }
    loop.SetWakeUp(sender.NextEvent());
  });
  std::printf("{\"packets_sent\": %llu}\n", static_cast<unsigned long long>(packets));
}

/// Sends an acknowledgement of each packet to the address that the packet came from.
void Receive(const std::string& at) {
  UdpSocket socket = UdpSocket::Bind(lidar::tools::ResolveAddress(at, "0.0.0.0"));
  EventLoop loop;
  lidar::tools::RequestRealtimePriority();
  loop.Watch(socket.fd(), [&] {
    socket.ReceiveAll([&](const Datagram& d) {
      ByteReader reader(d.payload);
      std::vector<std::uint8_t> ack;
      ByteWriter writer(&ack);
      writer.Be64(reader.Be64());
      writer.U8(d.tos & kEcnMask);
      if (reader.ok()) socket.Send({ack.data(), ack.size()}, 0, d.from);
    });
  });
  loop.Run([&] { loop.SetWakeUp(Time::max()); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"tcp-flow: a greedy flow as TCP is, over UDP, for lidar-link.", "tcp-flow"};
  app.require_subcommand(1);
  std::string address;
  TcpKind kind = TcpKind::kCubic;
  auto* tx = app.add_subcommand("tx", "Send until Ctrl-C");
  tx->add_option("address", address, "HOST:PORT")->required();
  const std::map<std::string, TcpKind> kinds{
      {"reno", TcpKind::kReno}, {"cubic", TcpKind::kCubic}, {"prague", TcpKind::kPrague}};
  tx->add_option("--kind", kind, "reno, cubic or prague")
      ->transform(CLI::CheckedTransformer(kinds));
  auto* rx = app.add_subcommand("rx", "Acknowledge what comes");
  rx->add_option("address", address, "[HOST:]PORT")->required();
  try {
    app.parse(argc, argv);
    if (rx->parsed())
      Receive(address);
    else
      Send(address, kind);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "tcp-flow: %s\n", e.what());
    return 1;
  }
  return 0;
}
