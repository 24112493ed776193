// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/answers.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "gst/common/refs.h"

namespace lidar::nats {

std::optional<AnswerSubjects> AnswerSubjects::Make() {
  natsInbox* raw = nullptr;
  natsInbox_Create(&raw);
  const InboxPtr inbox(raw);
  if (!inbox) return std::nullopt;
  return AnswerSubjects(std::string(inbox.get()) + ".");
}

std::string_view AnswerSubjects::WordOf(natsMsg* answer) const {
  const std::string_view subject(natsMsg_GetSubject(answer));
  if (subject.substr(0, prefix_.size()) != prefix_) return {};
  return subject.substr(prefix_.size());
}

std::optional<std::uint64_t> ToNumber(std::string_view text) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end) return std::nullopt;
  return value;
}

namespace {

std::string_view TextOf(natsMsg* answer) {
  return {natsMsg_GetData(answer), static_cast<std::size_t>(natsMsg_GetDataLength(answer))};
}

}  // namespace

std::string ErrorOfAck(natsMsg* answer) {
  if (natsMsg_IsNoResponders(answer)) return "No JetStream stream keeps the subject";
  const std::string_view text = TextOf(answer);
  if (text.find("\"error\"") == text.npos && text.find("\"stream\"") != text.npos) return "";
  constexpr std::size_t kShownLetters = 200;
  const gst::StringPtr shown(
      g_utf8_make_valid(text.data(), static_cast<gssize>(std::min(text.size(), kShownLetters))));
  return std::string("JetStream refused a message: ") + shown.get();
}

bool IsTooLarge(natsMsg* answer) {
  const std::string code = "\"err_code\":" + std::to_string(JSStreamMessageExceedsMaximumErr);
  return TextOf(answer).find(code) != std::string_view::npos;
}

}  // namespace lidar::nats
