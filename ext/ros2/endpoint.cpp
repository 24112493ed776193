// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ros2/endpoint.h"

#include <dds/dds.h>

#include <algorithm>

namespace lidar::dds {
namespace {

// The tags that identify the causes in the result of a waitset.
constexpr dds_attach_t kWake = 1;
constexpr dds_attach_t kMessages = 2;
constexpr dds_attach_t kStatus = 3;
constexpr dds_attach_t kPublications = 4;

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPtr = std::unique_ptr<dds_qos_t, DeleteQos>;

/// Returns true if `result` is not an error. Otherwise sets `why` and returns false.
bool Check(dds_return_t result, const char* what, std::string* why) {
  if (result >= 0) return true;
  *why = std::string(what) + ": " + dds_strretcode(-result);
  return false;
}

QosPtr MakeQos(bool reliable, bool transient, unsigned depth) {
  QosPtr qos(dds_create_qos());
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       Writer::kMaxBlockingNs);
  dds_qset_durability(qos.get(),
                      transient ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, static_cast<std::int32_t>(depth));
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &xcdr1);
  return qos;
}

QosPtr EndpointQos(const EndpointOptions& options) {
  QosPtr qos = MakeQos(options.reliable, options.transient, options.depth);
  if (!options.tells_type_hash) return qos;
  const std::string text = "typehash=" + std::string(cdr::InfoOf(options.type).hash) + ";";
  dds_qset_userdata(qos.get(), text.data(), text.size());
  return qos;
}

cdr::Guid GuidOf(dds_entity_t entity) {
  cdr::Guid guid{};
  dds_guid_t found{};
  if (dds_get_guid(entity, &found) == DDS_RETCODE_OK)
    std::copy(std::begin(found.v), std::end(found.v), guid.begin());
  return guid;
}

/// Returns the size of the largest message that is accepted. A domain that other code of the
/// process created may deliver larger messages. The limit is lower for messages that are not
/// clouds, because a hundred of them may wait. Such a message can still have thousands of
/// transforms.
std::size_t MaxSizeOf(cdr::RosType type) {
  constexpr std::size_t kMaxSmall = std::size_t{1} << 20;
  return cdr::IsCloud(type) ? Domain::kMaxMessage : kMaxSmall;
}

struct TopicName {
  const char* topic;
  const char* type;
};

dds_entity_t NewTopic(dds_entity_t participant, const TopicName& name, std::size_t max_size,
                      const ddsi_sertype** type) {
  ddsi_sertype* raw = NewRawType(name.type, max_size);
  const dds_entity_t topic =
      dds_create_topic_sertype(participant, name.topic, &raw, nullptr, nullptr, nullptr);
  *type = raw;
  return topic;
}

}  // namespace

Node::~Node() {
  if (participant_ > 0) dds_delete(participant_);
}

bool Node::Open(const EndpointOptions& options, std::string* why) {
  domain_ = Domain::Join(options.domain, why);
  if (!domain_) return false;
  const QosPtr qos(dds_create_qos());
  const std::string enclave = "enclave=/;";
  dds_qset_userdata(qos.get(), enclave.data(), enclave.size());
  participant_ = dds_create_participant(options.domain, qos.get(), nullptr);
  if (!Check(participant_, "cannot create a participant", why)) return false;
  const std::string type_name(cdr::InfoOf(options.type).dds_name);
  topic_ = NewTopic(participant_, {options.topic.c_str(), type_name.c_str()},
                    MaxSizeOf(options.type), &type_);
  return Check(topic_, "cannot create the topic", why);
}

bool Node::Announce(const EndpointOptions& options, bool writes, std::string* why) {
  const ddsi_sertype* type = nullptr;
  const dds_entity_t topic =
      NewTopic(participant_, {cdr::kGraphTopic, cdr::kGraphDdsName}, 0, &type);  // no reader
  if (!Check(topic, "cannot create the topic of the ROS graph", why)) return false;
  const QosPtr qos = MakeQos(true, true, 1);
  const dds_entity_t writer = dds_create_writer(participant_, topic, qos.get(), nullptr);
  if (!Check(writer, "cannot create a writer for the ROS graph", why)) return false;
  cdr::ParticipantEntities entities;
  entities.participant = GuidOf(participant_);
  entities.node = options.node;
  (writes ? entities.writers : entities.readers).push_back(GuidOf(endpoint_));
  const auto bytes = cdr::WriteParticipantEntities(entities, options.gid_size);
  MessagePtr message = NewMessage(type, {{bytes.data(), bytes.size()}});
  return Check(dds_writecdr(writer, message.release()), "cannot announce the node in the ROS graph",
               why);
}

std::unique_ptr<Reader> Reader::Create(const EndpointOptions& options, std::string* why) {
  std::unique_ptr<Reader> reader(new Reader);
  if (!reader->Open(options, why) || !reader->OpenReader(options, why) ||
      !reader->Announce(options, false, why))
    return nullptr;
  return reader;
}

bool Reader::OpenReader(const EndpointOptions& options, std::string* why) {
  topic_name_ = options.topic;
  type_name_ = std::string(cdr::InfoOf(options.type).dds_name);
  endpoint_ = dds_create_reader(participant_, topic_, EndpointQos(options).get(), nullptr);
  if (!Check(endpoint_, "cannot create a reader", why)) return false;
  dds_set_status_mask(endpoint_, DDS_REQUESTED_INCOMPATIBLE_QOS_STATUS);
  messages_ = dds_create_readcondition(endpoint_, DDS_ANY_STATE);
  guard_ = dds_create_guardcondition(participant_);
  waitset_ = dds_create_waitset(participant_);
  publications_ =
      dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  if (!Check(publications_, "cannot create a reader of publications", why)) return false;
  const dds_entity_t found = dds_create_readcondition(publications_, DDS_ANY_STATE);
  return Check(dds_waitset_attach(waitset_, guard_, kWake), "cannot attach to a waitset", why) &&
         Check(dds_waitset_attach(waitset_, messages_, kMessages), "cannot attach to a waitset",
               why) &&
         Check(dds_waitset_attach(waitset_, endpoint_, kStatus), "cannot attach to a waitset",
               why) &&
         Check(dds_waitset_attach(waitset_, found, kPublications), "cannot attach to a waitset",
               why);
}

Reader::Event Reader::Wait() {
  for (;;) {
    dds_attach_t causes[4] = {};
    const dds_return_t n = dds_waitset_wait(waitset_, causes, std::size(causes), DDS_INFINITY);
    if (n < 0) return Event::kFailed;
    const dds_attach_t* end = causes + std::min<std::ptrdiff_t>(n, std::size(causes));
    const auto due = [&](dds_attach_t cause) {
      return std::find<const dds_attach_t*>(causes, end, cause) != end;
    };
    if (due(kWake)) return Event::kWoken;
    if (due(kPublications) && FindsOtherType()) return Event::kOtherType;
    if (due(kStatus)) {
      dds_requested_incompatible_qos_status_t status{};
      dds_get_requested_incompatible_qos_status(endpoint_, &status);
      if (status.total_count_change > 0) return Event::kIncompatible;
    }
    if (due(kMessages)) return Event::kMessage;
  }
}

void Reader::Wake(bool on) { dds_set_guardcondition(guard_, on); }

/// Looks for new publishers of the topic that have another type. Returns true if there is one.
bool Reader::FindsOtherType() {
  void* sample = nullptr;
  dds_sample_info_t info{};
  while (dds_take(publications_, &sample, &info, 1, 1) > 0) {
    const auto* publication = static_cast<const dds_builtintopic_endpoint_t*>(sample);
    const bool other = info.valid_data && publication->topic_name == topic_name_ &&
                       publication->type_name != type_name_;
    if (other) other_type_ = publication->type_name;
    dds_return_loan(publications_, &sample, 1);
    sample = nullptr;
    if (other) return true;
  }
  return false;
}

MessagePtr Reader::Take() {
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info{};
  if (dds_takecdr(messages_, &data, 1, &info, DDS_ANY_STATE) <= 0) return nullptr;
  MessagePtr message(data);
  return info.valid_data ? std::move(message) : nullptr;
}

std::uint64_t Reader::lost() const {
  dds_sample_lost_status_t status{};
  dds_get_sample_lost_status(endpoint_, &status);
  return status.total_count;
}

unsigned Reader::publishers() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(endpoint_, &status);
  return status.current_count;
}

std::unique_ptr<Writer> Writer::Create(const EndpointOptions& options, std::string* why) {
  std::unique_ptr<Writer> writer(new Writer);
  if (!writer->Open(options, why)) return nullptr;
  writer->endpoint_ =
      dds_create_writer(writer->participant_, writer->topic_, EndpointQos(options).get(), nullptr);
  if (!Check(writer->endpoint_, "cannot create a writer", why) ||
      !writer->Announce(options, true, why))
    return nullptr;
  return writer;
}

Writer::Result Writer::Publish(const std::vector<ByteView>& pieces) {
  MessagePtr message = NewMessage(type_, pieces);
  if (!message) return Result::kFailed;
  const dds_return_t result = dds_writecdr(endpoint_, message.release());
  if (result == DDS_RETCODE_OK) return Result::kSent;
  return result == DDS_RETCODE_TIMEOUT ? Result::kTimeout : Result::kFailed;
}

unsigned Writer::subscribers() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(endpoint_, &status);
  return status.current_count;
}

Writer::Want Writer::TakeIncompatible() {
  dds_offered_incompatible_qos_status_t status{};
  dds_get_offered_incompatible_qos_status(endpoint_, &status);
  if (status.total_count_change == 0) return Want::kNothing;
  const bool reliability = status.last_policy_id == DDS_RELIABILITY_QOS_POLICY_ID;
  return reliability ? Want::kReliability : Want::kOther;
}

}  // namespace lidar::dds
