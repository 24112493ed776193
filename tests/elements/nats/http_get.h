// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends a GET request to the HTTP port of a program.
#pragma once
#include <gio/gio.h>

#include <array>
#include <optional>
#include <string>

namespace lidar::test {

/// Returns the body of the answer of `host`, such as "127.0.0.1:9464", or nothing if the status is
/// not 200.
inline std::optional<std::string> HttpGet(const std::string& host, const std::string& path) {
  GSocketClient* client = g_socket_client_new();
  g_socket_client_set_enable_proxy(client, FALSE);
  g_socket_client_set_timeout(client, 5);
  GSocketConnection* connection =
      g_socket_client_connect_to_host(client, host.c_str(), 80, nullptr, nullptr);
  g_object_unref(client);
  if (connection == nullptr) return std::nullopt;
  const std::string request =
      "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n";
  GOutputStream* out = g_io_stream_get_output_stream(G_IO_STREAM(connection));
  GInputStream* in = g_io_stream_get_input_stream(G_IO_STREAM(connection));
  std::string answer;
  std::array<char, 4096> piece{};
  gssize n = 0;
  if (g_output_stream_write_all(out, request.data(), request.size(), nullptr, nullptr, nullptr))
    while ((n = g_input_stream_read(in, piece.data(), piece.size(), nullptr, nullptr)) > 0)
      answer.append(piece.data(), static_cast<std::size_t>(n));
  g_object_unref(connection);
  const std::size_t head = answer.find("\r\n\r\n");
  if (answer.rfind("HTTP/1.1 200", 0) != 0 || head == std::string::npos) return std::nullopt;
  return answer.substr(head + 4);
}

}  // namespace lidar::test
