// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/format_book.h"

namespace lidar::nats {
namespace {

constexpr std::size_t kMaxFormats = 16;

}  // namespace

void FormatBook::Note(std::string_view subject, std::string_view text) {
  const std::string id(subject.substr(subject.rfind('.') + 1));
  if (Find(id)) return;
  const StreamFormat::Ptr format =
      IsFormatId(id) ? StreamFormat::FromText(std::string(text)) : nullptr;
  if (!format || format->id() != id) {
    ++damaged_;
    return;
  }
  formats_.push_front(format);
  if (formats_.size() > kMaxFormats) formats_.pop_back();
}

StreamFormat::Ptr FormatBook::Find(const std::string& id) const {
  for (const StreamFormat::Ptr& format : formats_)
    if (format->id() == id) return format;
  return nullptr;
}

}  // namespace lidar::nats
