// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads messages that any client of a NATS server may publish. The input has the headers as lines
// "Name: value". After an empty line it has the payload, which is also read as caps.
#include <gst/gst.h>

#include <string>

#include "ext/nats/format_book.h"
#include "ext/nats/message.h"
#include "ext/nats/place_book.h"
#include "ext/nats/stream_format.h"
#include "gst/lidar/gstlidar.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace lidar::nats;

/// Sets the headers of `message` from the lines at the beginning of `text`. Returns the text after
/// the empty line.
std::string_view SetHeaders(natsMsg* message, std::string_view text) {
  while (!text.empty()) {
    const auto end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == text.npos ? std::string_view() : text.substr(end + 1);
    if (line.empty()) break;
    const auto colon = line.find(": ");
    if (colon == line.npos) continue;
    natsMsgHeader_Set(message, std::string(line.substr(0, colon)).c_str(),
                      std::string(line.substr(colon + 2)).c_str());
  }
  return text;
}

/// Checks that a message that was read can be written, and that reading the result gives the same
/// message.
void CheckComesBack(const ReadMessage& read) {
  const MessagePtr said = WriteMessage("a", nullptr, read.format_id, read.place, read.buffer.get());
  FUZZ_CHECK(said);
  const auto again = Read(said.get());
  FUZZ_CHECK(again && again->format_id == read.format_id && again->place.run == read.place.run &&
             again->place.number == read.place.number);
  FUZZ_CHECK(gst_lidar_buffer_get_capture_time(again->buffer.get()) ==
             gst_lidar_buffer_get_capture_time(read.buffer.get()));
  FUZZ_CHECK(GST_BUFFER_DURATION(again->buffer.get()) == GST_BUFFER_DURATION(read.buffer.get()));
  GstLidarSlice a{};
  GstLidarSlice b{};
  const bool has_slice = gst_lidar_buffer_get_slice(read.buffer.get(), &a);
  FUZZ_CHECK(has_slice == (gst_lidar_buffer_get_slice(again->buffer.get(), &b) != FALSE));
  FUZZ_CHECK(a.scan_id == b.scan_id && a.slice_index == b.slice_index);
}

void CheckFormat(std::string_view text) {
  const StreamFormat::Ptr format = StreamFormat::FromText(std::string(text));
  FormatBook book;
  book.Note("a.config." + std::string(text.substr(0, 16)), text);
  if (!format) return;
  FUZZ_CHECK(gst_caps_is_fixed(format->caps()) && IsFormatId(format->id()) && !format->Fits(0));
  book.Note("a.config." + format->id(), text);
  FUZZ_CHECK(book.Find(format->id()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const bool ready = [] {
    if (!gst_init_check(nullptr, nullptr, nullptr)) return false;
    gst_lidar_init();
    // Opens the library. A connection would do that, but this program makes none.
    return nats_Open(-1) == NATS_OK;
  }();
  FUZZ_CHECK(ready);
  const std::string_view text = lidar::fuzz::Text(bytes, size);
  const auto blank = text.find("\n\n");
  const std::string_view body = blank == text.npos ? std::string_view() : text.substr(blank + 2);
  natsMsg* raw = nullptr;
  FUZZ_CHECK(natsMsg_Create(&raw, "a", nullptr, body.data(), static_cast<int>(body.size())) ==
             NATS_OK);
  const MessagePtr message(raw);
  CheckFormat(SetHeaders(raw, text));
  const auto read = Read(raw);
  if (!read) return 0;
  PlaceBook book;
  FUZZ_CHECK(!book.Note(read->place).again && book.Note(read->place).again);
  CheckComesBack(*read);
  return 0;
}
