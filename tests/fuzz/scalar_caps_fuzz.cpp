// SPDX-License-Identifier: LGPL-2.1-or-later
// Parses caps in text form that any sender may have written.
#include "src/base/scalar_caps.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using lidar::ScalarCaps;
  const auto caps = ScalarCaps::Parse(lidar::fuzz::Text(data, size));
  if (!caps) return 0;
  FUZZ_CHECK(caps->fields.size() <= ScalarCaps::kMaxFields);
  const auto text = caps->ToText();
  // Characters that must be escaped make the new text longer, by a factor of at most 4. There is no
  // text if it would be too long.
  if (!text) {
    FUZZ_CHECK(4 * size > ScalarCaps::kMaxText);
    return 0;
  }
  FUZZ_CHECK(ScalarCaps::Parse(*text) == caps);
  return 0;
}
