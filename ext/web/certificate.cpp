// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/web/certificate.h"

#include <sys/stat.h>

namespace lidar::web {

bool Certificate::Load(std::string* why) {
  if (!g_tls_backend_supports_tls(g_tls_backend_get_default())) {
    *why = "GIO has no TLS here: install the package glib-networking";
    return false;
  }
  stamp_ = Stamp();
  GError* error = nullptr;
  ObjectPtr<GTlsCertificate> fresh(
      g_tls_certificate_new_from_files(file_.c_str(), key_file_.c_str(), &error));
  const GErrorPtr owner(error);
  if (!fresh) {
    *why = error->message;
    return false;
  }
  certificate_ = std::move(fresh);
  return true;
}

bool Certificate::Renew(std::string* why) { return Stamp() == stamp_ || Load(why); }

bool Certificate::IsOver() const {
  GDateTime* until =
      certificate_ ? g_tls_certificate_get_not_valid_after(certificate_.get()) : nullptr;
  if (until == nullptr) return false;
  const bool is_over = g_date_time_to_unix(until) < g_get_real_time() / G_USEC_PER_SEC;
  g_date_time_unref(until);
  return is_over;
}

std::string Certificate::Stamp() const {
  std::string stamp;
  for (const std::string& file : {file_, key_file_}) {
    struct stat s {};
    if (stat(file.c_str(), &s) != 0) continue;
    stamp += std::to_string(s.st_ino) + "/" + std::to_string(s.st_size) + "/" +
             std::to_string(s.st_mtim.tv_sec) + "." + std::to_string(s.st_mtim.tv_nsec) + " ";
  }
  return stamp;
}

}  // namespace lidar::web
