// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/shared_socket.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <mutex>

namespace lidar::gst {
namespace {

constexpr gsize kSmallestQueue = 1U << 20;  // bytes

GSocket* OpenSocket(const SocketPlace& place, GError** error) {
  UdpBind bind{place.address, place.port, G_SOCKET_FAMILY_INVALID, !place.group.empty()};
  if (!place.group.empty())
    bind.family =
        place.group.find(':') != std::string::npos ? G_SOCKET_FAMILY_IPV6 : G_SOCKET_FAMILY_IPV4;
  std::unique_ptr<GSocket, GObjectUnref> socket(OpenUdpSocket(bind, error));
  if (!socket) return nullptr;
  if (!place.group.empty() && !JoinMulticast(socket.get(), place.group, place.interface, error))
    return nullptr;
  net::AskForInfo(g_socket_get_fd(socket.get()));
  return socket.release();
}

}  // namespace

/// A socket that all elements of the process share if they use the same address, port and group.
class SharedSocket {
 public:
  /// Connects the reader to the socket of its place, and opens the socket if it is not open yet.
  static bool Attach(SocketReader* reader, GError** error) {
    std::lock_guard lock(RegistryMutex());
    auto& slot = Registry()[reader->place_];
    if (!slot) {
      GSocket* socket = OpenSocket(reader->place_, error);
      if (socket != nullptr) slot.reset(new SharedSocket(socket));
    }
    if (!slot) {
      Registry().erase(reader->place_);
      return false;
    }
    SharedSocket& shared = *slot;
    std::lock_guard lock_socket(shared.mutex_);
    if (shared.readers_.empty() || reader->queue_bytes_ > shared.granted_buffer_)
      shared.granted_buffer_ = net::SetReceiveBuffer(shared.fd(), reader->queue_bytes_);
    shared.readers_.push_back(reader);
    reader->granted_buffer_ = shared.granted_buffer_;
    reader->drops_before_ = shared.kernel_drops_;
    reader->socket_ = slot.get();
    return true;
  }

  static void Detach(SocketReader* reader) {
    std::lock_guard lock(RegistryMutex());
    SharedSocket& shared = *reader->socket_;
    std::unique_lock lock_socket(shared.mutex_);
    auto& readers = shared.readers_;
    readers.erase(std::find(readers.begin(), readers.end(), reader));
    const bool last = readers.empty();
    lock_socket.unlock();
    if (last) Registry().erase(reader->place_);
  }

  int fd() const { return g_socket_get_fd(socket_.get()); }

  /// Moves the reader's queue to its `taken_`, then receives from the socket into its `arrived_`.
  bool TakeFor(SocketReader* reader) {
    std::lock_guard lock(mutex_);
    reader->taken_.swap(reader->queue_);
    reader->queued_bytes_ = 0;
    reader->queued_.Clear();
    const int n = reader->batch_.Receive(fd(), [&](const ReceivedDatagram& datagram) {
      reader->arrived_.push_back(datagram);
      for (SocketReader* other : readers_)
        if (other != reader) other->Enqueue(datagram);
    });
    kernel_drops_ = std::max<guint64>(kernel_drops_, reader->batch_.kernel_drops());
    reader->kernel_drops_ = kernel_drops_ - reader->drops_before_;
    reader->queue_drops_ = reader->queue_overflows_;
    return n >= 0;
  }

 private:
  explicit SharedSocket(GSocket* socket) : socket_(socket) {}

  using Sockets = std::map<SocketPlace, std::unique_ptr<SharedSocket>>;
  static Sockets& Registry() {
    static Sockets sockets;
    return sockets;
  }
  static std::mutex& RegistryMutex() {
    static std::mutex mutex;
    return mutex;
  }

  const std::unique_ptr<GSocket, GObjectUnref> socket_;
  // Guards all members below and the readers' queues. It is held while the socket is read, so that
  // all readers get the datagrams in the same order.
  std::mutex mutex_;
  std::vector<SocketReader*> readers_;
  guint granted_buffer_ = 0;
  guint64 kernel_drops_ = 0;
};

std::unique_ptr<SocketReader> SocketReader::Open(const SocketPlace& place, guint queue_bytes,
                                                 GError** error) {
  std::unique_ptr<SocketReader> reader(new SocketReader(place, queue_bytes));
  if (!SharedSocket::Attach(reader.get(), error)) return nullptr;
  return reader;
}

SocketReader::~SocketReader() {
  if (socket_ != nullptr) SharedSocket::Detach(this);
}

int SocketReader::socket_fd() const { return socket_->fd(); }

void SocketReader::Enqueue(const ReceivedDatagram& datagram) {
  if (datagram.size == 0) return;
  // The cost includes the entry that holds the datagram, because the entry of a small datagram
  // takes more memory than its bytes.
  const gsize cost = sizeof(Copy) + datagram.size;
  if (queued_bytes_ + cost > std::max<gsize>(queue_bytes_, kSmallestQueue)) {
    ++queue_overflows_;
    return;
  }
  if (queue_.empty()) queued_.Wake();
  queued_bytes_ += cost;
  queue_.push_back({{datagram.data, datagram.data + datagram.size}, *datagram.from, datagram});
}

bool SocketReader::Receive(const std::function<void(const ReceivedDatagram&)>& consume) {
  taken_.clear();
  arrived_.clear();
  const bool ok = socket_->TakeFor(this);
  const int problem = errno;
  for (Copy& copy : taken_) {
    copy.datagram.data = copy.bytes.data();
    copy.datagram.from = &copy.from;
    consume(copy.datagram);
  }
  for (const ReceivedDatagram& datagram : arrived_) consume(datagram);
  errno = problem;
  return ok;
}

}  // namespace lidar::gst
