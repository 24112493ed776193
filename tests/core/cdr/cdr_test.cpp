// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include "src/cdr/cdr_reader.h"
#include "src/cdr/cdr_writer.h"
#include "tests/core/cdr/bytes.h"

namespace lidar::cdr {
namespace {

TEST(CdrWriter, AlignsEachNumberToItsSizeFromBehindTheHeader) {
  Bytes bytes;
  CdrWriter w(&bytes);
  w.Text("ab");
  w.F64(1);
  w.U8(7);
  w.U32(0x01020304);
  const Bytes expected = {0, 1, 0, 0,                        // CDR_LE
                          3, 0, 0, 0, 'a', 'b', 0,    0,     // text, padding
                          0, 0, 0, 0, 0,   0,   0xF0, 0x3F,  // 1.0
                          7, 0, 0, 0, 4,   3,   2,    1};
  EXPECT_EQ(bytes, expected);
  for (const bool wide : {false, true}) {
    Bytes more;
    CdrWriter behind(&more);
    behind.U8(7);
    wide ? behind.U64(1) : behind.F32(1);
    const Bytes f32 = {0, 1, 0, 0, 7, 0, 0, 0, 0, 0, 0x80, 0x3F};
    const Bytes u64 = {0, 1, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(more, wide ? u64 : f32);
  }
}

TEST(CdrReader, ReadsWhatWasWritten) {
  Bytes bytes;
  CdrWriter w(&bytes);
  w.Bool(true);
  w.I32(-5);
  w.Text("frame");
  w.F64(-2.5);
  const Bytes three = {1, 2, 3};
  w.Octets(View(three));
  CdrReader r(View(bytes));
  EXPECT_TRUE(r.Bool());
  EXPECT_EQ(r.I32(), -5);
  EXPECT_EQ(r.Text(), "frame");
  EXPECT_EQ(r.F64(), -2.5);
  const ByteView octets = r.Octets();
  EXPECT_EQ(Bytes(octets.begin(), octets.end()), three);
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.remaining(), 0u);
}

TEST(CdrReader, ReadsBigEndian) {
  const Bytes bytes = {0, 0, 0, 0, 9, 0, 0, 0, 1, 2, 3, 4, 0, 0, 0, 2, 'x', 0};
  CdrReader r(View(bytes));
  EXPECT_EQ(r.U8(), 9);
  EXPECT_EQ(r.U32(), 0x01020304u);
  EXPECT_EQ(r.Text(), "x");
  EXPECT_TRUE(r.ok());
}

TEST(CdrReader, AlignsDoublesOfCdr2ToFourBytes) {
  const Bytes bytes = {0, 7, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F};
  CdrReader r(View(bytes));
  EXPECT_EQ(r.U32(), 1u);
  EXPECT_EQ(r.F64(), 1);
  EXPECT_TRUE(r.ok());
}

TEST(CdrReader, ReadsCdr2OfBigEndian) {
  const Bytes bytes = {0, 6, 0, 0, 0, 0, 0, 1, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0};
  CdrReader r(View(bytes));
  EXPECT_EQ(r.U32(), 1u);
  EXPECT_EQ(r.F64(), 1);
  EXPECT_TRUE(r.ok());
}

TEST(CdrReader, RefusesOtherEncodings) {
  for (const Bytes& bytes : {Bytes{}, Bytes{0, 1, 0}, Bytes{0, 2, 0, 0, 1, 2, 3, 4},
                             Bytes{0, 9, 0, 0, 1, 2, 3, 4}, Bytes{1, 1, 0, 0, 1, 2, 3, 4}}) {
    CdrReader r(View(bytes));
    EXPECT_EQ(r.U32(), 0u);
    EXPECT_FALSE(r.ok());
  }
}

TEST(CdrReader, NeverReadsPastTheEnd) {
  Bytes bytes = {0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0x3F, 'a', 'b', 'c'};
  CdrReader text(View(bytes));
  EXPECT_EQ(text.Text(), "");
  EXPECT_FALSE(text.ok());
  CdrReader octets(View(bytes));
  EXPECT_TRUE(octets.Octets().empty());
  EXPECT_FALSE(octets.ok());
  CdrReader sequence(View(bytes));
  EXPECT_EQ(sequence.Count(1), 0u);
  EXPECT_FALSE(sequence.ok());
  const Bytes cut = {0, 1, 0, 0, 1, 0};
  CdrReader padded(View(cut));
  padded.U8();
  EXPECT_EQ(padded.U32(), 0u);
  EXPECT_FALSE(padded.ok());
}

TEST(CdrReader, RefusesTextWithoutAnEnd) {
  const Bytes without_end = {0, 1, 0, 0, 2, 0, 0, 0, 'a', 'b'};
  CdrReader open(View(without_end));
  EXPECT_EQ(open.Text(), "");
  EXPECT_FALSE(open.ok());
  const Bytes of_no_size = {0, 1, 0, 0, 0, 0, 0, 0};
  CdrReader empty(View(of_no_size));
  EXPECT_EQ(empty.Text(), "");
  EXPECT_TRUE(empty.ok());
}

}  // namespace
}  // namespace lidar::cdr
