// SPDX-License-Identifier: LGPL-2.1-or-later
// Certificates that sign themselves, each in a file without its key and in one with it.
#pragma once
#include <glib.h>
#include <glib/gstdio.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace lidar::test {

class TestCertificates {
 public:
  explicit TestCertificates(std::initializer_list<const char*> names) {
    gchar* made = g_dir_make_tmp("lidar-certificates-XXXXXX", nullptr);
    folder_ = made;
    g_free(made);
    for (const char* name : names) Make(name);
  }
  ~TestCertificates() {
    for (const std::string& file : files_) g_unlink(file.c_str());
    g_rmdir(folder_.c_str());
  }
  TestCertificates(const TestCertificates&) = delete;
  TestCertificates& operator=(const TestCertificates&) = delete;

  std::string Public(const std::string& name) const { return folder_ + "/" + name + ".crt"; }
  std::string WithKey(const std::string& name) const { return folder_ + "/" + name + ".pem"; }
  /// Returns properties of screamsink and screamsrc.
  std::string Trusting(const std::string& own, const std::string& peer) const {
    return " dtls-certificate=" + WithKey(own) + " dtls-peer-certificate=" + Public(peer) + " ";
  }

 private:
  static std::string Read(const std::string& path) {
    gchar* text = nullptr;
    EXPECT_TRUE(g_file_get_contents(path.c_str(), &text, nullptr, nullptr)) << path;
    const std::string content = text != nullptr ? text : "";
    g_free(text);
    return content;
  }
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
    const std::string both = Read(Public(name)) + Read(key);
    g_file_set_contents(WithKey(name).c_str(), both.c_str(), -1, nullptr);
    for (const std::string& file : {key, Public(name), WithKey(name)}) files_.push_back(file);
  }

  std::string folder_;
  std::vector<std::string> files_;
};

}  // namespace lidar::test
