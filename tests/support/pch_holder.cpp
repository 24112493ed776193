// SPDX-License-Identifier: LGPL-2.1-or-later
// A program that is there for its precompiled header, which the test programs share.
int main() { return 0; }
