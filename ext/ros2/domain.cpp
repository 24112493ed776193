// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ros2/domain.h"

#include <dds/dds.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <mutex>

namespace lidar::dds {
namespace {

struct Shared {
  dds_entity_t entity = 0;  // 0: other code of this process created it
  unsigned users = 0;
};

/// The mutex is locked while a domain is created or deleted, so that no participant joins a domain
/// that is being deleted.
std::mutex& Mutex() {
  static std::mutex mutex;
  return mutex;
}
std::map<std::uint32_t, Shared>& Domains() {
  static std::map<std::uint32_t, Shared> domains;
  return domains;
}

/// Returns the configuration of a domain. Datagrams of nearly 64 KiB halve the processor time for a
/// cloud. The largest message has eight million points of 32 bytes. Larger messages are refused,
/// whatever size a peer announces.
std::string Configuration() {
  std::string xml =
      "<General><FragmentSize>65000B</FragmentSize><MaxMessageSize>65500B</MaxMessageSize>"
      "</General><Internal><MaxSampleSize>" +
      std::to_string(Domain::kMaxMessage) +
      "B</MaxSampleSize><SocketReceiveBufferSize min=\"default\" max=\"" +
      std::to_string(Domain::kReceiveBuffer) + "B\"/></Internal>";
  const char* local = std::getenv("ROS_LOCALHOST_ONLY");
  if (local != nullptr && std::string(local) == "1")
    xml +=
        ",<General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
        "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto"
        "</ParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>";
  const char* user = std::getenv("CYCLONEDDS_URI");
  if (user != nullptr && *user != '\0') xml += std::string(",") + user;
  return xml;
}

}  // namespace

std::unique_ptr<Domain> Domain::Join(std::uint32_t id, std::string* why) {
  const std::lock_guard lock(Mutex());
  Shared& shared = Domains()[id];
  if (shared.users == 0) {
    const dds_entity_t made = dds_create_domain(id, Configuration().c_str());
    if (made < 0 && made != DDS_RETCODE_PRECONDITION_NOT_MET) {
      *why = std::string("cannot create the domain: ") + dds_strretcode(-made) +
             "; check the variable CYCLONEDDS_URI";
      return nullptr;
    }
    shared.entity = made > 0 ? made : 0;
  }
  ++shared.users;
  return std::unique_ptr<Domain>(new Domain(id));
}

Domain::~Domain() {
  const std::lock_guard lock(Mutex());
  Shared& shared = Domains()[id_];
  if (--shared.users == 0 && shared.entity > 0) dds_delete(shared.entity);
}

std::uint32_t Domain::GrantedReceiveBuffer() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return 0;
  int size = kReceiveBuffer;
  socklen_t length = sizeof size;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, length);
  if (getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, &length) != 0) size = 0;
  close(fd);
  return static_cast<std::uint32_t>(size / 2);  // the kernel doubles the size for its own data
}

}  // namespace lidar::dds
