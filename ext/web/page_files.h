// SPDX-License-Identifier: LGPL-2.1-or-later
// The page that is compiled into the plugin.
#pragma once
#include <libsoup/soup.h>

namespace lidar::web {

/// Answers with the file at `path`, which the peer chose. Returns false if there is no such file.
bool ServePageFile(SoupServerMessage* request, const char* path);

}  // namespace lidar::web
