// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/worker/lease_store.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "ext/nats/connection.h"

namespace lidar::worker {
namespace {

using nats::InboxPtr;
using nats::MessagePtr;
using nlohmann::json;

constexpr int kWrongRevision = 10'071;  // JSStreamWrongLastSequenceErr
constexpr const char* kReplaces = "Nats-Expected-Last-Subject-Sequence";

std::optional<std::uint64_t> ToNumber(std::string_view text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end) return std::nullopt;
  return value;
}

}  // namespace

LeaseStore::LeaseStore(natsConnection* connection, const std::string& bucket)
    : connection_(connection), bucket_(bucket) {
  natsInbox* raw_inbox = nullptr;
  natsStatus s = natsInbox_Create(&raw_inbox);
  const InboxPtr inbox(raw_inbox);
  natsSubscription* raw = nullptr;
  if (s == NATS_OK) {
    answer_prefix_ = std::string(inbox.get()) + ".";
    s = natsConnection_SubscribeSync(&raw, connection_, (answer_prefix_ + "*").c_str());
  }
  answers_.reset(raw);
  if (s != NATS_OK) throw std::runtime_error("NATS cannot be used: " + nats::ErrorText(s));
}

std::string LeaseStore::Subject(const std::string& bucket, const std::string& key) {
  return "$KV." + bucket + "." + key;
}

void LeaseStore::Write(std::uint64_t ticket, const std::string& key, std::uint64_t replaces,
                       const std::string& text) {
  natsMsg* raw = nullptr;
  if (natsMsg_Create(&raw, Subject(bucket_, key).c_str(),
                     (answer_prefix_ + std::to_string(ticket)).c_str(), text.data(),
                     static_cast<int>(text.size())) != NATS_OK)
    return;
  const MessagePtr message(raw);
  // Without the header it would replace anything.
  if (natsMsgHeader_Set(raw, kReplaces, std::to_string(replaces).c_str()) != NATS_OK) return;
  natsConnection_PublishMsg(connection_, raw);
}

std::optional<LeaseStore::Answer> LeaseStore::NextAnswer(std::chrono::milliseconds timeout) {
  natsMsg* raw = nullptr;
  if (natsSubscription_NextMsg(&raw, answers_.get(), timeout.count()) != NATS_OK)
    return std::nullopt;
  const MessagePtr message(raw);
  const std::string_view subject(natsMsg_GetSubject(raw));
  const auto ticket = ToNumber(subject.substr(std::min(answer_prefix_.size(), subject.size())));
  auto answer =
      ParseAnswer({natsMsg_GetData(raw), static_cast<std::size_t>(natsMsg_GetDataLength(raw))});
  // Whoever has no JetStream, or no bucket yet, refuses as well.
  if (!answer) answer.emplace();
  answer->ticket = ticket.value_or(0);
  return answer;
}

std::optional<LeaseStore::Answer> ParseAnswer(const std::string& text) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return std::nullopt;
  LeaseStore::Answer answer;
  const auto error = object.find("error");
  if (error != object.end()) {
    if (!error->is_object() || error->value("err_code", json()) != kWrongRevision) return answer;
    const json words = error->value("description", json());
    if (!words.is_string()) return answer;
    const auto& line = words.get_ref<const std::string&>();  // "wrong last sequence: 7"
    answer.newest = ToNumber(std::string_view(line).substr(line.rfind(' ') + 1));
    return answer;
  }
  const auto revision = object.find("seq");
  if (revision == object.end() || !revision->is_number_unsigned()) return std::nullopt;
  answer.revision = revision->get<std::uint64_t>();
  return answer;
}

}  // namespace lidar::worker
