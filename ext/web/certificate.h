// SPDX-License-Identifier: LGPL-2.1-or-later
// The server's certificate and key, read again when their files are renewed.
#pragma once
#include <gio/gio.h>

#include <cstdint>
#include <string>

#include "ext/web/glib_ptr.h"

namespace lidar::web {

class Certificate {
 public:
  /// PEM files; the first may hold the chain.
  Certificate(std::string file, std::string key_file)
      : file_(std::move(file)), key_file_(std::move(key_file)) {}

  bool is_wanted() const { return !file_.empty(); }
  /// Returns false and sets `why` if the files do not hold a certificate and its key.
  bool Load(std::string* why);
  /// Reads the files if they have changed. If they are bad it keeps the old ones, returns false and
  /// sets `why`, once.
  bool Renew(std::string* why);
  GTlsCertificate* get() const { return certificate_.get(); }
  /// Returns a notice for the user once after the certificate has expired; else empty.
  std::string NoticeOfEnd(std::int64_t now_s);

 private:
  /// Identifies the versions of the files.
  std::string Stamp() const;

  const std::string file_;
  const std::string key_file_;
  std::string stamp_;
  bool has_noticed_ = false;
  ObjectPtr<GTlsCertificate> certificate_;
};

}  // namespace lidar::web
