// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/pcap_writer.h"

#include <pcap/pcap.h>

#include <cstdio>
#include <filesystem>
#include <vector>

#include "src/base/byte_writer.h"

namespace lidar::ouster {
namespace {

constexpr int kSnapLength = 262'144;
constexpr std::size_t kMaxPayload = 65'507;
constexpr std::uint32_t kSensor = 0x0a000002;    // 10.0.0.2
constexpr std::uint32_t kReceiver = 0x0a000001;  // 10.0.0.1

/// Removes the file if it is a regular file. A device or a pipe is left alone.
void RemoveFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
}

std::uint16_t HeaderChecksum(const std::uint8_t* header, std::size_t size) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < size; i += 2) sum += std::uint32_t{header[i]} << 8 | header[i + 1];
  while (sum > 0xffff) sum = (sum & 0xffff) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

std::vector<std::uint8_t> MakeFrame(std::uint16_t port, ByteView payload) {
  constexpr std::size_t kIpOffset = 14;
  constexpr std::size_t kIpSize = 20;
  std::vector<std::uint8_t> frame;
  ByteWriter w(&frame);
  w.Zeros(12);
  w.Be16(0x0800);
  w.Be16(0x4500);
  w.Be16(static_cast<std::uint16_t>(kIpSize + 8 + payload.size));
  w.Be32(0x00004000);  // do not fragment
  w.Be32(0x40110000);  // TTL 64, UDP
  w.Be32(kSensor);
  w.Be32(kReceiver);
  const std::uint16_t sum = HeaderChecksum(&frame[kIpOffset], kIpSize);
  frame[kIpOffset + 10] = static_cast<std::uint8_t>(sum >> 8);
  frame[kIpOffset + 11] = static_cast<std::uint8_t>(sum);
  w.Be16(port);
  w.Be16(port);
  w.Be16(static_cast<std::uint16_t>(8 + payload.size));
  w.Be16(0);  // no checksum
  w.Bytes(payload);
  return frame;
}

}  // namespace

std::unique_ptr<PcapWriter> PcapWriter::Open(const std::string& path, std::string* error) {
  pcap* handle =
      pcap_open_dead_with_tstamp_precision(DLT_EN10MB, kSnapLength, PCAP_TSTAMP_PRECISION_NANO);
  pcap_dumper* dumper = handle != nullptr ? pcap_dump_open(handle, path.c_str()) : nullptr;
  if (dumper != nullptr) return std::unique_ptr<PcapWriter>(new PcapWriter(path, handle, dumper));
  *error = handle != nullptr ? pcap_geterr(handle) : "no memory";
  if (handle != nullptr) pcap_close(handle);
  return nullptr;
}

PcapWriter::~PcapWriter() {
  if (dumper_ != nullptr) {
    pcap_dump_close(dumper_);
    RemoveFile(path_);
  }
  pcap_close(handle_);
}

bool PcapWriter::Close() {
  if (dumper_ == nullptr) return true;
  const bool whole = std::ferror(pcap_dump_file(dumper_)) == 0 && pcap_dump_flush(dumper_) == 0;
  pcap_dump_close(dumper_);
  dumper_ = nullptr;
  if (!whole) RemoveFile(path_);
  return whole;
}

bool PcapWriter::Write(Time captured, std::uint16_t port, ByteView payload) {
  if (payload.size > kMaxPayload) return false;
  const auto frame = MakeFrame(port, payload);
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  const std::int64_t ns = captured.time_since_epoch().count();
  pcap_pkthdr header{};
  header.ts.tv_sec = ns / kNsPerSecond;
  // The file was opened with nanosecond precision, so tv_usec holds nanoseconds.
  header.ts.tv_usec = ns % kNsPerSecond;
  header.caplen = header.len = static_cast<bpf_u_int32>(frame.size());
  // pcap_dump() has the signature of a pcap callback, so the file is its first argument.
  pcap_dump(reinterpret_cast<u_char*>(dumper_), &header, frame.data());
  return std::ferror(pcap_dump_file(dumper_)) == 0;
}

}  // namespace lidar::ouster
