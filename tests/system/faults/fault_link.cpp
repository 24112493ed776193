// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/system/faults/fault_link.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace lidar::test {
namespace {

constexpr std::size_t kRtpHeader = 12;
constexpr std::size_t kIpAndUdp = 28;
constexpr std::size_t kMaxSlices = 10'000;
// The number of newest scans whose slices may still get packets.
constexpr std::uint32_t kOpenScans = 8;

sockaddr_in Loopback(std::uint16_t port) {
  sockaddr_in a{};
  a.sin_family = AF_INET;
  a.sin_port = htons(port);
  a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return a;
}

int Open(std::uint16_t* port) {
  const int s = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  const int buffer = 4 << 20;
  setsockopt(s, IPPROTO_IP, IP_RECVTOS, &on, sizeof on);
  setsockopt(s, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  sockaddr_in a = Loopback(0);
  bind(s, reinterpret_cast<sockaddr*>(&a), sizeof a);
  socklen_t size = sizeof a;
  getsockname(s, reinterpret_cast<sockaddr*>(&a), &size);
  *port = ntohs(a.sin_port);
  return s;
}

bool IsMedia(const std::vector<std::uint8_t>& bytes) {
  // The second byte of an RTCP packet is a packet type from 192 to 223 (RFC 5761).
  return bytes.size() > kRtpHeader && (bytes[1] < 192 || bytes[1] > 223);
}

lidar::Time Now() {
  return lidar::Time{std::chrono::duration_cast<lidar::Duration>(
      std::chrono::steady_clock::now().time_since_epoch())};
}

std::uint32_t Ssrc(const std::vector<std::uint8_t>& bytes) {
  return lidar::ByteReader(bytes.data() + 8, 4).Be32();
}

}  // namespace

FaultLink::FaultLink(std::uint16_t receiver_port, unsigned seed)
    : receiver_port_(receiver_port), random_(seed) {
  in_ = Open(&port_);
  std::uint16_t ignored = 0;
  out_ = Open(&ignored);
  thread_ = std::thread([this] { Run(); });
}

FaultLink::~FaultLink() {
  stop_ = true;
  thread_.join();
  close(in_);
  close(out_);
}

void FaultLink::Set(const Fault& fault) {
  std::lock_guard lock(mutex_);
  fault_ = fault;
}

void FaultLink::Rebind() {
  std::lock_guard lock(mutex_);
  rebind_ = true;
}

LinkCounts FaultLink::counts() const {
  std::lock_guard lock(mutex_);
  LinkCounts c = counts_;
  c.slices += slices_.size();
  for (const auto& [key, seen] : slices_) c.slices_whole += seen.IsWhole() ? 1U : 0U;
  return c;
}

bool FaultLink::Chance(double probability) {
  return std::uniform_real_distribution<>(0, 1)(random_) < probability;
}

std::optional<FaultLink::Datagram> FaultLink::Receive(int socket, sockaddr_in* from) {
  Datagram d;
  d.bytes.resize(65'536);
  iovec part{d.bytes.data(), d.bytes.size()};
  alignas(cmsghdr) std::array<char, 64> control{};
  msghdr m{};
  m.msg_name = from;
  m.msg_namelen = sizeof *from;
  m.msg_iov = &part;
  m.msg_iovlen = 1;
  m.msg_control = control.data();
  m.msg_controllen = control.size();
  const ssize_t n = recvmsg(socket, &m, MSG_DONTWAIT);
  if (n < 0) return std::nullopt;
  d.bytes.resize(static_cast<std::size_t>(n));
  for (cmsghdr* c = CMSG_FIRSTHDR(&m); c != nullptr; c = CMSG_NXTHDR(&m, c))
    if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_TOS) d.tos = *CMSG_DATA(c);
  return d;
}

void FaultLink::Send(int socket, const Datagram& datagram, std::uint16_t port) {
  sockaddr_in to = Loopback(port);
  setsockopt(socket, IPPROTO_IP, IP_TOS, &datagram.tos, sizeof datagram.tos);
  sendto(socket, datagram.bytes.data(), datagram.bytes.size(), MSG_DONTWAIT,
         reinterpret_cast<sockaddr*>(&to), sizeof to);
}

void FaultLink::Note(const Datagram& datagram, bool hit) {
  std::lock_guard lock(mutex_);
  ++counts_.packets;
  if (hit) ++counts_.dropped;
  const auto& b = datagram.bytes;
  for (const auto& unit : rtp::ParsePayload({b.data() + kRtpHeader, b.size() - kRtpHeader})) {
    if (!rtp::IsSlice(unit.unit)) continue;
    const SliceKey key{Ssrc(b), unit.slice.scan_number, unit.slice.index};
    if (slices_.size() >= kMaxSlices) Fold(key);
    Seen& seen = slices_[key];
    seen.sequences.insert(lidar::ByteReader(b.data() + 2, 2).Be16());
    seen.starts |= rtp::StartsUnit(unit.type);
    seen.ends |= rtp::EndsUnit(unit.type);
    seen.hit |= hit;
  }
}

/// Counts the slices that will get no more packets, and removes them from `slices_`.
void FaultLink::Fold(const SliceKey& newest) {
  for (auto it = slices_.begin(); it != slices_.end();) {
    const bool open =
        it->first.ssrc == newest.ssrc && it->first.scan_number + kOpenScans > newest.scan_number;
    if (open) {
      ++it;
      continue;
    }
    ++counts_.slices;
    counts_.slices_whole += it->second.IsWhole() ? 1U : 0U;
    it = slices_.erase(it);
  }
}

/// Returns true if all packets of the slice passed. It is not sufficient that the link dropped none
/// of them, because a sender may send only a part of a slice and give up the rest.
bool FaultLink::Seen::IsWhole() const {
  // If the sequence numbers wrap within a slice, the span is nearly the whole range of numbers.
  const std::size_t span = std::size_t{*sequences.rbegin()} - *sequences.begin() + 1;
  return starts && ends && !hit && (span == sequences.size() || span > 60'000);
}

void FaultLink::SetCapacity(const std::string& trace) {
  std::string error;
  const auto capacity = link::Capacity::ParseTrace(trace, false, &error);
  if (!capacity) throw std::runtime_error(error);
  link::BottleneckConfig config;
  config.origin = Now();
  config.capacity = *capacity;
  config.aqm.kind = link::AqmConfig::Kind::kRamp;
  std::lock_guard lock(mutex_);
  bottleneck_ = std::make_unique<link::Bottleneck>(config);
}

void FaultLink::Send(const Datagram& datagram) { Send(out_, datagram, receiver_port_); }

void FaultLink::Forward(const Datagram& datagram) {
  {
    std::lock_guard lock(mutex_);
    if (bottleneck_) {
      const auto size = static_cast<std::int64_t>(datagram.bytes.size() + kIpAndUdp);
      bottleneck_->Enqueue(Now(),
                           {DataSize::Bytes(size), static_cast<Ecn>(datagram.tos & 3), next_id_});
      queued_.emplace(next_id_++, datagram);
      return;
    }
  }
  Send(datagram);
}

/// Sends the packets that have passed the bottleneck.
void FaultLink::Deliver() {
  std::vector<Datagram> through;
  {
    std::lock_guard lock(mutex_);
    if (!bottleneck_) return;
    for (const link::Outcome& outcome : bottleneck_->Deliver(Now())) {
      auto node = queued_.extract(outcome.packet.id);
      if (node.empty() || !outcome.delivered()) continue;
      node.mapped().tos |= static_cast<int>(outcome.packet.ecn);
      through.push_back(std::move(node.mapped()));
    }
  }
  for (const Datagram& datagram : through) Send(datagram);
}

/// Returns how long the thread may wait for incoming packets [ms].
int FaultLink::WaitMs() const {
  constexpr int kLongestMs = 20;
  std::lock_guard lock(mutex_);
  if (!bottleneck_ || bottleneck_->NextEventTime() == Time::max()) return kLongestMs;
  const double ms = 1e3 * Seconds(bottleneck_->NextEventTime() - Now());
  return static_cast<int>(std::clamp(std::ceil(ms), 0.0, double{kLongestMs}));
}

void FaultLink::SendGarbage(const Fault& fault, const Datagram& model) {
  for (unsigned i = 0; i < fault.garbage_ratio; ++i) {
    Datagram d;
    d.bytes.resize(12 + random_() % 1'300);
    for (auto& byte : d.bytes) byte = static_cast<std::uint8_t>(random_());
    if (fault.valid_garbage) std::memcpy(d.bytes.data(), model.bytes.data(), 2);
    Forward(d);
  }
  std::lock_guard lock(mutex_);
  counts_.garbage += fault.garbage_ratio;
}

void FaultLink::OnMedia(Datagram datagram) {
  Fault fault;
  {
    std::lock_guard lock(mutex_);
    fault = fault_;
  }
  const bool media = IsMedia(datagram.bytes);
  if (!media) {
    if (!fault.down) Forward(datagram);
    return;
  }
  const bool lost =
      fault.down || datagram.bytes.size() > fault.mtu || (fault.loss > 0 && Chance(fault.loss));
  const bool damaged = !lost && fault.damage > 0 && Chance(fault.damage);
  Note(datagram, lost || damaged);
  if (damaged) datagram.bytes.back() ^= 4;
  if (held_ && held_->second-- == 0) {
    Forward(held_->first);
    held_.reset();
  }
  if (lost) return;
  if ((datagram.tos & 3) != 0 && fault.mark > 0 && Chance(fault.mark)) datagram.tos |= 3;
  if (fault.reorder_by > 0 && !held_ && --until_hold_ == 0) {
    until_hold_ = 50;
    held_.emplace(std::move(datagram), fault.reorder_by - 1);
    return;
  }
  Forward(datagram);
  if (fault.duplicate > 0 && Chance(fault.duplicate)) Forward(datagram);
  SendGarbage(fault, datagram);
}

void FaultLink::Run() {
  while (!stop_) {
    std::array<pollfd, 2> fds{pollfd{in_, POLLIN, 0}, pollfd{out_, POLLIN, 0}};
    poll(fds.data(), fds.size(), WaitMs());
    bool down = false;
    double feedback_loss = 0;
    {
      std::lock_guard lock(mutex_);
      down = fault_.down;
      feedback_loss = fault_.feedback_loss;
      if (rebind_) {
        std::uint16_t ignored = 0;
        close(out_);
        out_ = Open(&ignored);
        rebind_ = false;
        continue;
      }
    }
    sockaddr_in from{};
    while (auto d = Receive(in_, &from)) {
      sender_port_ = ntohs(from.sin_port);
      OnMedia(*std::move(d));
    }
    Deliver();
    while (auto d = Receive(out_, &from))
      if (!down && !Chance(feedback_loss) && sender_port_ != 0) Send(in_, *d, sender_port_);
  }
}

}  // namespace lidar::test
