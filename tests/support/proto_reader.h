// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the fields of protobuf messages, for tests of the code that writes the messages.
#pragma once
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::test {

/// The fields of a protobuf message by their numbers. A field of bytes keeps all its values, in
/// order. A field of numbers keeps its last value.
class ProtoMessage {
 public:
  explicit ProtoMessage(ByteView bytes) {
    ByteReader in(bytes);
    while (in.ok() && in.remaining() > 0) {
      const std::uint64_t tag = Varint(&in);
      std::vector<std::uint8_t> value;
      switch (tag & 7) {
        case 0:
          numbers_[tag >> 3] = Varint(&in);
          break;
        case 1:
          numbers_[tag >> 3] = in.Le64();
          break;
        case 2: {
          const ByteView field = in.Bytes(static_cast<std::size_t>(Varint(&in)));
          texts_[tag >> 3].emplace_back(field.begin(), field.end());
          break;
        }
        case 5:
          numbers_[tag >> 3] = in.Le32();
          break;
        default:
          whole_ = false;
          return;
      }
    }
    whole_ = in.ok();
  }

  bool whole() const { return whole_; }
  std::uint64_t Number(std::uint64_t field) const {
    const auto found = numbers_.find(field);
    return found != numbers_.end() ? found->second : 0;
  }
  double Double(std::uint64_t field) const {
    const std::uint64_t bits = Number(field);
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::size_t Count(std::uint64_t field) const {
    const auto found = texts_.find(field);
    return found != texts_.end() ? found->second.size() : 0;
  }
  std::string Text(std::uint64_t field, std::size_t index = 0) const {
    return Count(field) > index ? texts_.at(field)[index] : "";
  }
  ProtoMessage Message(std::uint64_t field, std::size_t index = 0) const {
    const std::string text = Text(field, index);
    return ProtoMessage({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

 private:
  static std::uint64_t Varint(ByteReader* in) {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && in->ok(); shift += 7) {
      const std::uint8_t byte = in->U8();
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if (byte < 0x80) break;
    }
    return value;
  }

  std::map<std::uint64_t, std::uint64_t> numbers_;
  std::map<std::uint64_t, std::vector<std::string>> texts_;
  bool whole_ = false;
};

}  // namespace lidar::test
