// SPDX-License-Identifier: LGPL-2.1-or-later
// The files of the page, which are compiled into the plugin.
#pragma once
#include <libsoup/soup.h>

namespace lidar::web {

/// Answers the request with the file at `path`, which the peer chose. Returns false if there is no
/// such file.
bool ServePageFile(SoupServerMessage* request, const char* path);

}  // namespace lidar::web
