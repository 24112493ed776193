// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/protocol.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "src/base/base64.h"

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

/// Returns the array `name` of a request, or NULL if there is no such array.
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
    if (!id) return Malformed("a subscription id is not a number");
    request.unsubscribed.push_back(*id);
  }
  request.kind = Request::Kind::kUnsubscribe;
  return request;
}

void PutLe(std::uint64_t value, unsigned bytes, std::uint8_t* out) {
  for (unsigned i = 0; i < bytes; ++i) out[i] = static_cast<std::uint8_t>(value >> 8 * i);
}

/// Parses `{"op":"drawn","subscriptionId":7,"scan":1234,"slice":5}`, or a request of another
/// `kind`, which has no scan and no slice.
Request ParseOfSlices(const json& message, Request::Kind kind) {
  const auto subscription = Id(message, "subscriptionId");
  const auto scan = Id(message, "scan");
  const auto slice = Id(message, "slice");
  if (!subscription) return Malformed("the number subscriptionId is missing");
  if (kind == Request::Kind::kDrawn && (!scan || !slice))
    return Malformed("drawn needs the numbers scan and slice");
  Request request;
  request.kind = kind;
  request.subscription = *subscription;
  request.slice = {scan.value_or(0), slice.value_or(0)};
  return request;
}

/// Parses `{"op":"replay","subscriptionId":7,"number":3,"time":1764085200.5}`.
Request ParseReplay(const json& message) {
  constexpr double kLatest_s = 1e10;  // year 2286
  Request request = ParseOfSlices(message, Request::Kind::kReplay);
  const auto number = Id(message, "number");
  const auto time = message.find("time");
  if (request.kind != Request::Kind::kReplay) return request;
  if (!number || *number == 0 || *number > std::numeric_limits<std::uint16_t>::max() ||
      time == message.end() || !time->is_number())
    return Malformed("replay needs a number from 1 to 65535 and a time");
  const auto seconds = time->get<double>();
  if (!(seconds >= 0 && seconds <= kLatest_s))
    return Malformed("time must be in seconds since 1970");
  request.number = static_cast<std::uint16_t>(*number);
  request.time_ns = static_cast<std::uint64_t>(seconds * 1e9);
  return request;
}

double Seconds(std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

std::string DescribeSlices(const SliceStreamInfo& stream) {
  return json{{"geometry", stream.has_ranges ? "range" : "xyz"},
              {"fields", stream.fields},
              {"framerate", {stream.framerate_n, stream.framerate_d}},
              {"sensorModel", Base64(stream.sensor_model)},
              {"frameId", stream.frame_id},
              {"clouds", stream.clouds},
              {"recording", stream.recording}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

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
    const bool is_slice = channel.schema == Schema::kSlice;
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", schema.encoding},
                    {"schemaName", schema.name},
                    {"schemaEncoding", schema.language},
                    {"schema", is_slice ? channel.stream : schema.text}});
  }
  return json{{"op", "advertise"}, {"channels", list}}.dump(-1, ' ', false,
                                                            json::error_handler_t::replace);
}

std::string Unadvertise(const std::vector<std::uint32_t>& channel_ids) {
  return json{{"op", "unadvertise"}, {"channelIds", channel_ids}}.dump();
}

std::string Describe(const RecordingStatus& status) {
  return json{{"op", "recording"},
              {"subscriptionId", status.subscription},
              {"number", status.number},
              {"from", Seconds(status.from_ns)},
              {"to", Seconds(status.to_ns)},
              {"damaged", status.damaged},
              {"end", status.end_ns ? json(Seconds(*status.end_ns)) : json()}}
      .dump();
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
  if (*op == "drawn") return ParseOfSlices(message, Request::Kind::kDrawn);
  if (*op == "replay") return ParseReplay(message);
  if (*op == "live") return ParseOfSlices(message, Request::Kind::kLive);
  if (*op == "lacksReference") return ParseOfSlices(message, Request::Kind::kLacksReference);
  Request request;
  request.kind = Request::Kind::kUnsupported;
  return request;
}

MessageHead HeadOf(std::uint32_t subscription_id, std::uint64_t unix_ns) {
  constexpr std::uint8_t kMessageData = 1;
  MessageHead head{kMessageData};
  PutLe(subscription_id, 4, &head[1]);
  PutLe(unix_ns, 8, &head[5]);
  return head;
}

SliceHead HeadOfSlice(const SliceInfo& slice, std::uint64_t sent_unix_ns) {
  constexpr std::uint8_t kVersion = 1;
  const int flags = (slice.is_recoded ? 1 : 0) | (slice.is_pose ? 2 : 0);
  SliceHead head{kVersion, static_cast<std::uint8_t>(flags)};
  PutLe(slice.name.index, 2, &head[2]);
  PutLe(slice.count, 2, &head[4]);
  PutLe(slice.replay, 2, &head[6]);
  PutLe(slice.name.scan, 4, &head[8]);
  PutLe(slice.first_column, 4, &head[12]);
  PutLe(sent_unix_ns, 8, &head[16]);
  return head;
}

}  // namespace lidar::foxglove
