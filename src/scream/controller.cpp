// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/controller.h"

#include "src/scream/controller_impl.h"

namespace lidar::scream {

Controller::Controller(const Parameters& parameters) : impl_(std::make_unique<Impl>(parameters)) {}
Controller::~Controller() = default;
Controller::Controller(Controller&&) noexcept = default;
Controller& Controller::operator=(Controller&&) noexcept = default;

StreamId Controller::AddStream(const StreamConfig& config) { return impl_->AddStream(config); }

void Controller::ConfigureStream(StreamId stream, const StreamConfig& config) {
  impl_->ConfigureStream(stream, config);
}

void Controller::RemoveStream(StreamId stream) { impl_->streams.Remove(stream); }

void Controller::OnQueued(Time now, StreamId stream, const QueuedPacket& packet) {
  impl_->OnQueued(impl_->clock.From(now), stream, packet);
}

void Controller::OnSent(Time now, StreamId stream, const SentPacket& packet) {
  impl_->OnSent(impl_->clock.From(now), stream, packet);
}

void Controller::OnDropped(Time now, StreamId stream, std::size_t packets) {
  impl_->OnDropped(impl_->clock.From(now), stream, packets);
}

FeedbackResult Controller::OnFeedback(Time now, const CongestionFeedback& feedback) {
  return impl_->OnFeedback(impl_->clock.From(now), feedback);
}

void Controller::OnTimer(Time now) { impl_->OnTimer(impl_->clock.From(now)); }
void Controller::OnRouteChange(Time now) { impl_->OnRouteChange(impl_->clock.From(now)); }

std::optional<SendDecision> Controller::NextSend(Time now) const {
  auto decision = impl_->NextSend(impl_->clock.Peek(now));
  if (decision) decision->time = impl_->clock.ToCaller(decision->time);
  return decision;
}

std::size_t Controller::LatePackets(Time now, StreamId stream) const {
  const Stream* s = impl_->streams.Find(stream);
  return s == nullptr ? 0 : s->LatePackets(impl_->clock.Peek(now));
}

Time Controller::NextTimer() const { return impl_->clock.ToCaller(impl_->NextTimer()); }

DataRate Controller::target_bitrate(StreamId stream) const {
  const Stream* s = impl_->streams.Find(stream);
  return s == nullptr ? DataRate() : s->target_bitrate();
}

DataRate Controller::target_bitrate() const { return impl_->streams.target_bitrate(); }

std::optional<StreamId> Controller::FindStream(std::uint32_t ssrc) const {
  return impl_->streams.Owner(ssrc);
}

Statistics Controller::statistics(Time now) const {
  return impl_->GetStatistics(impl_->clock.Peek(now));
}

StreamStatistics Controller::stream_statistics(Time now, StreamId stream) const {
  Stream* s = impl_->streams.Find(stream);
  return s == nullptr ? StreamStatistics{} : s->statistics(impl_->clock.Peek(now));
}

EcnState Controller::ecn_state() const { return impl_->ecn.state(); }
const Parameters& Controller::parameters() const { return impl_->p; }

}  // namespace lidar::scream
