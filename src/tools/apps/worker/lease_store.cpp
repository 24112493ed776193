// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/lease_store.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "ext/nats/connection.h"

namespace lidar::worker {
namespace {

using nats::MessagePtr;
using nlohmann::json;

constexpr int kWrongRevision = 10'071;  // JSStreamWrongLastSequenceErr
constexpr const char* kReplaces = "Nats-Expected-Last-Subject-Sequence";

}  // namespace

LeaseStore::LeaseStore(natsConnection* connection, const std::string& bucket)
    : connection_(connection), bucket_(bucket), subjects_(nats::AnswerSubjects::Make()) {
  natsSubscription* raw = nullptr;
  natsStatus s = NATS_NO_MEMORY;
  if (subjects_) s = natsConnection_SubscribeSync(&raw, connection_, subjects_->All().c_str());
  answers_ = nats::SubscriptionPtr(raw, {connection_});
  // If the connection is closed, the state of the connection says why.
  if (s != NATS_OK && s != NATS_CONNECTION_CLOSED)
    throw std::runtime_error("NATS cannot be used: " + nats::ErrorText(s));
}

std::string LeaseStore::Subject(const std::string& bucket, const std::string& key) {
  return "$KV." + bucket + "." + key;
}

void LeaseStore::Write(std::uint64_t ticket, const std::string& key, std::uint64_t replaces,
                       const std::string& text) {
  natsMsg* raw = nullptr;
  if (natsMsg_Create(&raw, Subject(bucket_, key).c_str(), subjects_->Of(ticket).c_str(),
                     text.data(), static_cast<int>(text.size())) != NATS_OK)
    return;
  const MessagePtr message(raw);
  // The header makes the server refuse the write if `replaces` is not the newest revision.
  if (natsMsgHeader_Set(raw, kReplaces, std::to_string(replaces).c_str()) != NATS_OK) return;
  natsConnection_PublishMsg(connection_, raw);
}

std::optional<LeaseStore::Answer> LeaseStore::NextAnswer(std::chrono::milliseconds timeout) {
  natsMsg* raw = nullptr;
  if (natsSubscription_NextMsg(&raw, answers_.get(), timeout.count()) != NATS_OK)
    return std::nullopt;
  const MessagePtr message(raw);
  const auto ticket = nats::ToNumber(subjects_->WordOf(raw));
  auto answer =
      ParseAnswer({natsMsg_GetData(raw), static_cast<std::size_t>(natsMsg_GetDataLength(raw))});
  // Any other answer is a refusal, too. The server then has no JetStream, or the bucket is missing.
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
    answer.newest = nats::ToNumber(std::string_view(line).substr(line.rfind(' ') + 1));
    return answer;
  }
  const auto revision = object.find("seq");
  if (revision == object.end() || !revision->is_number_unsigned()) return std::nullopt;
  answer.revision = revision->get<std::uint64_t>();
  return answer;
}

}  // namespace lidar::worker
