// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends HTTP requests to a sensor, with bounded time and size.
#pragma once
#include <atomic>
#include <memory>
#include <string>

namespace lidar::gst {

struct HttpResponse {
  bool ok = false;  // a complete 2xx answer arrived
  long status = 0;  // 0 if no answer arrived
  std::string body;
  std::string error;  // an explanation for the user, if `ok` is false
};

/// A client that talks to its sensor only: it follows no redirects, uses no proxies, and accepts
/// only http and https. Answers are bounded in size and time. All methods except Cancel() must be
/// called by one thread.
class HttpClient {
 public:
  /// Creates a client for `host`, which is a name or an address with an optional port and scheme:
  /// "os1.local", "[fe80::1%25eth0]", "192.0.2.7:8080", "https://os1.local". For any other text,
  /// returns null and sets `error`.
  static std::unique_ptr<HttpClient> Create(const std::string& host, std::string* error);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// The path of the URL is "/api/v1/" followed by `path`.
  HttpResponse Get(const std::string& path) { return Perform(path, nullptr); }
  HttpResponse Post(const std::string& path, const std::string& json) {
    return Perform(path, &json);
  }
  std::string Escape(const std::string& text);
  /// Ends the running request and all later requests at once. Any thread may call it.
  void Cancel();

 private:
  explicit HttpClient(std::string base_url);
  HttpResponse Perform(const std::string& path, const std::string* json);
  int Transfer();

  std::string base_url_;
  void* curl_;   // CURL*
  void* multi_;  // CURLM*; Cancel() ends its wait
  std::atomic<bool> cancelled_{false};
};

}  // namespace lidar::gst
