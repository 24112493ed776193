// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends HTTP requests to a sensor, within bounds.
#pragma once
#include <atomic>
#include <memory>
#include <string>

namespace lidar::gst {

struct HttpResponse {
  bool ok = false;  // a complete 2xx answer arrived
  long status = 0;  // 0: no answer
  std::string body;
  std::string error;  // for a user, if not ok
};

/// Talks to its sensor only: no redirects, no proxies, and only http and https. Answers are bounded
/// in size and time. One thread may use it, except for Cancel().
class HttpClient {
 public:
  /// Returns nothing and sets `error` unless `host` is a name or address, with an optional port and
  /// scheme: "os1.local", "[fe80::1%25eth0]", "192.0.2.7:8080", "https://os1.local".
  static std::unique_ptr<HttpClient> Create(const std::string& host, std::string* error);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// `path` follows "/api/v1/".
  HttpResponse Get(const std::string& path) { return Perform(path, nullptr); }
  HttpResponse Post(const std::string& path, const std::string& json) {
    return Perform(path, &json);
  }
  std::string Escape(const std::string& text);
  /// Ends the request under way, and every later one, at once.
  void Cancel();

 private:
  explicit HttpClient(std::string base_url);
  HttpResponse Perform(const std::string& path, const std::string* json);
  int Transfer();

  std::string base_url_;
  void* curl_;   // CURL*
  void* multi_;  // CURLM*: its wait ends at Cancel()
  std::atomic<bool> cancelled_{false};
};

}  // namespace lidar::gst
