// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/nats/jetstream.h"

#include <algorithm>
#include <sstream>

#include "ext/nats/connection.h"

namespace lidar::nats {
namespace {

constexpr std::size_t kMaxName = 64;
constexpr std::int64_t kDuplicatesNs = 120'000'000'000;  // the server's default

std::vector<std::string> Words(const std::string& subject) {
  std::vector<std::string> words;
  std::istringstream in(subject);
  for (std::string word; std::getline(in, word, '.');) words.push_back(word);
  return words;
}

std::int64_t AgeNs(const StreamSettings& s) { return s.max_age.count(); }
std::int64_t SizeLimit(const StreamSettings& s) {
  return s.max_bytes == 0 ? -1 : static_cast<std::int64_t>(s.max_bytes);
}

std::string Explain(natsStatus status, jsErrCode code) {
  if (status == NATS_NO_RESPONDERS) return "the server has no JetStream";
  return ErrorText(status) + (code != 0 ? " (" + std::to_string(code) + ")" : "");
}

void SetLimits(const StreamSettings& settings, jsStreamConfig* config) {
  config->MaxAge = AgeNs(settings);
  config->MaxBytes = SizeLimit(settings);
  // The server refuses a stream whose window for duplicates is longer than max_age.
  config->Duplicates = config->MaxAge > 0 ? std::min(config->MaxAge, kDuplicatesNs) : kDuplicatesNs;
}

natsStatus Add(jsCtx* js, const StreamSettings& settings, const std::vector<std::string>& subjects,
               jsErrCode* code) {
  std::vector<const char*> names;
  for (const std::string& subject : subjects) names.push_back(subject.c_str());
  jsStreamConfig config;
  jsStreamConfig_Init(&config);
  config.Name = settings.name.c_str();
  config.Subjects = names.data();
  config.SubjectsLen = static_cast<int>(names.size());
  config.Storage = js_FileStorage;
  config.Discard = js_DiscardOld;
  config.Replicas = settings.replicas;
  SetLimits(settings, &config);
  return js_AddStream(nullptr, js, &config, nullptr, code);
}

/// Adds `subjects` to the existing stream and updates the stream's limits. Keeps subjects that
/// other sinks added.
natsStatus Update(jsCtx* js, const StreamSettings& settings,
                  const std::vector<std::string>& subjects, const jsStreamConfig& now,
                  jsErrCode* code) {
  std::vector<const char*> names(now.Subjects, now.Subjects + now.SubjectsLen);
  bool same_names = true;
  for (const std::string& subject : subjects) {
    if (std::any_of(names.begin(), names.end(),
                    [&](const char* name) { return Covers(name, subject); }))
      continue;
    // The subjects of a stream must not overlap, so the names that `subject` covers are removed.
    names.erase(std::remove_if(names.begin(), names.end(),
                               [&](const char* name) { return Covers(subject, name); }),
                names.end());
    names.push_back(subject.c_str());
    same_names = false;
  }
  const bool same_limits = now.MaxAge == AgeNs(settings) && now.MaxBytes == SizeLimit(settings);
  if (same_names && same_limits) return NATS_OK;
  jsStreamConfig config = now;
  config.Subjects = names.data();
  config.SubjectsLen = static_cast<int>(names.size());
  SetLimits(settings, &config);
  return js_UpdateStream(nullptr, js, &config, nullptr, code);
}

natsStatus AddOrUpdate(jsCtx* js, const StreamSettings& settings,
                       const std::vector<std::string>& subjects, jsErrCode* code) {
  *code = {};
  jsStreamInfo* raw = nullptr;
  const natsStatus status = js_GetStreamInfo(&raw, js, settings.name.c_str(), nullptr, code);
  const StreamInfoPtr info(raw);
  // A stream that keeps all subjects also stores this request. The stream answers with an
  // acknowledgement, which has no configuration.
  if (status == NATS_OK && info->Config == nullptr) return NATS_PROTOCOL_ERROR;
  if (status == NATS_OK) return Update(js, settings, subjects, *info->Config, code);
  return status == NATS_NOT_FOUND ? Add(js, settings, subjects, code) : status;
}

}  // namespace

JetStreamPtr OpenJetStream(natsConnection* connection) {
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = kRequestTimeoutMs;
  jsCtx* js = nullptr;
  natsConnection_JetStream(&js, connection, &options);
  return JetStreamPtr(js);
}

bool EnsureStream(jsCtx* js, const StreamSettings& settings,
                  const std::vector<std::string>& subjects, std::string* why) {
  jsErrCode code{};
  natsStatus status = AddOrUpdate(js, settings, subjects, &code);
  // Another sink has made the stream since this sink looked for it.
  if (code == JSStreamNameExistErr) status = AddOrUpdate(js, settings, subjects, &code);
  if (status != NATS_OK) *why = Explain(status, code);
  return status == NATS_OK;
}

bool Covers(const std::string& pattern, const std::string& subject) {
  const auto p = Words(pattern);
  const auto s = Words(subject);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i >= s.size()) return false;
    if (p[i] == ">") return true;
    if (s[i] == ">" || (p[i] != "*" && p[i] != s[i])) return false;
  }
  return p.size() == s.size();
}

std::string CheckName(const std::string& name) {
  if (name.size() > kMaxName) return "it has more than 64 characters";
  const auto is_good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  if (!std::all_of(name.begin(), name.end(), is_good))
    return "only letters, digits, - and _ are allowed";
  return "";
}

}  // namespace lidar::nats
