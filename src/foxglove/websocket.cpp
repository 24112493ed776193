// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/websocket.h"

#include "src/base/byte_writer.h"

namespace lidar::foxglove {
namespace {

constexpr std::uint8_t kFinal = 0x80;
constexpr std::uint8_t kReserved = 0x70;
constexpr std::uint8_t kMasked = 0x80;
constexpr std::size_t kMostOfControl = 125;
constexpr std::uint8_t kSize16 = 126;
constexpr std::uint8_t kSize64 = 127;

bool IsControl(Opcode opcode) { return static_cast<std::uint8_t>(opcode) >= 8; }

bool IsKnown(Opcode opcode) {
  const auto code = static_cast<std::uint8_t>(opcode);
  return code <= 2 || (code >= 8 && code <= 10);
}

}  // namespace

void AppendFrameHeader(Opcode opcode, std::uint64_t size, std::vector<std::uint8_t>* out) {
  ByteWriter bytes(out);
  bytes.U8(kFinal | static_cast<std::uint8_t>(opcode));
  if (size <= kMostOfControl) {
    bytes.U8(static_cast<std::uint8_t>(size));
  } else if (size <= 0xFFFF) {
    bytes.U8(kSize16);
    bytes.Be16(static_cast<std::uint16_t>(size));
  } else {
    bytes.U8(kSize64);
    bytes.Be64(size);
  }
}

std::vector<std::uint8_t> Frame(Opcode opcode, ByteView payload) {
  std::vector<std::uint8_t> frame;
  AppendFrameHeader(opcode, payload.size, &frame);
  frame.insert(frame.end(), payload.begin(), payload.end());
  return frame;
}

std::vector<std::uint8_t> TextFrame(std::string_view text) {
  return Frame(Opcode::kText, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::vector<std::uint8_t> CloseFrame(CloseCode code) {
  std::vector<std::uint8_t> payload;
  ByteWriter(&payload).Be16(static_cast<std::uint16_t>(code));
  return Frame(Opcode::kClose, {payload.data(), payload.size()});
}

void MessageReader::Append(ByteView bytes) {
  if (error_) return;
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(read_));
  read_ = 0;
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
}

/// Reads and checks the header of the next frame. Returns nothing if bytes are missing, and after
/// an error.
std::optional<MessageReader::FrameHead> MessageReader::ReadHead() {
  ByteReader in(pending_.data() + read_, pending_.size() - read_);
  const std::uint8_t first = in.U8();
  const std::uint8_t second = in.U8();
  if (!in.ok()) return std::nullopt;
  FrameHead frame;
  frame.final = (first & kFinal) != 0;
  frame.opcode = static_cast<Opcode>(first & 0x0F);
  std::uint64_t size = second & 0x7F;
  // A client must mask all frames (RFC 6455, section 5.1). Reserved bits need an extension, and
  // none is negotiated.
  const bool control = IsControl(frame.opcode);
  if ((first & kReserved) != 0 || (second & kMasked) == 0 || !IsKnown(frame.opcode) ||
      (control && (!frame.final || size > kMostOfControl))) {
    Fail(CloseCode::kProtocolError);
    return std::nullopt;
  }
  if (size == kSize16)
    size = in.Be16();
  else if (size == kSize64)
    size = in.Be64();
  frame.mask = in.Be32();
  if (!in.ok()) return std::nullopt;
  if (size > max_size_ ||
      (!control && fragments_ && fragments_->payload.size() + size > max_size_)) {
    Fail(CloseCode::kTooLarge);
    return std::nullopt;
  }
  frame.head_size = in.position();
  frame.size = static_cast<std::size_t>(size);
  return frame;
}

/// Checks the order of frames: a message begins with a text or binary frame, and only continuation
/// frames follow. If the order is wrong, sets the error and returns false.
bool MessageReader::IsAllowed(const FrameHead& frame) {
  if (IsControl(frame.opcode)) return true;
  const bool continues = frame.opcode == Opcode::kContinuation;
  if (continues == fragments_.has_value()) return true;
  Fail(CloseCode::kProtocolError);
  return false;
}

std::vector<std::uint8_t> MessageReader::TakePayload(const FrameHead& frame) {
  const std::uint8_t* from = pending_.data() + read_ + frame.head_size;
  std::vector<std::uint8_t> payload(from, from + frame.size);
  for (std::size_t i = 0; i < payload.size(); ++i)
    payload[i] ^= static_cast<std::uint8_t>(frame.mask >> (24 - 8 * (i % 4)));
  read_ += frame.head_size + frame.size;
  return payload;
}

std::optional<ClientMessage> MessageReader::Next() {
  while (!error_) {
    const auto frame = ReadHead();
    if (!frame || !IsAllowed(*frame)) return std::nullopt;
    if (pending_.size() - read_ - frame->head_size < frame->size) return std::nullopt;
    ClientMessage message{frame->opcode, TakePayload(*frame)};
    if (IsControl(frame->opcode)) return message;
    if (fragments_) {
      auto& whole = fragments_->payload;
      whole.insert(whole.end(), message.payload.begin(), message.payload.end());
    } else {
      fragments_ = std::move(message);
    }
    if (!frame->final) continue;
    message = std::move(*fragments_);
    fragments_.reset();
    return message;
  }
  return std::nullopt;
}

}  // namespace lidar::foxglove
