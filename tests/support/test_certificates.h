// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes self-signed certificates. Each certificate is in two files: one has its private key, too.
#pragma once
#include <glib.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "tests/support/files.h"

namespace lidar::test {

class TestCertificates {
 public:
  explicit TestCertificates(std::initializer_list<const char*> names) {
    for (const char* name : names) Make(name);
  }

  std::string Public(const std::string& name) const { return folder_ + "/" + name + ".crt"; }
  std::string WithKey(const std::string& name) const { return folder_ + "/" + name + ".pem"; }
  /// Returns the properties of a screamsink or screamsrc that uses the certificate `own` and trusts
  /// the certificate `peer`.
  std::string Trusting(const std::string& own, const std::string& peer) const {
    return " dtls-certificate=" + WithKey(own) + " dtls-peer-certificate=" + Public(peer) + " ";
  }

 private:
  void Make(const std::string& name) {
    const std::string key = folder_ + "/" + name + ".key",
                      command =
                          "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 "
                          "-nodes -days 2 -subj /CN=" +
                          name + " -keyout " + key + " -out " + Public(name);
    gchar *out = nullptr, *errors = nullptr;
    EXPECT_TRUE(g_spawn_command_line_sync(command.c_str(), &out, &errors, nullptr, nullptr));
    g_free(out);
    g_free(errors);
    const std::string certificate = ReadFile(Public(name));
    EXPECT_NE(certificate, "");
    std::ofstream(WithKey(name)) << certificate << ReadFile(key);
  }

  const TempFolder owner_;
  const std::string& folder_ = owner_.path();
};

}  // namespace lidar::test
