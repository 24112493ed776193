// SPDX-License-Identifier: LGPL-2.1-or-later
// What every test of the core includes, compiled once.
#include <gtest/gtest.h>
