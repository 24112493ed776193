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
  has_noticed_ = false;
  return true;
}

bool Certificate::Renew(std::string* why) { return Stamp() == stamp_ || Load(why); }

std::string Certificate::NoticeOfEnd(std::int64_t now_s) {
  using Date = std::unique_ptr<GDateTime, decltype(&g_date_time_unref)>;
  if (!certificate_ || has_noticed_) return "";
  const Date end(g_tls_certificate_get_not_valid_after(certificate_.get()), g_date_time_unref);
  if (!end || g_date_time_to_unix(end.get()) > now_s) return "";
  has_noticed_ = true;
  const Date utc(g_date_time_to_utc(end.get()), g_date_time_unref);
  const std::unique_ptr<gchar, decltype(&g_free)> text(
      g_date_time_format(utc.get(), "%Y-%m-%d %H:%M UTC"), g_free);
  return "The certificate " + file_ + " expired on " + text.get() + ": browsers refuse it.";
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
