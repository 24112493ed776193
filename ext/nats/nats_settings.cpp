// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/nats_settings.h"

#include <utility>

#include "ext/nats/jetstream.h"
#include "ext/nats/message.h"

namespace lidar::gst {
namespace {

constexpr std::size_t kMaxComplaints = 8;  // per connection

}  // namespace

const std::array<Property<NatsSettings>, 8>& NatsRows() {
  using Connection = nats::ConnectionSettings;
  constexpr auto connection = &NatsSettings::connection;
  static const std::array<Property<NatsSettings>, 8> kRows = {{
      {"url", "URL of the server, or of several servers of a cluster, comma-separated",
       At<connection, &Connection::url>},
      {"subject", "Subject of the stream, such as fleet.robot7.lidar.front",
       &NatsSettings::subject},
      {"jetstream", "JetStream's stream, which the server keeps on its disk; NULL: none",
       &NatsSettings::stream},
      {"credentials-file", "File with user and key, as nsc writes it (.creds)",
       At<connection, &Connection::credentials_file>},
      {"token", "Token for the server; write-only", At<connection, &Connection::token>, 0, 0,
       G_PARAM_WRITABLE},
      {"tls-ca-file",
       "File with the authorities to trust (PEM); if set, the connection must be TLS",
       At<connection, &Connection::tls_ca_file>},
      {"tls-cert-file", "File with the client's certificate (PEM)",
       At<connection, &Connection::tls_cert_file>},
      {"tls-key-file", "File with the private key of tls-cert-file (PEM)",
       At<connection, &Connection::tls_key_file>},
  }};
  return kRows;
}

bool CheckNatsSettings(GstElement* element, NatsSettings* settings) {
  const StringPtr name(gst_element_get_name(element));
  settings->connection.name = name.get();
  const struct {
    const char* property;
    const std::string& value;
    std::string why;
  } checks[] = {{"subject", settings->subject, nats::CheckSubject(settings->subject)},
                {"jetstream", settings->stream, nats::CheckName(settings->stream)},
                {"queue-group", settings->queue_group, nats::CheckName(settings->queue_group)},
                {"durable", settings->durable, nats::CheckName(settings->durable)}};
  for (const auto& check : checks) {
    if (check.why.empty()) continue;
    GST_ELEMENT_ERROR(
        element, RESOURCE, SETTINGS,
        ("The %s \"%s\" is not valid: %s.", check.property, check.value.c_str(), check.why.c_str()),
        (nullptr));
    return false;
  }
  return true;
}

void ConnectionWatch::Silence() {
  const std::lock_guard lock(mutex_);
  silent_ = true;
}

void ConnectionWatch::Warn(const std::string& text) {
  std::unique_lock lock(mutex_);
  if (silent_) return;
  lock.unlock();
  GST_ELEMENT_WARNING(element_.get(), RESOURCE, FAILED, ("%s", text.c_str()), (nullptr));
}

void ConnectionWatch::PostRefused(const nats::ConnectionState& state) {
  const StringPtr words(g_utf8_make_valid(state.last_error.c_str(), -1));
  GST_ELEMENT_ERROR(element_.get(), RESOURCE, NOT_AUTHORIZED,
                    ("The NATS server refused the connection: %s.", words.get()), (nullptr));
}

void ConnectionWatch::Note(const nats::ConnectionState& state) {
  std::unique_lock lock(mutex_);
  if (silent_) return;
  const bool changed = std::exchange(connected_, state.connected()) != state.connected();
  if (state.connected()) closed_ = false;
  const bool closed = state.refused() && !std::exchange(closed_, true);
  const bool error = state.errors > std::exchange(errors_, state.errors);
  if (changed) complaints_.clear();
  // The server may complain about every message, so each text is posted only once per connection.
  const bool is_new =
      error && complaints_.size() < kMaxComplaints && complaints_.insert(state.last_error).second;
  lock.unlock();
  // The server's text may be invalid UTF-8, which must not be posted on the bus.
  const StringPtr words(g_utf8_make_valid(state.last_error.c_str(), -1));
  if (changed)
    gst_element_post_message(
        element_.get(),
        gst_message_new_element(GST_OBJECT(element_.get()),
                                gst_structure_new("nats-connection-changed", "connected",
                                                  G_TYPE_BOOLEAN, state.connected(), nullptr)));
  if (closed && keeps_trying_)
    Warn(std::string("The NATS server refused the connection: ") + words.get() +
         "; the element keeps trying.");
  else if (closed)
    PostRefused(state);
  else if (is_new)
    Warn(std::string("The NATS server reports an error: ") + words.get() + ".");
}

}  // namespace lidar::gst
