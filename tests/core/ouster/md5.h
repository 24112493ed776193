// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes MD5 in the text form of the digests that accompany the captures.
#pragma once
#include <glib.h>

#include <memory>
#include <string>

namespace lidar::test {

class Md5 {
 public:
  template <class T>
  void Add(T value) {
    g_checksum_update(sum_.get(), reinterpret_cast<const guchar*>(&value), sizeof value);
  }
  std::string Text() { return g_checksum_get_string(sum_.get()); }

 private:
  struct Free {
    void operator()(GChecksum* c) const { g_checksum_free(c); }
  };
  std::unique_ptr<GChecksum, Free> sum_{g_checksum_new(G_CHECKSUM_MD5)};
};

}  // namespace lidar::test
