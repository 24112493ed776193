// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads MCAP files, with their summary and without it.
#include <memory>
#include <string>

#include "src/mcap/reader.h"
#include "tests/fuzz/fuzz.h"

namespace {

class View : public lidar::mcap::Input {
 public:
  View(const std::uint8_t* data, std::size_t size) : bytes_{data, size} {}
  std::uint64_t size() const override { return bytes_.size; }
  bool Read(std::uint64_t offset, std::size_t n, std::uint8_t* to) override {
    FUZZ_CHECK(offset <= bytes_.size && n <= bytes_.size - offset);
    if (n > 0) std::memcpy(to, bytes_.data + offset, n);
    return true;
  }

 private:
  lidar::ByteView bytes_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string why;
  const auto reader = lidar::mcap::Reader::Open(std::make_unique<View>(data, size), &why);
  FUZZ_CHECK((reader == nullptr) != why.empty());
  if (reader == nullptr) return 0;
  std::uint64_t middle = 0;
  for (int pass = 0; pass < 2; ++pass) {
    int count = 0;
    while (const auto message = reader->Next()) {
      FUZZ_CHECK(message->header.log_time >= middle);
      FUZZ_CHECK(reader->index().channels.count(message->header.channel_id) == 1);
      if (++count == 100'000) break;
    }
    middle = reader->index().start_time() / 2 + reader->index().end_time() / 2;
    reader->Seek(middle);
  }
  FUZZ_CHECK(reader->index().catalogue_size <= lidar::mcap::kMaxCatalogue);
  return 0;
}
