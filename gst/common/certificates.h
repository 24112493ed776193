// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads certificates from PEM files: our own with its private key, and the peer's, which is the
// only certificate that is trusted.
#pragma once
#include <glib.h>

#include <string>

namespace lidar::gst {

struct Certificates {
  std::string own;   // the certificate and the private key in PEM
  std::string peer;  // result of CertificateIn()
};

/// Returns the first certificate in `pem`, without the lines before and after it, and without white
/// space.
inline std::string CertificateIn(const std::string& pem) {
  static const std::string kBegin = "-----BEGIN CERTIFICATE-----";
  const auto begin = pem.find(kBegin);
  const auto end = pem.find("-----END CERTIFICATE-----");
  std::string body;
  if (begin == std::string::npos || end == std::string::npos || end < begin) return body;
  for (std::size_t i = begin + kBegin.size(); i < end; ++i)
    if (!g_ascii_isspace(pem[i])) body += pem[i];
  return body;
}

inline bool ReadPem(const std::string& path, bool with_key, std::string* pem, std::string* error) {
  gchar* text = nullptr;
  GError* problem = nullptr;
  if (!g_file_get_contents(path.c_str(), &text, nullptr, &problem)) {
    *error = problem->message;
    g_error_free(problem);
    return false;
  }
  *pem = text;
  g_free(text);
  if (!CertificateIn(*pem).empty() && (!with_key || pem->find("PRIVATE KEY") != std::string::npos))
    return true;
  *error =
      path + " must be a PEM file with a certificate" + (with_key ? " and its private key" : "");
  return false;
}

/// Reads both certificates from files. If it fails, returns false and sets `error`, which never
/// contains the key.
inline bool ReadCertificates(const std::string& own, const std::string& peer,
                             Certificates* certificates, std::string* error) {
  std::string pem;
  if (!ReadPem(own, true, &certificates->own, error) || !ReadPem(peer, false, &pem, error))
    return false;
  certificates->peer = CertificateIn(pem);
  return true;
}

}  // namespace lidar::gst
