// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the messages of an MCAP file. Leaves out the damaged parts of the file.
#include <stdexcept>
#include <utility>

#include "src/mcap/input_file.h"
#include "src/mcap/reader.h"
#include "src/tools/lab/codec_lab/message_reader.h"

namespace lidar::tools {
namespace {

class McapMessages final : public MessageReader {
 public:
  explicit McapMessages(std::unique_ptr<mcap::Reader> reader) : reader_(std::move(reader)) {}

  std::vector<RecordedTopic> Topics() const override {
    std::vector<RecordedTopic> topics;
    const mcap::FileIndex& index = reader_->index();
    for (const auto& [id, channel] : index.channels) {
      const auto schema = index.schemas.find(channel.schema_id);
      if (schema == index.schemas.end() || channel.message_encoding != "cdr") continue;
      topics.push_back({channel.topic, schema->second.name});
    }
    return topics;
  }
  void Select(const std::string& topic) override {
    topic_ = topic;
    reader_->Seek(0);
  }
  std::optional<RecordedMessage> Next() override {
    while (const auto message = reader_->Next()) {
      const auto channel = reader_->index().channels.find(message->header.channel_id);
      if (channel == reader_->index().channels.end() || channel->second.topic != topic_) continue;
      return RecordedMessage{message->header.log_time, message->data};
    }
    return std::nullopt;
  }

 private:
  std::unique_ptr<mcap::Reader> reader_;
  std::string topic_;
};

}  // namespace

std::unique_ptr<MessageReader> OpenMcap(const std::string& path) {
  std::string why;
  auto file = mcap::InputFile::Open(path, &why);
  auto reader = file ? mcap::Reader::Open(std::move(file), &why) : nullptr;
  if (!reader) throw std::runtime_error(path + ": " + why);
  return std::make_unique<McapMessages>(std::move(reader));
}

}  // namespace lidar::tools
