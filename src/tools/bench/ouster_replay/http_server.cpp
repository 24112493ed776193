// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/http_server.h"

#include <libsoup/soup.h>

#include <stdexcept>
#include <thread>
#include <utility>

namespace lidar::tools {
namespace {

HttpRequest RequestOf(SoupServerMessage* message, const char* path, GHashTable* query) {
  HttpRequest request;
  request.method = soup_server_message_get_method(message);
  request.path = path;
  const char* peer = soup_server_message_get_remote_host(message);
  request.peer = peer != nullptr ? peer : "";
  SoupMessageBody* body = soup_server_message_get_request_body(message);
  if (body->length > 0) request.body.assign(body->data, static_cast<std::size_t>(body->length));
  GHashTableIter iter;
  gpointer key = nullptr;
  gpointer value = nullptr;
  if (query == nullptr) return request;
  g_hash_table_iter_init(&iter, query);
  while (g_hash_table_iter_next(&iter, &key, &value)) {
    gchar* text = g_utf8_make_valid(static_cast<const char*>(value), -1);
    request.query[static_cast<const char*>(key)] = text;
    g_free(text);
  }
  return request;
}

void Send(SoupServerMessage* message, const HttpReply& reply) {
  soup_server_message_set_status(message, static_cast<guint>(reply.status), nullptr);
  if (!reply.location.empty())
    soup_message_headers_replace(soup_server_message_get_response_headers(message), "Location",
                                 reply.location.c_str());
  soup_server_message_set_response(message, "application/json", SOUP_MEMORY_COPY, reply.json.data(),
                                   reply.json.size());
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(const std::string& address, int port, Handler handler, Delay delay)
      : handler_(std::move(handler)),
        delay_(std::move(delay)),
        context_(g_main_context_new()),
        loop_(g_main_loop_new(context_, FALSE)) {
    // The server uses the default context of the thread that makes the server.
    g_main_context_push_thread_default(context_);
    server_ = soup_server_new(nullptr, nullptr);
    soup_server_add_handler(server_, nullptr, OnRequest, this, nullptr);
    GSocketAddress* local =
        g_inet_socket_address_new_from_string(address.c_str(), static_cast<guint>(port));
    const bool listens =
        local != nullptr &&
        soup_server_listen(server_, local, static_cast<SoupServerListenOptions>(0), nullptr) != 0;
    g_clear_object(&local);
    g_main_context_pop_thread_default(context_);
    if (!listens) {
      Free();
      throw std::runtime_error("cannot serve HTTP on " + address + ":" + std::to_string(port));
    }
    GSList* uris = soup_server_get_uris(server_);
    port_ = g_uri_get_port(static_cast<GUri*>(uris->data));
    g_slist_free_full(uris, reinterpret_cast<GDestroyNotify>(g_uri_unref));
    thread_ = std::thread([this] {
      g_main_context_push_thread_default(context_);
      g_main_loop_run(loop_);
      g_main_context_pop_thread_default(context_);
    });
  }
  ~Impl() {
    // Quits the loop by a callback of the loop, because a quit has no effect before the loop runs.
    g_main_context_invoke_full(
        context_, G_PRIORITY_DEFAULT,
        [](gpointer loop) -> gboolean {
          g_main_loop_quit(static_cast<GMainLoop*>(loop));
          return G_SOURCE_REMOVE;
        },
        loop_, nullptr);
    thread_.join();
    Free();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  int port() const { return port_; }

 private:
  /// A request whose answer is delayed.
  struct Waiting {
    Impl* server;
    SoupServerMessage* message;
    HttpRequest request;
  };

  void Free() {
    g_main_context_push_thread_default(context_);
    soup_server_disconnect(server_);
    g_object_unref(server_);
    g_main_context_pop_thread_default(context_);
    g_main_loop_unref(loop_);
    g_main_context_unref(context_);
  }

  static void OnRequest(SoupServer*, SoupServerMessage* message, const char* path,
                        GHashTable* query, gpointer self) {
    auto& server = *static_cast<Impl*>(self);
    HttpRequest request = RequestOf(message, path, query);
    const unsigned delay_ms = server.delay_ ? server.delay_(request) : 0;
    if (delay_ms == 0) return Send(message, server.handler_(request));
    soup_server_message_pause(message);
    GSource* timer = g_timeout_source_new(delay_ms);
    auto* waiting = new Waiting{&server, message, std::move(request)};
    g_object_ref(message);
    g_source_set_callback(timer, OnDelayed, waiting, [](gpointer data) {
      g_object_unref(static_cast<Waiting*>(data)->message);
      delete static_cast<Waiting*>(data);
    });
    g_source_attach(timer, server.context_);
    g_source_unref(timer);
  }

  static gboolean OnDelayed(gpointer data) {
    const auto& waiting = *static_cast<const Waiting*>(data);
    Send(waiting.message, waiting.server->handler_(waiting.request));
    soup_server_message_unpause(waiting.message);
    return G_SOURCE_REMOVE;
  }

  Handler handler_;
  Delay delay_;
  GMainContext* context_;
  GMainLoop* loop_;
  SoupServer* server_ = nullptr;
  int port_ = 0;
  std::thread thread_;
};

HttpServer::HttpServer(const std::string& address, int port, Handler handler, Delay delay)
    : impl_(std::make_unique<Impl>(address, port, std::move(handler), std::move(delay))) {}
HttpServer::~HttpServer() = default;
int HttpServer::port() const { return impl_->port(); }

}  // namespace lidar::tools
