// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/lidar_link/relay.h"

#include <algorithm>

namespace lidar::tools {
namespace {

constexpr std::uint8_t kEcnMask = 3;
constexpr std::size_t kMaxFlows = 64;

Ecn EcnOf(std::uint8_t tos) { return static_cast<Ecn>(tos & kEcnMask); }

std::uint8_t WithEcn(std::uint8_t tos, Ecn ecn) {
  return static_cast<std::uint8_t>((tos & 0xFCU) | static_cast<unsigned>(ecn));
}

}  // namespace

Relay::Relay(const LinkOptions& options, EventLoop* loop, Recorder* recorder)
    : options_(options),
      loop_(loop),
      recorder_(recorder),
      back_(options.back),
      unix_offset_(UnixOffset()) {
  for (std::size_t i = 0; i < options_.listen.size(); ++i) {
    listeners_.push_back({UdpSocket::Bind(ResolveAddress(options_.listen[i], "0.0.0.0")),
                          ResolveAddress(options_.forward[i], "127.0.0.1")});
    loop_->Watch(listeners_[i].socket.fd(), [this, i] {
      listeners_[i].socket.ReceiveAll([this, i](const Datagram& d) { OnMedia(i, d); });
    });
  }
  if (options_.origin_at_start) Start(Now());
}

std::vector<int> Relay::ListeningPorts() const {
  std::vector<int> ports;
  for (const Listener& l : listeners_) ports.push_back(l.socket.LocalPort());
  return ports;
}

void Relay::Start(Time origin) {
  options_.there.origin = origin;
  there_.emplace(options_.there);
  recorder_->Start(origin, unix_offset_);
}

Time Relay::ArrivalOf(const Datagram& datagram) {
  const Time now = Now();
  // The kernel's time of reception is more exact, because this process may run later.
  const Time kernel{datagram.kernel_time - unix_offset_};
  constexpr auto kPlausible = std::chrono::seconds{1};
  const bool use_kernel = kernel <= now && kernel > now - kPlausible;
  newest_ = std::max(newest_, use_kernel ? kernel : now);
  return newest_;
}

std::optional<std::size_t> Relay::FindFlow(std::size_t listener, const Address& client) {
  for (std::size_t i = 0; i < flows_.size(); ++i)
    if (flows_[i].listener == listener && flows_[i].client == client) return i;
  if (flows_.size() == kMaxFlows) return {};
  const std::size_t flow = flows_.size();
  flows_.push_back({listener, client, UdpSocket::Connect(listeners_[listener].forward)});
  loop_->Watch(flows_[flow].socket.fd(), [this, flow] {
    flows_[flow].socket.ReceiveAll([this, flow](const Datagram& d) { OnFeedback(flow, d); });
  });
  return flow;
}

void Relay::OnMedia(std::size_t listener, const Datagram& datagram) {
  const Time arrival = ArrivalOf(datagram);
  if (!there_) Start(arrival);
  if (const auto flow = FindFlow(listener, *datagram.from))
    Enqueue(&*there_, arrival, datagram, *flow);
  else
    recorder_->OnRefusedSend();
}

void Relay::OnFeedback(std::size_t flow, const Datagram& datagram) {
  Enqueue(&back_, ArrivalOf(datagram), datagram, flow);
}

void Relay::Enqueue(link::Bottleneck* link, Time arrival, const Datagram& datagram,
                    std::size_t flow) {
  const auto size =
      DataSize::Bytes(static_cast<std::int64_t>(datagram.payload.size) + options_.overhead_bytes);
  const Ecn ecn = options_.bleach ? Ecn::kNotEct : EcnOf(datagram.tos);
  link->Enqueue(arrival, {size, ecn, TakeSlot(datagram, flow)});
}

std::size_t Relay::TakeSlot(const Datagram& datagram, std::size_t flow) {
  if (free_slots_.empty()) {
    free_slots_.push_back(slots_.size());
    slots_.emplace_back();
  }
  const std::size_t index = free_slots_.back();
  free_slots_.pop_back();
  slots_[index].payload.assign(datagram.payload.begin(), datagram.payload.end());
  slots_[index].flow = flow;
  slots_[index].tos = datagram.tos;
  return index;
}

void Relay::Forward(const link::Outcome& outcome, Time now) {
  const Slot& slot = slots_[outcome.packet.id];
  const ByteView payload{slot.payload.data(), slot.payload.size()};
  if (outcome.delivered()) {
    if (!flows_[slot.flow].socket.Send(payload, WithEcn(slot.tos, outcome.packet.ecn), nullptr))
      recorder_->OnRefusedSend();
    recorder_->OnLateness(now - outcome.arrival);
  }
  recorder_->OnPacket({outcome, EcnOf(slot.tos), slot.flow, payload});
  Release(outcome);
}

void Relay::Return(const link::Outcome& outcome) {
  const Slot& slot = slots_[outcome.packet.id];
  if (outcome.delivered()) {
    Flow& flow = flows_[slot.flow];
    if (!listeners_[flow.listener].socket.Send({slot.payload.data(), slot.payload.size()},
                                               WithEcn(slot.tos, outcome.packet.ecn), &flow.client))
      recorder_->OnRefusedSend();
  }
  recorder_->OnFeedback(outcome.delivered(), slot.payload.size());
  Release(outcome);
}

void Relay::Release(const link::Outcome& outcome) {
  // The slot is freed after the first copy. A duplicate directly follows the first copy, before the
  // slot is used for another packet.
  if (!outcome.duplicate) free_slots_.push_back(outcome.packet.id);
}

Time Relay::Pump() {
  const Time now = newest_ = std::max(newest_, Now());
  Time next = Time::max();
  if (there_) {
    for (const link::Outcome& outcome : there_->Deliver(now)) Forward(outcome, now);
    next = there_->NextEventTime();
  }
  for (const link::Outcome& outcome : back_.Deliver(now)) Return(outcome);
  return std::min(next, back_.NextEventTime());
}

}  // namespace lidar::tools
