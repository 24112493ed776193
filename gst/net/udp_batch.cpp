// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/net/udp_batch.h"

#include <poll.h>

#include <cerrno>

namespace lidar::gst {
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

bool UdpBatchSender::Add(GstBuffer* buffer, guint8 tos, const NativeAddress& to,
                         unsigned interface) {
  Message& m = messages_[count_];
  if (!Map(m, buffer)) {
    Clear();  // the caller gives up the list with the other buffers
    return false;
  }
  m.to = to;
  msghdr& h = headers_[count_].msg_hdr;
  h = {};
  h.msg_name = &m.to.storage;
  h.msg_namelen = m.to.length;
  h.msg_iov = m.iov.data();
  h.msg_iovlen = m.memories;
  net::SetControl(tos, to, interface, &m.control, &h);
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
    ++result.errors;  // this datagram cannot be sent, but the next one may
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
  const net::DatagramInfo info = net::ReadInfo(&h);
  d.tos = info.tos;
  if (info.arrival) d.arrival = static_cast<GstClockTime>(info.arrival->count());
  kernel_drops_ = info.overflow.value_or(kernel_drops_);
  return d;
}

}  // namespace lidar::gst
