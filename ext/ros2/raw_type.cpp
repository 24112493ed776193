// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ros2/raw_type.h"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_keyhash.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace lidar::dds {
namespace {

struct RawType : ddsi_sertype {
  std::size_t max_size = 0;  // largest size of a received message
};

std::size_t Cut(const ddsi_sertype* type, std::size_t size) {
  return std::min(size, static_cast<const RawType*>(type)->max_size);
}

struct RawData : ddsi_serdata {
  std::unique_ptr<std::uint8_t[]> bytes;  // padded to a multiple of 4, as the protocol requires
  std::size_t size = 0;
};

const RawData& Raw(const ddsi_serdata* data) { return *static_cast<const RawData*>(data); }

/// Creates data of `size` bytes. Returns null if memory is short.
RawData* NewRaw(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  std::unique_ptr<RawData> data(new (std::nothrow) RawData);
  if (!data) return nullptr;
  ddsi_serdata_init(data.get(), type, kind);
  const std::size_t padded = (size + 3) / 4 * 4;
  data->bytes.reset(new (std::nothrow) std::uint8_t[padded]);
  if (!data->bytes) return nullptr;
  std::fill(data->bytes.get() + size, data->bytes.get() + padded, std::uint8_t{0});
  data->size = size;
  return data.release();
}

/// Joins fragments, which may overlap. A gap between fragments would be a bug of the caller. It is
/// filled with zeros.
ddsi_serdata* FromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                            const nn_rdata* fragment, std::size_t whole) {
  const std::size_t size = Cut(type, whole);
  RawData* data = NewRaw(type, kind, size);
  if (data == nullptr) return nullptr;
  std::size_t filled = 0;
  for (; fragment != nullptr && filled < size; fragment = fragment->nextfrag) {
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end <= filled || fragment->min > filled) continue;
    const std::uint8_t* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(data->bytes.get() + filled, payload + (filled - fragment->min), end - filled);
    filled = end;
  }
  std::fill(data->bytes.get() + filled, data->bytes.get() + size, std::uint8_t{0});
  return data;
}

ddsi_serdata* FromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, std::size_t whole) {
  const std::size_t size = Cut(type, whole);
  RawData* data = NewRaw(type, kind, size);
  if (data == nullptr) return nullptr;
  std::size_t filled = 0;
  for (std::size_t i = 0; i < count && filled < size; ++i) {
    const std::size_t n = std::min<std::size_t>(pieces[i].iov_len, size - filled);
    std::memcpy(data->bytes.get() + filled, pieces[i].iov_base, n);
    filled += n;
  }
  return data;
}

/// Returns the key of a message, without its type. The topics have no keys, so all messages have
/// this key.
ddsi_serdata* Untyped(const ddsi_serdata* data) {
  RawData* key = NewRaw(data->type, SDK_KEY, 0);
  if (key != nullptr) key->type = nullptr;
  return key;
}

ddsi_serdata_ops DataOps() {
  ddsi_serdata_ops ops{};
  ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.get_size = [](const ddsi_serdata* d) { return static_cast<std::uint32_t>(Raw(d).size); };
  ops.from_ser = FromFragments;
  ops.from_ser_iov = FromPieces;
  ops.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) -> ddsi_serdata* {
    return NewRaw(type, SDK_KEY, 0);
  };
  // Samples are not supported, because this plugin only writes and reads bytes.
  ops.from_sample = [](const ddsi_sertype*, ddsi_serdata_kind, const void*) -> ddsi_serdata* {
    return nullptr;
  };
  ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return false;
  };
  ops.to_ser = [](const ddsi_serdata* d, std::size_t offset, std::size_t size, void* out) {
    std::memcpy(out, Raw(d).bytes.get() + offset, size);
  };
  ops.to_ser_ref = [](const ddsi_serdata* d, std::size_t offset, std::size_t size,
                      ddsrt_iovec_t* out) {
    out->iov_base = Raw(d).bytes.get() + offset;
    out->iov_len = size;
    return ddsi_serdata_ref(d);
  };
  ops.to_ser_unref = [](ddsi_serdata* d, const ddsrt_iovec_t*) { ddsi_serdata_unref(d); };
  ops.to_untyped = Untyped;
  ops.free = [](ddsi_serdata* d) { delete static_cast<RawData*>(d); };
  ops.print = [](const ddsi_sertype*, const ddsi_serdata*, char* out, std::size_t size) {
    if (size > 0) *out = '\0';
    return std::size_t{0};
  };
  ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* out, bool) {
    std::memset(out, 0, sizeof *out);
  };
  return ops;
}

ddsi_sertype_ops TypeOps() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete static_cast<RawType*>(type);
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  // All types count as equal here, because Cyclone compares the names of types itself.
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return ops;
}

}  // namespace

ddsi_sertype* NewRawType(const char* dds_name, std::size_t max_size) {
  static const ddsi_sertype_ops kTypeOps = TypeOps();
  static const ddsi_serdata_ops kDataOps = DataOps();
  auto* type = new RawType{};
  type->max_size = max_size;
  ddsi_sertype_init_flags(type, dds_name, &kTypeOps, &kDataOps, DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

void Release::operator()(ddsi_serdata* data) const { ddsi_serdata_unref(data); }

MessagePtr NewMessage(const ddsi_sertype* type, const std::vector<ByteView>& pieces) {
  std::size_t size = 0;
  for (const ByteView& piece : pieces) size += piece.size;
  RawData* data = NewRaw(type, SDK_DATA, size);
  if (data == nullptr) return nullptr;
  std::uint8_t* out = data->bytes.get();
  for (const ByteView& piece : pieces) out = std::copy(piece.begin(), piece.end(), out);
  return MessagePtr(data);
}

ByteView BytesOf(const ddsi_serdata* message) {
  return {Raw(message).bytes.get(), Raw(message).size};
}

}  // namespace lidar::dds
