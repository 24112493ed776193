// SPDX-License-Identifier: LGPL-2.1-or-later
// The element under test, and a client of its server that is based on libsoup.
#pragma once
#include <libsoup/soup.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/byte_reader.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"

namespace lidar::test {

/// A foxglovesink with one pad, on a free port.
class Sink {
 public:
  explicit Sink(const std::string& properties = "") {
    GError* error = nullptr;
    element_ = gst_parse_launch(("foxglovesink port=0 sync=false " + properties).c_str(), &error);
    EXPECT_EQ(error, nullptr);
    gst_object_ref_sink(element_);
    harness_.reset(gst_harness_new_with_element(element_, "sink_%u", nullptr));
  }
  ~Sink() {
    harness_.reset();
    gst_object_unref(element_);
  }
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  GstElement* element() { return element_; }
  GstHarness* harness() { return harness_.get(); }
  guint64 Stat(const char* name) { return StatOf(element_, name); }
  std::string Url(const char* scheme, const std::string& path = "/") {
    return std::string(scheme) + "://127.0.0.1:" + std::to_string(Stat("port")) + path;
  }
  /// Pushes a cloud of `columns` points on a line. Each point has 16 bytes, and the first point has
  /// x = `first`.
  GstFlowReturn PushCloud(float first, guint columns = 4, GstClockTime capture_time = 0) {
    std::vector<float> points;
    for (guint i = 0; i < columns; ++i)
      points.insert(points.end(), {first + static_cast<float>(i), 1, 0, 0.5F});
    GstBuffer* buffer = gst_buffer_new_memdup(points.data(), points.size() * sizeof(float));
    if (capture_time != 0) gst_lidar_buffer_set_capture_time(buffer, capture_time);
    return gst_harness_push(harness_.get(), buffer);
  }
  void SetCloudCaps(guint columns = 4) {
    const std::string caps =
        "application/x-pointcloud2,fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12\","
        "point-step=16,height=1,is-bigendian=false,is-dense=false,framerate=10/1,width=" +
        std::to_string(columns);
    gst_harness_set_src_caps_str(harness_.get(), caps.c_str());
  }

 private:
  GstElement* element_;
  Harness harness_;
};

/// Runs the default main context until `done` returns true. Returns false if that takes too long.
inline bool WaitUntil(const std::function<bool()>& done) {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (!done()) {
    if (std::chrono::steady_clock::now() > until) return false;
    if (!g_main_context_iteration(nullptr, FALSE)) g_usleep(500);
  }
  return true;
}

/// Accepts any certificate, because the certificates of tests are self-signed.
inline void AcceptCertificates(SoupMessage* message) {
  g_signal_connect(message, "accept-certificate",
                   G_CALLBACK(+[](SoupMessage*, GTlsCertificate*, int, gpointer) { return TRUE; }),
                   nullptr);
}

/// An answer to an HTTP request.
struct HttpAnswer {
  guint status = 0;
  std::string type;
  std::string policy;
  std::string allow;
  std::string challenge;
  std::string body;
};
inline HttpAnswer HttpGet(const std::string& url, const char* method = "GET",
                          const char* authorization = nullptr) {
  SoupSession* session = soup_session_new();
  SoupMessage* message = soup_message_new(method, url.c_str());
  if (authorization != nullptr)
    soup_message_headers_replace(soup_message_get_request_headers(message), "Authorization",
                                 authorization);
  AcceptCertificates(message);
  GError* error = nullptr;
  GBytes* body = nullptr;
  bool done = false;
  struct Call {
    GBytes** body;
    GError** error;
    bool* done;
  } call{&body, &error, &done};
  soup_session_send_and_read_async(
      session, message, G_PRIORITY_DEFAULT, nullptr,
      [](GObject* source, GAsyncResult* result, gpointer data) {
        auto* c = static_cast<Call*>(data);
        *c->body = soup_session_send_and_read_finish(SOUP_SESSION(source), result, c->error);
        *c->done = true;
      },
      &call);
  EXPECT_TRUE(WaitUntil([&] { return done; }));
  if (!done) soup_session_abort(session);  // otherwise a late answer would write to freed memory
  while (!done) g_main_context_iteration(nullptr, TRUE);
  HttpAnswer answer;
  answer.status = soup_message_get_status(message);
  auto* headers = soup_message_get_response_headers(message);
  const auto text = [](const char* t) { return std::string(t != nullptr ? t : ""); };
  answer.type = text(soup_message_headers_get_one(headers, "Content-Type"));
  answer.allow = text(soup_message_headers_get_one(headers, "Allow"));
  answer.challenge = text(soup_message_headers_get_one(headers, "WWW-Authenticate"));
  answer.policy = text(soup_message_headers_get_one(headers, "Content-Security-Policy"));
  if (body != nullptr) {
    gsize size = 0;
    const auto* data = static_cast<const char*>(g_bytes_get_data(body, &size));
    answer.body.assign(data, size);
    g_bytes_unref(body);
  }
  g_clear_error(&error);
  g_object_unref(message);
  g_object_unref(session);
  return answer;
}

/// A message that a client received on a channel.
struct Received {
  std::uint32_t subscription = 0;
  std::uint64_t unix_ns = 0;
  std::string payload;
};

/// A client that runs in the default main context. WaitUntil() runs this context.
class Peer {
 public:
  Peer(const std::string& url, std::vector<const char*> protocols, const char* origin = nullptr)
      : session_(soup_session_new()) {
    soup_session_add_feature_by_type(session_, SOUP_TYPE_WEBSOCKET_EXTENSION_MANAGER);
    protocols.push_back(nullptr);
    message_ = soup_message_new("GET", url.c_str());
    AcceptCertificates(message_);
    soup_session_websocket_connect_async(
        session_, message_, origin, const_cast<char**>(protocols.data()), G_PRIORITY_DEFAULT,
        nullptr,
        [](GObject* source, GAsyncResult* result, gpointer self) {
          static_cast<Peer*>(self)->Connected(SOUP_SESSION(source), result);
        },
        this);
    EXPECT_TRUE(WaitUntil([this] { return tried_; }));
  }
  explicit Peer(Sink* sink) : Peer(sink->Url("ws"), {"foxglove.sdk.v1"}) {}
  ~Peer() {
    if (connection_ != nullptr) {
      g_signal_handlers_disconnect_by_data(connection_, this);
      g_object_unref(connection_);
    }
    g_object_unref(message_);
    g_object_unref(session_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  bool connected() const { return connection_ != nullptr; }
  bool closed() const { return closed_; }
  gushort close_code() const { return soup_websocket_connection_get_close_code(connection_); }
  std::string certificate() const {
    gchar* name = nullptr;
    g_object_get(soup_message_get_tls_peer_certificate(message_), "subject-name", &name, nullptr);
    const gst::StringPtr owner(name);
    return name != nullptr ? name : "";
  }
  guint status() const { return soup_message_get_status(message_); }
  std::string protocol() const { return soup_websocket_connection_get_protocol(connection_); }
  bool compressed() const {
    return soup_websocket_connection_get_extensions(connection_) != nullptr;
  }

  void SendText(const std::string& text) {
    soup_websocket_connection_send_text(connection_, text.c_str());
  }
  /// Waits until the channel of `topic` is advertised. Returns the channel's id, or 0 if that takes
  /// too long.
  std::uint32_t Channel(const std::string& topic) {
    EXPECT_TRUE(WaitUntil([&] { return channels.count(topic) > 0; })) << topic;
    return channels.count(topic) > 0 ? channels[topic]["id"].get<std::uint32_t>() : 0;
  }
  /// Subscribes to `topic`, and returns once the server has handled the request.
  void Subscribe(const std::string& topic, std::uint32_t id) {
    const nlohmann::json item = {{"id", id}, {"channelId", Channel(topic)}};
    SendText(nlohmann::json{{"op", "subscribe"}, {"subscriptions", {item}}}.dump());
    Sync();
  }
  /// Sends an unknown request and waits for its answer. The server answers requests in order, so
  /// all earlier requests are handled then.
  void Sync() {
    const auto answers = [this] {
      return std::count(statuses.begin(), statuses.end(),
                        "This server does not offer that operation.");
    };
    const auto before = answers();
    SendText(R"({"op":"nothing"})");
    EXPECT_TRUE(WaitUntil([&] { return answers() > before; }));
  }
  Received Next() {
    EXPECT_TRUE(WaitUntil([this] { return !received.empty(); }));
    if (received.empty()) return {};
    Received first = received.front();
    received.pop_front();
    return first;
  }

  nlohmann::json server_info;
  std::map<std::string, nlohmann::json> channels;  // by topic
  std::vector<std::string> statuses;
  nlohmann::json recording;  // the last message about the recording
  std::deque<Received> received;

 private:
  void Connected(SoupSession* session, GAsyncResult* result) {
    tried_ = true;
    GError* error = nullptr;
    connection_ = soup_session_websocket_connect_finish(session, result, &error);
    g_clear_error(&error);
    if (connection_ == nullptr) return;
    soup_websocket_connection_set_max_incoming_payload_size(connection_, 0);
    g_signal_connect(connection_, "message", G_CALLBACK(OnMessage), this);
    g_signal_connect_swapped(connection_, "closed",
                             G_CALLBACK(+[](Peer* self) { self->closed_ = true; }), this);
  }
  static void OnMessage(SoupWebsocketConnection*, gint type, GBytes* bytes, Peer* self) {
    gsize size = 0;
    const auto* data = static_cast<const char*>(g_bytes_get_data(bytes, &size));
    const std::string text(data, size);
    if (type == SOUP_WEBSOCKET_DATA_TEXT) return self->OnText(nlohmann::json::parse(text));
    ByteReader in(reinterpret_cast<const std::uint8_t*>(data), size);
    EXPECT_EQ(in.U8(), 1);
    const std::uint32_t subscription = in.Le32();
    const std::uint64_t unix_ns = in.Le64();
    EXPECT_TRUE(in.ok());
    self->received.push_back({subscription, unix_ns, text.substr(in.position())});
  }
  void OnText(const nlohmann::json& text) {
    if (text["op"] == "serverInfo") server_info = text;
    if (text["op"] == "recording") recording = text;
    if (text["op"] == "status") statuses.push_back(text["message"]);
    if (text["op"] == "advertise")
      for (const auto& channel : text["channels"]) channels[channel["topic"]] = channel;
    if (text["op"] != "unadvertise") return;
    for (const auto& id : text["channelIds"])
      for (auto it = channels.begin(); it != channels.end();)
        it = it->second["id"] == id ? channels.erase(it) : std::next(it);
  }

  SoupSession* session_;
  SoupMessage* message_ = nullptr;
  SoupWebsocketConnection* connection_ = nullptr;
  bool tried_ = false;
  bool closed_ = false;
};

}  // namespace lidar::test
