// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/srtp/copies.h"

#include <algorithm>

#include "gst/common/buffer_map.h"
#include "gst/scream/rtp_packet.h"

namespace lidar::gst {
namespace {

constexpr gsize kAll = G_MAXSIZE;  // size of a whole buffer

std::uint64_t KeyOf(const RtpHeader& header) {
  return std::uint64_t{header.ssrc} << 16 | header.seq;
}

}  // namespace

void SrtpCopies::OnArrival(GstBuffer* datagram) {
  GSocketAddress* from = SourceOf(datagram);
  if (several_ || from == nullptr || from == last_.get()) return;
  several_ = last_ != nullptr && !SameAddress(from, last_.get());
  last_ = RefAddress(from);
}

void SrtpCopies::OnPassed(GstBuffer* datagram, GstBuffer* decoded) {
  const auto header = several_ ? ReadRtpHeader(datagram) : std::nullopt;
  GSocketAddress* from = SourceOf(datagram);
  if (!header || from == nullptr) return;
  const BufferMap map(datagram, GST_MAP_READ);
  if (!map) return;
  const auto [at, fresh] = passed_.try_emplace(KeyOf(*header));
  if (!fresh) return;
  at->second.digest = DigestOf(map.view());
  at->second.decoded.reset(gst_buffer_ref(decoded));
  at->second.addresses.push_back(RefAddress(from));
  order_.push_back(at->first);
  bytes_ += gst_buffer_get_size(decoded);
  while (order_.size() > kMaxDatagrams || bytes_ > kMaxBytes) {
    const auto oldest = passed_.find(order_.front());
    bytes_ -= gst_buffer_get_size(oldest->second.decoded.get());
    passed_.erase(oldest);
    order_.pop_front();
  }
}

BufferPtr SrtpCopies::Take(GstBuffer* datagram) {
  const auto header = several_ ? ReadRtpHeader(datagram) : std::nullopt;
  const auto found = header ? passed_.find(KeyOf(*header)) : passed_.end();
  GSocketAddress* from = SourceOf(datagram);
  if (found == passed_.end() || from == nullptr) return nullptr;
  Passed& passed = found->second;
  const bool was_here =
      std::any_of(passed.addresses.begin(), passed.addresses.end(),
                  [from](const SocketAddressPtr& a) { return SameAddress(a.get(), from); });
  if (was_here || passed.addresses.size() >= kMaxAddresses) return nullptr;
  const BufferMap map(datagram, GST_MAP_READ);
  if (!map || DigestOf(map.view()) != passed.digest) return nullptr;
  passed.addresses.push_back(RefAddress(from));
  BufferPtr copy(gst_buffer_new());
  gst_buffer_copy_into(copy.get(), datagram, GST_BUFFER_COPY_METADATA, 0, kAll);
  gst_buffer_copy_into(copy.get(), passed.decoded.get(), GST_BUFFER_COPY_MEMORY, 0, kAll);
  return copy;
}

void SrtpCopies::Clear() { *this = SrtpCopies(); }

}  // namespace lidar::gst
