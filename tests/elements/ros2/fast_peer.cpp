// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/elements/ros2/fast_peer.h"

#include <fastcdr/Cdr.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <algorithm>
#include <cstring>
#include <functional>
#include <mutex>
#include <thread>
#include <type_traits>

#ifdef __SANITIZE_ADDRESS__
/// Switches off a check of AddressSanitizer, because Fast DDS 2.9.1 deletes an object with another
/// size than that of its allocation.
extern "C" const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }
#endif

namespace lidar::test {
namespace {

using namespace eprosima::fastdds::dds;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

/// Out writes a value, and In reads it. Both are called in the same way, so one function can
/// describe a message for both.
struct Out {
  Cdr& cdr;
  template <class T>
  void operator()(const T& value) {
    cdr << value;
  }
};
struct In {
  Cdr& cdr;
  template <class T>
  void operator()(T& value) {
    cdr >> value;
  }
};

template <class Io, class T, class Each>
void Sequence(Io& io, std::vector<T>& values, Each each) {
  auto count = static_cast<std::uint32_t>(values.size());
  io(count);
  values.resize(count);
  for (T& value : values) each(value);
}

template <class Io>
void Members(Io& io, PeerHeader& h) {
  io(h.sec);
  io(h.nanosec);
  io(h.frame_id);
}
template <class Io>
void Members(Io& io, PeerField& f) {
  io(f.name);
  io(f.offset);
  io(f.datatype);
  io(f.count);
}
template <class Io>
void Members(Io& io, PeerCloud& c) {
  Members(io, c.header);
  io(c.height);
  io(c.width);
  Sequence(io, c.fields, [&](PeerField& f) { Members(io, f); });
  io(c.is_bigendian);
  io(c.point_step);
  io(c.row_step);
  io(c.data);
  io(c.is_dense);
}
template <class Io>
void Members(Io& io, PeerImu& m) {
  Members(io, m.header);
  io(m.orientation);
  io(m.orientation_covariance);
  io(m.angular_velocity);
  io(m.angular_velocity_covariance);
  io(m.linear_acceleration);
  io(m.linear_acceleration_covariance);
}
template <class Io>
void Members(Io& io, PeerOdometry& m) {
  Members(io, m.header);
  io(m.child_frame_id);
  io(m.pose);
  io(m.pose_covariance);
  io(m.twist);
  io(m.twist_covariance);
}
template <class Io>
void Members(Io& io, PeerTransforms& m) {
  Sequence(io, m.transforms, [&](PeerTransform& t) {
    Members(io, t.header);
    io(t.child_frame_id);
    io(t.transform);
  });
}

constexpr std::size_t kGidSize = 16;

void Gid(In& io, std::vector<std::uint8_t>& gid) {
  gid.resize(kGidSize);
  for (std::uint8_t& byte : gid) io(byte);
}
void Members(In& io, PeerGraph& g) {
  Gid(io, g.participant);
  Sequence(io, g.nodes, [&](PeerGraphNode& n) {
    io(n.name_space);
    io(n.name);
    Sequence(io, n.readers, [&](auto& gid) { Gid(io, gid); });
    Sequence(io, n.writers, [&](auto& gid) { Gid(io, gid); });
  });
}

std::size_t SizeOf(const PeerCloud& c) { return 4096 + c.data.size(); }
std::size_t SizeOf(const PeerBytes& b) { return b.bytes.size(); }
template <class Message>
std::size_t SizeOf(const Message&) {
  return 8192;
}

/// The type support of a message, without generated code.
template <class Message>
class PeerType : public TopicDataType {
 public:
  explicit PeerType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 8192;
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, SerializedPayload_t* payload) override {
    auto& message = *static_cast<Message*>(data);
    if constexpr (std::is_same_v<Message, PeerBytes>) {
      std::copy(message.bytes.begin(), message.bytes.end(), payload->data);
      payload->length = static_cast<std::uint32_t>(message.bytes.size());
      return true;
    } else if constexpr (std::is_same_v<Message, PeerGraph>) {
      return false;
    } else {
      FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->max_size);
      Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
      payload->encapsulation = CDR_LE;
      cdr.serialize_encapsulation();
      Out out{cdr};
      Members(out, message);
      payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
      return true;
    }
  }
  bool deserialize(SerializedPayload_t* payload, void* data) override {
    auto& message = *static_cast<Message*>(data);
    if constexpr (std::is_same_v<Message, PeerBytes>) {
      message.bytes.assign(payload->data, payload->data + payload->length);
      return true;
    } else {
      FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
      try {
        cdr.read_encapsulation();
        In in{cdr};
        Members(in, message);
      } catch (const eprosima::fastcdr::exception::Exception&) {
        return false;
      }
      return true;
    }
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(SizeOf(*static_cast<Message*>(data))); };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

std::vector<std::uint8_t> ToBytes(const eprosima::fastrtps::rtps::GUID_t& guid) {
  std::vector<std::uint8_t> bytes(guid.guidPrefix.value, guid.guidPrefix.value + 12);
  bytes.insert(bytes.end(), guid.entityId.value, guid.entityId.value + 4);
  return bytes;
}

template <class Octets>
std::string ToText(const Octets& octets) {
  return std::string(octets.begin(), octets.end());
}

}  // namespace

/// Stores the endpoints and participants that discovery finds.
class DiscoveryListener : public DomainParticipantListener {
 public:
  void on_publisher_discovery(DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& found) override {
    Note(found.info, found.info.m_qos.m_userData);
  }
  void on_subscriber_discovery(DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& found) override {
    Note(found.info, found.info.m_qos.m_userData);
  }
  void on_participant_discovery(
      DomainParticipant*, eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& found) override {
    const std::lock_guard lock(mutex);
    participants.push_back(ToText(found.info.m_userData));
  }

  std::mutex mutex;
  std::vector<PeerEndpoint> endpoints;
  std::vector<std::string> participants;

 private:
  template <class Info, class UserData>
  void Note(const Info& info, const UserData& user_data) {
    const std::lock_guard lock(mutex);
    endpoints.push_back({info.topicName().to_string(), info.typeName().to_string(),
                         ToText(user_data), ToBytes(info.guid())});
  }
};

DomainParticipantQos ParticipantQos() {
  DomainParticipantQos qos;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.emplace_back("127.0.0.1");
  udp->receiveBufferSize = udp->sendBufferSize = 4u << 20;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  return qos;
}

template <class EndpointQos>
void Apply(FastPeer::Qos wanted, EndpointQos* qos) {
  qos->reliability().kind =
      wanted == FastPeer::Qos::kBestEffort ? BEST_EFFORT_RELIABILITY_QOS : RELIABLE_RELIABILITY_QOS;
  qos->durability().kind = wanted == FastPeer::Qos::kReliableTransient
                               ? TRANSIENT_LOCAL_DURABILITY_QOS
                               : VOLATILE_DURABILITY_QOS;
  qos->history().kind = KEEP_LAST_HISTORY_QOS;
  qos->history().depth = 10;
  qos->endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
}

struct FastPeer::Impl {
  Topic* NewTopic(TypeSupport type, const std::string& topic) {
    type.register_type(participant);
    return participant->create_topic(topic, type.get_type_name(), TOPIC_QOS_DEFAULT);
  }

  DiscoveryListener listener;
  DomainParticipant* participant = nullptr;
  DataReader* reader = nullptr;
  DataWriter* writer = nullptr;
};

FastPeer::FastPeer(std::uint32_t domain) : impl_(std::make_unique<Impl>()) {
  // If two peers are in the same process, Fast DDS 2.9.1 may otherwise call a deleted reader.
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  impl_->participant = DomainParticipantFactory::get_instance()->create_participant(
      domain, ParticipantQos(), &impl_->listener, StatusMask::none());
}

FastPeer::~FastPeer() {
  impl_->participant->delete_contained_entities();
  DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

template <class Message>
void FastPeer::Subscribe(const std::string& topic, const std::string& type, Qos qos) {
  Topic* made = impl_->NewTopic(TypeSupport(new PeerType<Message>(type)), topic);
  DataReaderQos reader_qos;
  Apply(qos, &reader_qos);
  impl_->reader = impl_->participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)
                      ->create_datareader(made, reader_qos);
}

template <class Message>
void FastPeer::Advertise(const std::string& topic, const std::string& type, Qos qos) {
  Topic* made = impl_->NewTopic(TypeSupport(new PeerType<Message>(type)), topic);
  DataWriterQos writer_qos;
  Apply(qos, &writer_qos);
  writer_qos.publish_mode().kind = ASYNCHRONOUS_PUBLISH_MODE;
  impl_->writer = impl_->participant->create_publisher(PUBLISHER_QOS_DEFAULT)
                      ->create_datawriter(made, writer_qos);
}

bool FastPeer::WaitForMatch(std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (std::chrono::steady_clock::now() < end) {
    PublicationMatchedStatus publication;
    SubscriptionMatchedStatus subscription;
    if (impl_->writer != nullptr) impl_->writer->get_publication_matched_status(publication);
    if (impl_->reader != nullptr) impl_->reader->get_subscription_matched_status(subscription);
    if (publication.current_count + subscription.current_count > 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

template <class Message>
bool FastPeer::Publish(const Message& message) {
  Message copy = message;
  return impl_->writer->write(&copy);
}

template <class Message>
bool FastPeer::Take(Message* message, std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  SampleInfo info;
  while (std::chrono::steady_clock::now() < end) {
    if (impl_->reader->take_next_sample(message, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) return true;
    } else {
      impl_->reader->wait_for_unread_message({0, 20'000'000});
    }
  }
  return false;
}

std::vector<PeerEndpoint> FastPeer::endpoints() const {
  const std::lock_guard lock(impl_->listener.mutex);
  return impl_->listener.endpoints;
}

std::vector<std::string> FastPeer::participants() const {
  const std::lock_guard lock(impl_->listener.mutex);
  return impl_->listener.participants;
}

template void FastPeer::Subscribe<PeerCloud>(const std::string&, const std::string&, Qos);
template void FastPeer::Subscribe<PeerImu>(const std::string&, const std::string&, Qos);
template void FastPeer::Subscribe<PeerOdometry>(const std::string&, const std::string&, Qos);
template void FastPeer::Subscribe<PeerTransforms>(const std::string&, const std::string&, Qos);
template void FastPeer::Subscribe<PeerGraph>(const std::string&, const std::string&, Qos);
template void FastPeer::Subscribe<PeerBytes>(const std::string&, const std::string&, Qos);
template void FastPeer::Advertise<PeerCloud>(const std::string&, const std::string&, Qos);
template void FastPeer::Advertise<PeerImu>(const std::string&, const std::string&, Qos);
template void FastPeer::Advertise<PeerOdometry>(const std::string&, const std::string&, Qos);
template void FastPeer::Advertise<PeerTransforms>(const std::string&, const std::string&, Qos);
template void FastPeer::Advertise<PeerBytes>(const std::string&, const std::string&, Qos);
template bool FastPeer::Publish<PeerCloud>(const PeerCloud&);
template bool FastPeer::Publish<PeerImu>(const PeerImu&);
template bool FastPeer::Publish<PeerOdometry>(const PeerOdometry&);
template bool FastPeer::Publish<PeerTransforms>(const PeerTransforms&);
template bool FastPeer::Publish<PeerBytes>(const PeerBytes&);
template bool FastPeer::Take<PeerCloud>(PeerCloud*, std::chrono::milliseconds);
template bool FastPeer::Take<PeerImu>(PeerImu*, std::chrono::milliseconds);
template bool FastPeer::Take<PeerOdometry>(PeerOdometry*, std::chrono::milliseconds);
template bool FastPeer::Take<PeerTransforms>(PeerTransforms*, std::chrono::milliseconds);
template bool FastPeer::Take<PeerGraph>(PeerGraph*, std::chrono::milliseconds);
template bool FastPeer::Take<PeerBytes>(PeerBytes*, std::chrono::milliseconds);

}  // namespace lidar::test
