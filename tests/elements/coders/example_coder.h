// SPDX-License-Identifier: LGPL-2.1-or-later
// exampleenc and exampledec: the coder that docs/writing-an-encoder.md describes as the smallest
// example.
#pragma once
#include <gst/gst.h>

/// Registers exampleenc and exampledec, as the function plugin_init() of a plugin would.
gboolean example_coder_register(GstPlugin* plugin);
