// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/player.h"

#include <algorithm>
#include <utility>

#include "src/tools/common/event_loop.h"

namespace lidar::tools {
namespace {

constexpr Duration kTaiMinusUtc = std::chrono::seconds(37);
// The interval between checks for requests.
constexpr Duration kRequestPoll = std::chrono::milliseconds(5);
// A machine that makes packets more slowly than they are due is always late. It would never come
// back from sending all of them, and requests and faults would have to wait.
constexpr int kMostPacketsAtOnce = 16;

}  // namespace

std::uint64_t ClockAtStart(const std::string& timestamp_mode, Time now) {
  const Duration since_boot = std::chrono::seconds(3);
  const Duration utc = now.time_since_epoch() + UnixOffset();
  if (timestamp_mode == "TIME_FROM_PTP_1588")
    return static_cast<std::uint64_t>((utc + kTaiMinusUtc).count());
  if (timestamp_mode == "TIME_FROM_SYNC_PULSE_IN") return static_cast<std::uint64_t>(utc.count());
  return static_cast<std::uint64_t>(since_boot.count());
}

Player::Player(const ReplayOptions& options, const ouster::Metadata& metadata, Sensor* sensor,
               MakeStream make_stream)
    : options_(options),
      sensor_(*sensor),
      make_stream_(std::move(make_stream)),
      began_(Now()),
      injector_(options.seed) {
  Start(metadata, began_);
}

void Player::Start(const ouster::Metadata& metadata, Time now) {
  stream_ = make_stream_(metadata);
  stream_->Restart({metadata.init_id, ClockAtStart(metadata.timestamp_mode, now)});
  origin_ = now;
  next_ = stream_->Next();
}

void Player::RunEvents(Time now) {
  for (; next_event_ < options_.events.size(); ++next_event_) {
    const ReplayOptions::Event& event = options_.events[next_event_];
    if (began_ + FromSeconds(event.at_s) > now) return;
    if (event.restart) sensor_.Restart();
    sensor_.MergeFaults(event.faults);
  }
}

/// Resolves the destination, and opens a socket with an address of the same family.
void Player::SetDestination(const Sensor::Destination& to) {
  lidar_address_ = ResolveAddress(to.host + ":" + std::to_string(to.lidar_port), to.host);
  imu_address_ = ResolveAddress(to.host + ":" + std::to_string(to.imu_port), to.host);
  const std::string any = lidar_address_.storage.ss_family == AF_INET6 ? "::" : "0.0.0.0";
  socket_.reset();
  socket_ = UdpSocket::Bind(ResolveAddress("0", options_.source.empty() ? any : options_.source));
  if (!options_.multicast_iface.empty()) socket_->SendMulticastFrom(options_.multicast_iface);
  destination_ = to;
}

void Player::Send(const Sensor::Destination& to, const std::vector<OutPacket>& packets) {
  if (to.host.empty()) return;
  if (to != destination_) SetDestination(to);
  for (const OutPacket& packet : packets)
    socket_->Send({packet.bytes.data(), packet.bytes.size()}, 0,
                  packet.imu ? &imu_address_ : &lidar_address_);
}

void Player::SendHeld(const Sensor::Destination& to) {
  Send(to, injector_.Finish());
  CopyCounts();
}

void Player::CopyCounts() {
  std::lock_guard lock(mutex_);
  counts_ = injector_.counts();
}

std::optional<Time> Player::Pump(Time now) {
  RunEvents(now);
  if (auto metadata = sensor_.TakeRestart()) {
    SendHeld(destination_);  // a held packet is sent before the restart
    boots_until_ = now + FromSeconds(options_.boot_s);
    Start(*metadata, boots_until_);
  }
  if (now < boots_until_) return std::min(boots_until_, now + kRequestPoll);
  sensor_.SetRunning(true);
  const Faults faults = sensor_.faults();
  for (int i = 0; i < kMostPacketsAtOnce && next_ && origin_ + next_->due <= now; ++i) {
    Send(sensor_.destination(), injector_.Apply(faults, *std::move(next_)));
    next_ = stream_->Next();
  }
  CopyCounts();
  if (!next_) return std::nullopt;
  return std::min(origin_ + next_->due, now + kRequestPoll);
}

FaultCounts Player::counts() const {
  std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace lidar::tools
