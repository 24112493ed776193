// SPDX-License-Identifier: LGPL-2.1-or-later
// The server's certificate and key, which are read again when their files change.
#pragma once
#include <gio/gio.h>

#include <cstdint>
#include <string>

#include "ext/web/glib_ptr.h"

namespace lidar::web {

class Certificate {
 public:
  /// Both files are PEM files. `file` may also contain the chain of the certificate.
  Certificate(std::string file, std::string key_file)
      : file_(std::move(file)), key_file_(std::move(key_file)) {}

  bool is_wanted() const { return !file_.empty(); }
  /// Reads the files. Returns false and sets `why` if they are not a certificate and its key.
  bool Load(std::string* why);
  /// Reads the files again if they have changed. If the new files are bad, keeps the old
  /// certificate, returns false, and sets `why`. Does this only once for each change.
  bool Renew(std::string* why);
  GTlsCertificate* get() const { return certificate_.get(); }
  /// Returns a notice for the user, once, after the certificate has expired. Otherwise returns an
  /// empty text.
  std::string NoticeOfEnd(std::int64_t now_s);

 private:
  /// Returns a text that changes when a file changes.
  std::string Stamp() const;

  const std::string file_;
  const std::string key_file_;
  std::string stamp_;
  bool has_noticed_ = false;
  ObjectPtr<GTlsCertificate> certificate_;
};

}  // namespace lidar::web
