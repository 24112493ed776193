// SPDX-License-Identifier: LGPL-2.1-or-later
// A library that is there for its precompiled header, which others share.
int precompiled_header_holder() { return 0; }
