// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/client.h"

#include <algorithm>
#include <array>

namespace lidar::web {
namespace {

using foxglove::CloseCode;
using foxglove::Opcode;

/// A request to subscribe has about a hundred bytes.
constexpr std::size_t kMaxClientMessage = 64 * 1024;
constexpr std::size_t kMaxControls = 64;
/// The largest number of waiting slices. Two scans have at most 1024 slices each.
constexpr std::size_t kMaxSlices = 2048;
constexpr gint64 kSecond_us = G_USEC_PER_SEC;
constexpr gint64 kAskAfter_us = 10 * kSecond_us;
constexpr gint64 kSilent_us = 30 * kSecond_us;
constexpr gint64 kStalled_us = 30 * kSecond_us;

ByteView ViewOf(const std::vector<std::uint8_t>& bytes) { return {bytes.data(), bytes.size()}; }

}  // namespace

Client::Client(ObjectPtr<GIOStream> stream, Handlers handlers, gint64 (*clock_us)())
    : stream_(std::move(stream)),
      handlers_(std::move(handlers)),
      clock_us_(clock_us),
      reader_(kMaxClientMessage),
      heard_us_(clock_us()),
      progress_us_(heard_us_) {
  auto* input = G_POLLABLE_INPUT_STREAM(g_io_stream_get_input_stream(stream_.get()));
  readable_.reset(g_pollable_input_stream_create_source(input, nullptr));
  g_source_set_callback(readable_.get(), G_SOURCE_FUNC(OnReadable), this, nullptr);
  g_source_attach(readable_.get(), g_main_context_get_thread_default());
}

Client::~Client() {
  readable_.reset();
  writable_.reset();
  // Shuts the socket down first. Otherwise closing a TLS connection would wait for a peer that does
  // not read the close notification.
  if (G_IS_TLS_CONNECTION(stream_.get())) {
    GIOStream* base = nullptr;
    g_object_get(stream_.get(), "base-io-stream", &base, nullptr);
    const ObjectPtr<GIOStream> owner(base);
    g_socket_shutdown(g_socket_connection_get_socket(G_SOCKET_CONNECTION(base)), TRUE, TRUE,
                      nullptr);
  }
  g_io_stream_close(stream_.get(), nullptr, nullptr);
}

gboolean Client::OnReadable(GObject*, gpointer self) {
  static_cast<Client*>(self)->Read();
  return G_SOURCE_CONTINUE;
}

gboolean Client::OnWritable(GObject*, gpointer self) {
  auto* client = static_cast<Client*>(self);
  client->writable_.reset();
  client->Write();
  return G_SOURCE_REMOVE;
}

/// Reads a limited amount per call, because a client that sends without end must not occupy the
/// thread.
void Client::Read() {
  std::array<std::uint8_t, 16 * 1024> buffer;
  auto* input = G_POLLABLE_INPUT_STREAM(g_io_stream_get_input_stream(stream_.get()));
  GError* error = nullptr;
  const gssize size = g_pollable_input_stream_read_nonblocking(input, buffer.data(), buffer.size(),
                                                               nullptr, &error);
  const GErrorPtr owner(error);
  if (size < 0 && g_error_matches(error, G_IO_ERROR, G_IO_ERROR_WOULD_BLOCK)) return;
  if (size <= 0) return End();
  heard_us_ = clock_us_();
  asked_us_ = 0;
  reader_.Append({buffer.data(), static_cast<std::size_t>(size)});
  while (!closed_) {
    const auto message = reader_.Next();
    if (!message) break;
    Handle(*message);
  }
  if (closed_ || !reader_.error()) return;
  handlers_.on_garbage(this);
  Close(*reader_.error());
}

void Client::Handle(const foxglove::ClientMessage& message) {
  switch (message.opcode) {
    case Opcode::kText:
      return handlers_.on_text(this, message.payload);
    case Opcode::kPing:
      pong_ = Frame(Opcode::kPong, ViewOf(message.payload));
      return Write();
    case Opcode::kClose:
      return Close(CloseCode::kNormal);
    case Opcode::kPong:
      return;
    case Opcode::kBinary:
    case Opcode::kContinuation:
      return handlers_.on_garbage(this);  // clients cannot publish here
  }
}

void Client::SendText(const std::string& text) { SendFrame(foxglove::TextFrame(text)); }

void Client::SendFrame(std::vector<std::uint8_t> frame) {
  if (closed_) return;
  if (controls_.size() >= kMaxControls) return End();
  controls_.push_back(std::move(frame));
  Write();
}

std::size_t Client::Send(Outbox::Item item, std::size_t depth) {
  if (closed_) return 0;
  const std::size_t dropped = outbox_.Push(std::move(item), depth);
  Write();
  return dropped;
}

void Client::SendSlice(std::uint32_t channel, std::uint32_t subscription, SharedSliceMessage slice,
                       std::uint16_t replay) {
  if (closed_) return;
  if (slices_.size() >= kMaxSlices) return End();
  slices_.push_back({channel, subscription, std::move(slice), replay});
  Write();
}

void Client::Forget(std::uint32_t channel) {
  outbox_.Forget(channel);
  const auto gone = std::remove_if(slices_.begin(), slices_.end(), [channel](const auto& waiting) {
    return waiting.channel == channel;
  });
  slices_.erase(gone, slices_.end());
}

void Client::Close(CloseCode code) {
  if (closed_) return;
  // A close frame may be sent between two frames, but not within a frame.
  if (!current_ || current_->sent == 0) WriteSome({foxglove::CloseFrame(code), nullptr, 0});
  End();
}

void Client::End() {
  if (closed_) return;
  closed_ = true;
  readable_.reset();
  writable_.reset();
  handlers_.on_closed(this);
}

void Client::Tick() {
  if (closed_) return;
  const gint64 now_us = clock_us_();
  const bool stalled = current_ && now_us - progress_us_ > kStalled_us;
  // While the client receives a long frame, it can neither receive a ping nor answer it. Therefore
  // progress counts as a sign of life.
  if (current_ && progress_us_ > heard_us_) heard_us_ = progress_us_;
  if (stalled || now_us - heard_us_ > kSilent_us) return Close(CloseCode::kGoingAway);
  if (asked_us_ != 0 || now_us - heard_us_ < kAskAfter_us) return;
  asked_us_ = now_us;
  SendFrame(foxglove::Frame(Opcode::kPing, {}));
}

/// Makes the next frame the current frame. Control frames are sent before data.
bool Client::TakeNext() { return TakeControl() || TakeSlice() || TakeMessage(); }

bool Client::TakeControl() {
  if (pong_) {
    current_ = Outgoing{std::move(*pong_), nullptr, 0};
    pong_.reset();
    return true;
  }
  if (controls_.empty()) return false;
  current_ = Outgoing{std::move(controls_.front()), nullptr, 0};
  controls_.pop_front();
  return true;
}

bool Client::TakeSlice() {
  if (slices_.empty()) return false;
  const WaitingSlice next = std::move(slices_.front());
  slices_.pop_front();
  const SliceMessage& slice = *next.slice;
  const auto now_ns = static_cast<std::uint64_t>(g_get_real_time()) * 1000;
  const auto about = foxglove::HeadOfSlice({{slice.id.scan, slice.id.index},
                                            slice.count,
                                            slice.first_column,
                                            slice.is_recoded,
                                            next.replay,
                                            slice.is_pose},
                                           now_ns);
  Begin(foxglove::HeadOf(next.subscription, slice.unix_ns), {about.data(), about.size()},
        {next.slice, &slice.payload});
  return true;
}

bool Client::TakeMessage() {
  auto item = outbox_.Pop();
  if (!item) return false;
  Begin(foxglove::HeadOf(item->subscription_id, item->message->unix_ns), {},
        {item->message, &item->message->payload});
  return true;
}

void Client::Begin(const foxglove::MessageHead& head, ByteView more,
                   std::shared_ptr<const std::vector<std::uint8_t>> body) {
  Outgoing out;
  const std::size_t size = head.size() + more.size + body->size();
  foxglove::AppendFrameHeader(Opcode::kBinary, size, &out.head);
  out.head.insert(out.head.end(), head.begin(), head.end());
  out.head.insert(out.head.end(), more.begin(), more.end());
  out.body = std::move(body);
  current_ = std::move(out);
}

std::size_t Client::WriteSome(const Outgoing& out) {
  std::array<GOutputVector, 2> vectors;
  gsize n = 0;
  const std::size_t head_left = out.head.size() - std::min(out.sent, out.head.size());
  if (head_left > 0) vectors[n++] = {out.head.data() + out.sent, head_left};
  if (out.body) {
    const std::size_t done = out.sent - (out.head.size() - head_left);
    vectors[n++] = {out.body->data() + done, out.body->size() - done};
  }
  auto* output = G_POLLABLE_OUTPUT_STREAM(g_io_stream_get_output_stream(stream_.get()));
  gsize written = 0;
  GError* error = nullptr;
  const GPollableReturn result = g_pollable_output_stream_writev_nonblocking(
      output, vectors.data(), n, &written, nullptr, &error);
  const GErrorPtr owner(error);
  if (result == G_POLLABLE_RETURN_FAILED) End();
  return result == G_POLLABLE_RETURN_OK ? written : 0;
}

void Client::Write() {
  if (writable_) return;  // the socket's buffer is full
  while (!closed_ && (current_ || TakeNext())) {
    const std::size_t written = WriteSome(*current_);
    if (closed_) return;
    if (written == 0) return WaitForRoom();
    progress_us_ = clock_us_();
    counters_.bytes += written;
    current_->sent += written;
    if (current_->sent < current_->Size()) continue;
    if (current_->body) ++counters_.messages;
    current_.reset();
  }
}

void Client::WaitForRoom() {
  auto* output = G_POLLABLE_OUTPUT_STREAM(g_io_stream_get_output_stream(stream_.get()));
  writable_.reset(g_pollable_output_stream_create_source(output, nullptr));
  g_source_set_callback(writable_.get(), G_SOURCE_FUNC(OnWritable), this, nullptr);
  g_source_attach(writable_.get(), g_main_context_get_thread_default());
}

}  // namespace lidar::web
