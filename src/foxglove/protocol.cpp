// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/protocol.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace lidar::foxglove {
namespace {

using nlohmann::json;

std::optional<std::uint32_t> Id(const json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::uint32_t> Id(const json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found != object.end() ? Id(*found) : std::nullopt;
}

/// The array `name` of a request; NULL where there is none.
const json* ArrayOf(const json& request, const char* name) {
  const auto found = request.find(name);
  return found != request.end() && found->is_array() ? &*found : nullptr;
}

Request Malformed(const std::string& error) {
  Request request;
  request.error = error;
  return request;
}

Request ParseSubscribe(const json& message) {
  Request request;
  const json* list = ArrayOf(message, "subscriptions");
  if (list == nullptr) return Malformed("subscribe has no array \"subscriptions\"");
  for (const json& item : *list) {
    const auto id = Id(item, "id");
    const auto channel = Id(item, "channelId");
    if (!id || !channel) return Malformed("a subscription needs the numbers id and channelId");
    request.subscriptions.push_back({*id, *channel});
  }
  request.kind = Request::Kind::kSubscribe;
  return request;
}

Request ParseUnsubscribe(const json& message) {
  Request request;
  const json* list = ArrayOf(message, "subscriptionIds");
  if (list == nullptr) return Malformed("unsubscribe has no array \"subscriptionIds\"");
  for (const json& item : *list) {
    const auto id = Id(item);
    if (!id) return Malformed("a subscription id is no number");
    request.unsubscribed.push_back(*id);
  }
  request.kind = Request::Kind::kUnsubscribe;
  return request;
}

}  // namespace

std::string ServerInfo(const std::string& name, const std::string& session_id) {
  return json{{"op", "serverInfo"},
              {"name", name},
              {"capabilities", json::array()},
              {"supportedEncodings", json::array()},
              {"metadata", json::object()},
              {"sessionId", session_id}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string Advertise(const std::vector<Channel>& channels) {
  json list = json::array();
  for (const Channel& channel : channels) {
    const SchemaText schema = TextOf(channel.schema);
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", schema.encoding},
                    {"schemaName", schema.name},
                    {"schemaEncoding", schema.language},
                    {"schema", schema.text}});
  }
  return json{{"op", "advertise"}, {"channels", list}}.dump(-1, ' ', false,
                                                            json::error_handler_t::replace);
}

std::string Unadvertise(const std::vector<std::uint32_t>& channel_ids) {
  return json{{"op", "unadvertise"}, {"channelIds", channel_ids}}.dump();
}

std::string ErrorStatus(const std::string& text) {
  constexpr int kError = 2;
  return json{{"op", "status"}, {"level", kError}, {"message", text}}.dump(
      -1, ' ', false, json::error_handler_t::replace);
}

Request ParseRequest(std::string_view text) {
  const json message = json::parse(text.begin(), text.end(), nullptr, false);
  if (!message.is_object()) return Malformed("not a JSON object");
  const auto op = message.find("op");
  if (op == message.end() || !op->is_string()) return Malformed("the object has no \"op\"");
  if (*op == "subscribe") return ParseSubscribe(message);
  if (*op == "unsubscribe") return ParseUnsubscribe(message);
  Request request;
  request.kind = Request::Kind::kUnsupported;
  return request;
}

MessageHead HeadOf(std::uint32_t subscription_id, std::uint64_t unix_ns) {
  constexpr std::uint8_t kMessageData = 1;
  MessageHead head{kMessageData};
  for (unsigned i = 0; i < 4; ++i)
    head[1 + i] = static_cast<std::uint8_t>(subscription_id >> 8 * i);
  for (unsigned i = 0; i < 8; ++i) head[5 + i] = static_cast<std::uint8_t>(unix_ns >> 8 * i);
  return head;
}

}  // namespace lidar::foxglove
