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

StreamFormat::Ptr FormatBook::Fetch(jsCtx* js, const std::string& stream,
                                    const std::string& subject) {
  natsMsg* raw = nullptr;
  jsErrCode code{};
  if (js_GetLastMsg(&raw, js, stream.c_str(), subject.c_str(), nullptr, &code) != NATS_OK)
    return nullptr;
  const MessagePtr message(raw);
  Note(subject, {natsMsg_GetData(raw), static_cast<std::size_t>(natsMsg_GetDataLength(raw))});
  return Find(subject.substr(subject.rfind('.') + 1));
}

StreamFormat::Ptr FormatBook::Find(const std::string& id) const {
  for (const StreamFormat::Ptr& format : formats_)
    if (format->id() == id) return format;
  return nullptr;
}

}  // namespace lidar::nats
