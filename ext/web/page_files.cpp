// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/page_files.h"

#include <array>
#include <string>
#include <string_view>

#include "ext/web/glib_ptr.h"

namespace lidar::web {
namespace {

struct Type {
  std::string_view ending;
  const char* name;
};
constexpr std::array<Type, 5> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".wasm", "application/wasm"},
    {".txt", "text/plain; charset=utf-8"},
}};

const char* TypeOf(std::string_view path) {
  for (const Type& type : kTypes) {
    if (path.size() < type.ending.size()) continue;
    if (path.substr(path.size() - type.ending.size()) == type.ending) return type.name;
  }
  return "application/octet-stream";
}

/// The page may load files only from this server, and no other page may embed it. It may connect to
/// any WebSocket, because the user may add other servers.
constexpr const char* kPolicy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; worker-src 'self'; connect-src 'self' ws: wss:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace

bool ServePageFile(SoupServerMessage* request, const char* path) {
  const std::string_view name = path;
  const std::string file =
      "/gst-lidar/page" + (name == "/" ? std::string("/index.html") : std::string(name));
  const BytesPtr data(g_resources_lookup_data(file.c_str(), G_RESOURCE_LOOKUP_FLAGS_NONE, nullptr));
  if (!data) return false;
  auto* headers = soup_server_message_get_response_headers(request);
  soup_message_headers_replace(headers, "Content-Type", TypeOf(file));
  soup_message_headers_replace(headers, "Content-Security-Policy", kPolicy);
  soup_message_headers_replace(headers, "X-Content-Type-Options", "nosniff");
  soup_message_headers_replace(headers, "Referrer-Policy", "no-referrer");
  // Browsers must revalidate the page, because another version of the plugin has another page.
  soup_message_headers_replace(headers, "Cache-Control", "no-cache");
  soup_message_body_append_bytes(soup_server_message_get_response_body(request), data.get());
  soup_server_message_set_status(request, SOUP_STATUS_OK, nullptr);
  return true;
}

}  // namespace lidar::web
