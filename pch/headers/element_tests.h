// SPDX-License-Identifier: LGPL-2.1-or-later
// What every test of elements includes, compiled once.
#include <gst/check/gstharness.h>
#include <gst/gst.h>
#include <gtest/gtest.h>
