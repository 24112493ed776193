// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/http_client.h"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace lidar::gst {
namespace {

constexpr long kConnectTimeoutMs = 2000;
constexpr long kTimeoutMs = 5000;
constexpr std::size_t kMaxBody = 1U << 20;      // bytes
constexpr std::size_t kMaxHeaders = 64U << 10;  // bytes

struct Headers {
  curl_slist* list = curl_slist_append(nullptr, "Content-Type: application/json");
  ~Headers() { curl_slist_free_all(list); }
};

/// The part of an answer that has been received so far.
struct Answer {
  std::string body;
  std::size_t header_bytes = 0;
  bool too_large = false;
};

/// Appends received data to the answer. If it returns another size than it was given, curl ends the
/// request.
std::size_t TakeBody(char* data, std::size_t size, std::size_t n, void* to) {
  auto& answer = *static_cast<Answer*>(to);
  answer.too_large = answer.body.size() + size * n > kMaxBody;
  if (answer.too_large) return 0;
  answer.body.append(data, size * n);
  return size * n;
}

std::size_t TakeHeader(char*, std::size_t size, std::size_t n, void* to) {
  auto& answer = *static_cast<Answer*>(to);
  answer.header_bytes += size * n;
  answer.too_large = answer.header_bytes > kMaxHeaders;
  return answer.too_large ? 0 : size * n;
}

/// Limits the hosts that a request may reach, and the duration of a request.
void SetBounds(CURL* curl) {
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_NOPROXY, "*");
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  // The end of a request must not wait for name servers that do not answer.
  curl_easy_setopt(curl, CURLOPT_QUICK_EXIT, 1L);
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, kConnectTimeoutMs);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, kTimeoutMs);
}

bool IsHostCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_' ||
         c == ':' || c == '[' || c == ']' || c == '%';
}

/// Returns "scheme://host[:port]", or an empty text if `host` is invalid.
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
    *error = "hostname \"" + host + "\" is not a host name or an address";
    return nullptr;
  }
  return std::unique_ptr<HttpClient>(new HttpClient(std::move(base_url)));
}

HttpClient::HttpClient(std::string base_url)
    : base_url_(std::move(base_url)), curl_(curl_easy_init()), multi_(curl_multi_init()) {}

HttpClient::~HttpClient() {
  curl_easy_cleanup(curl_);
  curl_multi_cleanup(multi_);
}

void HttpClient::Cancel() {
  cancelled_ = true;
  if (multi_ != nullptr) curl_multi_wakeup(multi_);
}

/// Runs the prepared request until it ends or is cancelled, and returns a CURLcode.
/// curl_easy_perform() is not used, because it would check cancelled_ only once a second.
int HttpClient::Transfer() {
  constexpr int kLongestWaitMs = 500;
  CURLcode code = CURLE_ABORTED_BY_CALLBACK;
  if (curl_multi_add_handle(multi_, curl_) != CURLM_OK) return CURLE_FAILED_INIT;
  while (!cancelled_) {
    int running = 0;
    if (curl_multi_perform(multi_, &running) != CURLM_OK) {
      code = CURLE_FAILED_INIT;
      break;
    }
    if (running == 0) {
      int left = 0;
      const CURLMsg* message = curl_multi_info_read(multi_, &left);
      code = message != nullptr ? message->data.result : CURLE_FAILED_INIT;
      break;
    }
    curl_multi_poll(multi_, nullptr, 0, kLongestWaitMs, nullptr);
  }
  curl_multi_remove_handle(multi_, curl_);
  return code;
}

std::string HttpClient::Escape(const std::string& text) {
  char* escaped = curl_easy_escape(curl_, text.data(), static_cast<int>(text.size()));
  if (escaped == nullptr) return {};
  std::string result(escaped);
  curl_free(escaped);
  return result;
}

HttpResponse HttpClient::Perform(const std::string& path, const std::string* json) {
  HttpResponse response;
  if (curl_ == nullptr || multi_ == nullptr) {
    response.error =
        "too little memory, or too few file descriptors, to send a request to " + base_url_;
    return response;
  }
  const std::string url = base_url_ + "/api/v1/" + path;
  std::array<char, CURL_ERROR_SIZE> message{};
  const Headers headers;
  Answer answer;
  CURL* curl = curl_;
  curl_easy_reset(curl);  // keeps the connection open
  SetBounds(curl);
  curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, message.data());
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, TakeBody);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer);
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, TakeHeader);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, &answer);
  if (json != nullptr) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, json->c_str());
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(json->size()));
    curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers.list);
  }
  const auto code = static_cast<CURLcode>(Transfer());
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &response.status);
  response.body = std::move(answer.body);
  response.ok = code == CURLE_OK && response.status >= 200 && response.status < 300;
  if (answer.too_large)
    response.error = url + " answers with more data than any sensor";
  else if (code != CURLE_OK)
    response.error =
        base_url_ + ": " + (message[0] != '\0' ? message.data() : curl_easy_strerror(code));
  else if (!response.ok)
    response.error = url + " answers with HTTP status " + std::to_string(response.status);
  return response;
}

}  // namespace lidar::gst
