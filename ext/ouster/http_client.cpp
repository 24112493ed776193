// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/http_client.h"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "src/ouster/metadata.h"

namespace lidar::gst {
namespace {

constexpr long kConnectTimeoutMs = 2000;
constexpr long kTimeoutMs = 5000;
constexpr curl_off_t kMaxAnswer = ouster::Metadata::kMaxJsonSize;

struct Headers {
  curl_slist* list = curl_slist_append(nullptr, "Content-Type: application/json");
  ~Headers() { curl_slist_free_all(list); }
};

std::size_t Append(char* data, std::size_t size, std::size_t n, void* to) {
  auto& body = *static_cast<std::string*>(to);
  // A length that is not announced is bounded here.
  if (body.size() + size * n > static_cast<std::size_t>(kMaxAnswer)) return 0;
  body.append(data, size * n);
  return size * n;
}

int Progress(void* cancelled, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return *static_cast<std::atomic<bool>*>(cancelled) ? 1 : 0;
}

bool IsHostCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_' ||
         c == ':' || c == '[' || c == ']' || c == '%';
}

/// "scheme://host[:port]", or empty for what is no host.
std::string BaseUrl(std::string host) {
  std::string scheme = "http://";
  for (const char* known : {"http://", "https://"}) {
    if (host.rfind(known, 0) != 0) continue;
    scheme = known;
    host.erase(0, scheme.size());
  }
  if (!host.empty() && host.back() == '/') host.pop_back();
  if (host.empty() || !std::all_of(host.begin(), host.end(), IsHostCharacter)) return {};
  const bool bare_ipv6 =
      std::count(host.begin(), host.end(), ':') > 1 && host.find('[') == std::string::npos;
  return scheme + (bare_ipv6 ? "[" + host + "]" : host);
}

}  // namespace

std::unique_ptr<HttpClient> HttpClient::Create(const std::string& host, std::string* error) {
  std::string base_url = BaseUrl(host);
  if (base_url.empty()) {
    *error = "hostname \"" + host + "\" is no name or address of a sensor";
    return nullptr;
  }
  return std::unique_ptr<HttpClient>(new HttpClient(std::move(base_url)));
}

HttpClient::HttpClient(std::string base_url)
    : base_url_(std::move(base_url)), curl_(curl_easy_init()) {}

HttpClient::~HttpClient() { curl_easy_cleanup(curl_); }

std::string HttpClient::Escape(const std::string& text) {
  char* escaped = curl_easy_escape(curl_, text.data(), static_cast<int>(text.size()));
  if (escaped == nullptr) return {};
  std::string result(escaped);
  curl_free(escaped);
  return result;
}

HttpResponse HttpClient::Perform(const std::string& path, const std::string* json) {
  HttpResponse response;
  const std::string url = base_url_ + "/api/v1/" + path;
  std::array<char, CURL_ERROR_SIZE> message{};
  const Headers headers;
  CURL* curl = curl_;
  curl_easy_reset(curl);  // keeps the connection
  curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_NOPROXY, "*");
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  // Name servers that do not answer must not hold up the end of a request.
  curl_easy_setopt(curl, CURLOPT_QUICK_EXIT, 1L);
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, kConnectTimeoutMs);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, kTimeoutMs);
  curl_easy_setopt(curl, CURLOPT_MAXFILESIZE_LARGE, kMaxAnswer);
  curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, message.data());
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, Append);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &response.body);
  curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, Progress);
  curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &cancelled_);
  if (json != nullptr) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, json->c_str());
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(json->size()));
    curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers.list);
  }
  const CURLcode code = curl_easy_perform(curl);
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &response.status);
  response.ok = code == CURLE_OK && response.status >= 200 && response.status < 300;
  if (code != CURLE_OK)
    response.error =
        base_url_ + ": " + (message[0] != '\0' ? message.data() : curl_easy_strerror(code));
  else if (!response.ok)
    response.error = url + " answers with status " + std::to_string(response.status);
  return response;
}

}  // namespace lidar::gst
