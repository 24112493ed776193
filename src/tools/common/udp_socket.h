// SPDX-License-Identifier: LGPL-2.1-or-later
// UDP sockets that write and read the ECN bits, and that return the kernel's arrival times.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "gst/net/datagram.h"
#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/tools/common/file_descriptor.h"

namespace lidar::tools {

using Address = net::NativeAddress;
std::string ToString(const Address& address);

struct HostPort {
  std::string host;
  std::string port;
};
/// Splits "HOST:PORT", "[IPV6]:PORT" or "PORT". In the last case, the host is `default_host`.
HostPort Split(const std::string& text, const std::string& default_host);
/// Resolves an address in one of the forms that Split() accepts. If that fails, throws
/// std::runtime_error with a text for the user.
Address ResolveAddress(const std::string& text, const std::string& default_host);

struct Datagram {
  ByteView payload;
  const Address* from = nullptr;
  std::uint8_t tos = 0;     // DSCP and ECN
  Duration kernel_time{0};  // time of reception, since the Unix epoch
};

class UdpSocket {
 public:
  /// Bind() and Connect() throw std::runtime_error if they fail.
  static UdpSocket Bind(const Address& local);
  static UdpSocket Connect(const Address& remote);

  /// Makes the socket send multicast from the interface called `interface`. Throws
  /// std::runtime_error if there is no such interface.
  void SendMulticastFrom(const std::string& interface);

  int fd() const { return fd_.get(); }
  int LocalPort() const;
  /// Passes each waiting datagram to `handler`.
  void ReceiveAll(const std::function<void(const Datagram&)>& handler);
  /// Sends a datagram to `to`, which is null on a connected socket. Returns false if the kernel
  /// refused to send it.
  bool Send(ByteView payload, std::uint8_t tos, const Address* to);

 private:
  explicit UdpSocket(int family);
  FileDescriptor fd_;
  Address peer_;  // the peer of a connected socket
};

}  // namespace lidar::tools
