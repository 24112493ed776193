// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/pcap_reader.h"

#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "src/ouster/clock_mapper.h"

namespace lidar::ouster {
namespace {

// The major version of classic pcap files. For pcapng files libpcap reports another version.
constexpr int kClassicVersion = 2;

/// libpcap's number for raw IP (DLT_RAW) differs from the number in the file (LINKTYPE_RAW).
LinkType FromDlt(int dlt) { return dlt == DLT_RAW ? LinkType::kRaw : static_cast<LinkType>(dlt); }

pcap* OpenFile(const std::string& path, std::string* error) {
  std::array<char, PCAP_ERRBUF_SIZE> message{};
  pcap* handle = pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO,
                                                         message.data());
  if (handle == nullptr) *error = message.data();
  return handle;
}

}  // namespace

void PcapReader::Close::operator()(pcap* p) const { pcap_close(p); }

PcapReader::PcapReader(std::string path, Handle handle)
    : path_(std::move(path)),
      handle_(std::move(handle)),
      link_(FromDlt(pcap_datalink(handle_.get()))) {}

std::unique_ptr<PcapReader> PcapReader::Open(const std::string& path, std::string* error) {
  Handle handle(OpenFile(path, error));
  if (!handle) return nullptr;
  const int dlt = pcap_datalink(handle.get());
  if (!IsKnown(FromDlt(dlt))) {
    const char* name = pcap_datalink_val_to_description(dlt);
    *error = "its frames are of link type " +
             (name != nullptr ? std::string(name) : std::to_string(dlt)) +
             ", not of Ethernet, Linux cooked, loopback or raw IP";
    return nullptr;
  }
  return std::unique_ptr<PcapReader>(new PcapReader(path, std::move(handle)));
}

std::optional<PcapReader::Captured> PcapReader::Next() {
  pcap_pkthdr* header = nullptr;
  const std::uint8_t* frame = nullptr;
  for (;;) {
    const int got = pcap_next_ex(handle_.get(), &header, &frame);
    if (got == PCAP_ERROR) error_ = pcap_geterr(handle_.get());
    if (got != 1) return std::nullopt;
    // A pcapng file has 64 bits for a time, in a unit of its own, so a damaged file may have times
    // that would overflow below.
    const auto latest = std::chrono::duration_cast<std::chrono::seconds>(kLatestTime).count();
    const auto seconds = std::clamp<std::int64_t>(header->ts.tv_sec, 0, latest);
    // The file was opened with nanosecond precision, so tv_usec holds nanoseconds.
    const Time time(std::chrono::seconds(seconds) + std::chrono::nanoseconds(header->ts.tv_usec));
    auto datagram = extractor_.Extract(link_, {frame, header->caplen}, time);
    if (datagram) return Captured{*std::move(datagram), time};
  }
}

bool PcapReader::Rewind() {
  Handle handle(OpenFile(path_, &error_));
  if (!handle) return false;
  handle_ = std::move(handle);
  extractor_ = UdpExtractor();
  return true;
}

std::optional<std::int64_t> PcapReader::Offset() const {
  if (pcap_major_version(handle_.get()) != kClassicVersion) return std::nullopt;
  const off_t offset = ftello(pcap_file(handle_.get()));
  if (offset < 0) return std::nullopt;
  return offset;
}

bool PcapReader::GoTo(std::int64_t offset) {
  extractor_ = UdpExtractor();
  return fseeko(pcap_file(handle_.get()), offset, SEEK_SET) == 0;
}

}  // namespace lidar::ouster
