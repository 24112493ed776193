// SPDX-License-Identifier: LGPL-2.1-or-later
// Gives the settings of a program's NATS connection to its elements.
#pragma once
#include "ext/nats/connection.h"
#include "src/tools/common/elements.h"

namespace lidar::fleet {

/// Sets the connection properties of a natssink or natssrc.
inline void SetConnection(GstElement* element, const nats::ConnectionSettings& connection) {
  tools::SetText(element, "url", connection.url);
  tools::SetText(element, "credentials-file", connection.credentials_file);
  tools::SetText(element, "tls-ca-file", connection.tls_ca_file);
  tools::SetText(element, "tls-cert-file", connection.tls_cert_file);
  tools::SetText(element, "tls-key-file", connection.tls_key_file);
}

}  // namespace lidar::fleet
