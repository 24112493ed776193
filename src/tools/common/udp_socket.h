// SPDX-License-Identifier: LGPL-2.1-or-later
// UDP sockets that read and write the ECN bits and give the kernel's arrival times.
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
/// Splits "HOST:PORT", "[IPV6]:PORT" or "PORT" (then `default_host`).
HostPort Split(const std::string& text, const std::string& default_host);
/// Resolves a text that Split() accepts. Throws std::runtime_error with a text for the user.
Address ResolveAddress(const std::string& text, const std::string& default_host);

struct Datagram {
  ByteView payload;
  const Address* from = nullptr;
  std::uint8_t tos = 0;     // DSCP and ECN
  Duration kernel_time{0};  // reception, since the Unix epoch
};

class UdpSocket {
 public:
  /// Both throw std::runtime_error.
  static UdpSocket Bind(const Address& local);
  static UdpSocket Connect(const Address& remote);

  /// Sends multicast from the interface of that name; throws std::runtime_error if there is none.
  void SendMulticastFrom(const std::string& interface);

  int fd() const { return fd_.get(); }
  int LocalPort() const;
  /// Hands every waiting datagram to `handler`.
  void ReceiveAll(const std::function<void(const Datagram&)>& handler);
  /// `to` is null on a connected socket. Returns false if the kernel refused.
  bool Send(ByteView payload, std::uint8_t tos, const Address* to);

 private:
  explicit UdpSocket(int family);
  FileDescriptor fd_;
  Address peer_;  // of a connected socket
};

}  // namespace lidar::tools
