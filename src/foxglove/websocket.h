// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames of the WebSocket protocol (RFC 6455), as a server writes and reads them.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::foxglove {

enum class Opcode : std::uint8_t {
  kContinuation = 0,
  kText = 1,
  kBinary = 2,
  kClose = 8,
  kPing = 9,
  kPong = 10,
};

/// The reason why a connection is closed (RFC 6455, section 7.4.1).
enum class CloseCode : std::uint16_t {
  kNormal = 1000,
  kGoingAway = 1001,
  kProtocolError = 1002,
  kTooLarge = 1009,
  kTokenOver = 4401,  // not in the RFC: the client needs a new token
};

/// Appends the header of an unfragmented frame whose payload has `size` bytes. The server does not
/// mask its frames.
void AppendFrameHeader(Opcode opcode, std::uint64_t size, std::vector<std::uint8_t>* out);
/// Returns a whole frame. The payload of a control frame may have at most 125 bytes.
std::vector<std::uint8_t> Frame(Opcode opcode, ByteView payload);
std::vector<std::uint8_t> TextFrame(std::string_view text);
std::vector<std::uint8_t> CloseFrame(CloseCode code);

/// A control frame, or a message of the client whose fragments have been joined.
struct ClientMessage {
  Opcode opcode = Opcode::kText;
  std::vector<std::uint8_t> payload;
};

/// Finds the messages in the bytes that a client sends. The client may send any bytes.
class MessageReader {
 public:
  /// Messages of more than `max_size` bytes are an error.
  explicit MessageReader(std::size_t max_size) : max_size_(max_size) {}

  /// Adds received bytes. Before the next call of Append(), call Next() until it returns nothing.
  void Append(ByteView bytes);
  /// Returns the next message. Returns nothing if more bytes are needed, and always after an error.
  std::optional<ClientMessage> Next();
  /// Returns the code with which the connection must be closed, or nothing if there is no error.
  std::optional<CloseCode> error() const { return error_; }

 private:
  struct FrameHead {
    bool final = false;
    Opcode opcode = Opcode::kText;
    std::size_t head_size = 0;
    std::size_t size = 0;
    std::uint32_t mask = 0;
  };
  std::optional<FrameHead> ReadHead();
  bool IsAllowed(const FrameHead& frame);
  std::vector<std::uint8_t> TakePayload(const FrameHead& frame);
  void Fail(CloseCode code) { error_ = code; }

  const std::size_t max_size_;
  std::vector<std::uint8_t> pending_;
  std::size_t read_ = 0;                    // number of bytes of pending_ that were used
  std::optional<ClientMessage> fragments_;  // joined fragments of an incomplete message
  std::optional<CloseCode> error_;
};

}  // namespace lidar::foxglove
