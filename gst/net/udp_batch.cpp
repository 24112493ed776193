// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/net/udp_batch.h"

#include <poll.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace lidar::gst {
namespace {

bool IsIpv6(const NativeAddress& address) {
  if (address.storage.ss_family != AF_INET6) return false;
  sockaddr_in6 v6{};
  std::memcpy(&v6, &address.storage, sizeof v6);
  return !IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr);
}

template <class T>
T Payload(cmsghdr* c) {
  T value{};
  std::memcpy(&value, CMSG_DATA(c), sizeof value);
  return value;
}

void Enable(int fd, int level, int name) {
  const int on = 1;
  // An option of the other address family fails, and is not needed then.
  if (setsockopt(fd, level, name, &on, sizeof on) != 0) return;
}

}  // namespace

UdpBatchSender::UdpBatchSender() : messages_(kCapacity), headers_(kCapacity) {}

bool UdpBatchSender::Map(Message& m, GstBuffer* buffer) {
  m.memories = 0;
  m.merged = nullptr;
  const guint n = gst_buffer_n_memory(buffer);
  if (n > kMaxMemories) {
    if (!gst_buffer_map(buffer, &m.maps[0], GST_MAP_READ)) return false;
    m.merged = buffer;
    m.iov[0] = {m.maps[0].data, m.maps[0].size};
    m.memories = 1;
    return true;
  }
  for (guint i = 0; i < n; ++i) {
    if (!gst_memory_map(gst_buffer_peek_memory(buffer, i), &m.maps[i], GST_MAP_READ)) {
      for (guint k = 0; k < i; ++k) gst_memory_unmap(m.maps[k].memory, &m.maps[k]);
      m.memories = 0;
      return false;
    }
    m.iov[i] = {m.maps[i].data, m.maps[i].size};
    m.memories = i + 1;
  }
  return true;
}

bool UdpBatchSender::Add(GstBuffer* buffer, guint8 tos, const NativeAddress& to) {
  Message& m = messages_[count_];
  if (!Map(m, buffer)) return false;
  m.to = to;
  msghdr& h = headers_[count_].msg_hdr;
  h = {};
  h.msg_name = &m.to.storage;
  h.msg_namelen = m.to.length;
  h.msg_iov = m.iov.data();
  h.msg_iovlen = m.memories;
  h.msg_control = m.control.data();
  h.msg_controllen = m.control.size();
  m.control.fill(0);
  cmsghdr* c = CMSG_FIRSTHDR(&h);
  // A mapped address leaves through the IPv4 stack, which reads only its own option.
  const bool v6 = IsIpv6(to);
  c->cmsg_level = v6 ? IPPROTO_IPV6 : IPPROTO_IP;
  c->cmsg_type = v6 ? IPV6_TCLASS : IP_TOS;
  c->cmsg_len = CMSG_LEN(sizeof(int));
  const int value = tos;
  std::memcpy(CMSG_DATA(c), &value, sizeof value);
  ++count_;
  return true;
}

UdpBatchSender::Result UdpBatchSender::Flush(int fd, const WakeFd& wake) {
  Result result;
  std::size_t next = 0;
  while (next < count_) {
    const int sent = sendmmsg(fd, &headers_[next], static_cast<unsigned>(count_ - next),
                              MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) {
      for (int i = 0; i < sent; ++i) result.bytes += headers_[next++].msg_len;
      result.packets += static_cast<guint>(sent);
      continue;
    }
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (wake.Wait(fd, POLLOUT, -1) != WakeFd::Outcome::kWoken) continue;
      result.woken = true;
      result.errors += static_cast<guint>(count_ - next);
      break;
    }
    result.last_errno = errno;
    ++result.errors;  // this datagram cannot go; the next may
    ++next;
  }
  Clear();
  return result;
}

void UdpBatchSender::Clear() {
  for (std::size_t i = 0; i < count_; ++i) {
    Message& m = messages_[i];
    if (m.merged != nullptr) {
      gst_buffer_unmap(m.merged, &m.maps[0]);
    } else {
      for (guint k = 0; k < m.memories; ++k) gst_memory_unmap(m.maps[k].memory, &m.maps[k]);
    }
  }
  count_ = 0;
}

UdpBatchReceiver::UdpBatchReceiver()
    : arena_(kCapacity * kMaxDatagram), slots_(kCapacity), headers_(kCapacity) {}

void UdpBatchReceiver::Prepare(int fd) {
  Enable(fd, IPPROTO_IP, IP_RECVTOS);
  Enable(fd, IPPROTO_IPV6, IPV6_RECVTCLASS);
  Enable(fd, SOL_SOCKET, SO_TIMESTAMPNS);
  Enable(fd, SOL_SOCKET, SO_RXQ_OVFL);
}

int UdpBatchReceiver::Receive(int fd, const std::function<void(const ReceivedDatagram&)>& consume) {
  for (std::size_t i = 0; i < kCapacity; ++i) {
    Slot& slot = slots_[i];
    slot.iov = {&arena_[i * kMaxDatagram], kMaxDatagram};
    slot.from.storage = {};  // so that equal addresses compare equal
    headers_[i] = {};
    msghdr& h = headers_[i].msg_hdr;
    h.msg_name = &slot.from.storage;
    h.msg_namelen = sizeof slot.from.storage;
    h.msg_iov = &slot.iov;
    h.msg_iovlen = 1;
    h.msg_control = slot.control.data();
    h.msg_controllen = slot.control.size();
  }
  const int n = recvmmsg(fd, headers_.data(), kCapacity, MSG_DONTWAIT, nullptr);
  for (int i = 0; i < n; ++i) consume(Read(static_cast<std::size_t>(i)));
  return n;
}

ReceivedDatagram UdpBatchReceiver::Read(std::size_t i) {
  Slot& slot = slots_[i];
  msghdr& h = headers_[i].msg_hdr;
  slot.from.length = h.msg_namelen;
  ReceivedDatagram d;
  d.data = &arena_[i * kMaxDatagram];
  d.size = headers_[i].msg_len;
  d.from = &slot.from;
  for (cmsghdr* c = CMSG_FIRSTHDR(&h); c != nullptr; c = CMSG_NXTHDR(&h, c)) {
    if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_TOS) {
      d.tos = Payload<guint8>(c);  // one byte, unlike its IPv6 sister
    } else if (c->cmsg_level == IPPROTO_IPV6 && c->cmsg_type == IPV6_TCLASS) {
      d.tos = static_cast<guint8>(Payload<int>(c));
    } else if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_TIMESTAMPNS) {
      const auto t = Payload<timespec>(c);
      d.arrival =
          static_cast<GstClockTime>(t.tv_sec) * GST_SECOND + static_cast<GstClockTime>(t.tv_nsec);
    } else if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
      kernel_drops_ = Payload<guint32>(c);
    }
  }
  return d;
}

}  // namespace lidar::gst
