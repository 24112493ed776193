// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions for MCAP files in memory.
#pragma once
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "src/mcap/reader.h"
#include "src/mcap/writer.h"

namespace lidar::mcap::test {

constexpr std::uint64_t kSecond = 1'000'000'000;  // in nanoseconds

class MemoryInput : public Input {
 public:
  explicit MemoryInput(Bytes bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t size() const override { return bytes_.size(); }
  bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) override {
    if (offset > bytes_.size() || n > bytes_.size() - offset) return false;
    if (n > 0) std::memcpy(to, bytes_.data() + offset, n);
    return true;
  }

 private:
  Bytes bytes_;
};

inline std::unique_ptr<Reader> Open(Bytes file) {
  std::string why;
  return Reader::Open(std::make_unique<MemoryInput>(std::move(file)), &why);
}

/// A copy of a message that was read.
struct Kept {
  std::string topic;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  std::string data;

  bool operator==(const Kept& o) const {
    return topic == o.topic && log_time == o.log_time && publish_time == o.publish_time &&
           data == o.data;
  }
};

inline std::vector<Kept> ReadAll(Reader* reader) {
  std::vector<Kept> all;
  while (const auto message = reader->Next())
    all.push_back({reader->index().channels.at(message->header.channel_id).topic,
                   message->header.log_time, message->header.publish_time,
                   std::string(message->data.begin(), message->data.end())});
  return all;
}

inline ByteView View(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Writes a file with one or more topics into memory.
class FileMaker {
 public:
  explicit FileMaker(const WriterSettings& settings)
      : writer_(settings, &catalogue_, [this](ByteView bytes) {
          if (full_) return false;
          file_.insert(file_.end(), bytes.begin(), bytes.end());
          ends_.push_back(file_.size());
          return true;
        }) {}
  std::uint16_t AddChannel(const std::string& topic) {
    Channel channel;
    channel.topic = topic;
    channel.message_encoding = "cdr";
    channel.metadata = {{"caps", "of " + topic}};
    return AddChannel({0, "pkg/msg/" + topic, "ros2msg", "uint8[] data"}, std::move(channel));
  }
  std::uint16_t AddChannel(Schema schema, Channel channel) {
    channel.schema_id = catalogue_.AddSchema(std::move(schema));
    return catalogue_.AddChannel(std::move(channel));
  }
  std::uint16_t AddChannelWithoutSchema(const std::string& topic) {
    Channel channel;
    channel.topic = topic;
    channel.message_encoding = "json";
    return catalogue_.AddChannel(std::move(channel));
  }
  bool Add(std::uint16_t channel, std::uint64_t time, const std::string& data) {
    return writer_.Add({channel, 0, time, time + 7}, View(data));
  }
  Writer& writer() { return writer_; }
  const Bytes& file() const { return file_; }
  /// Returns the size of the file after each write, in order. Each chunk is one write.
  const std::vector<std::size_t>& ends() const { return ends_; }
  void FillDisk() { full_ = true; }
  void FreeDisk() { full_ = false; }

 private:
  Catalogue catalogue_;
  Bytes file_;
  std::vector<std::size_t> ends_;
  bool full_ = false;
  Writer writer_;
};

}  // namespace lidar::mcap::test
