// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/compression.h"

#include <lz4frame.h>
#include <zstd.h>

#include <memory>

namespace lidar::mcap {
namespace {

constexpr int kZstdLevel = 1;  // clouds gain little from higher levels

std::size_t CompressLz4(ByteView bytes, Bytes* out) {
  out->resize(LZ4F_compressFrameBound(bytes.size, nullptr));
  const std::size_t n =
      LZ4F_compressFrame(out->data(), out->size(), bytes.data, bytes.size, nullptr);
  return LZ4F_isError(n) != 0U ? 0 : n;
}

std::size_t CompressZstd(ByteView bytes, Bytes* out) {
  out->resize(ZSTD_compressBound(bytes.size));
  const std::size_t n = ZSTD_compress(out->data(), out->size(), bytes.data, bytes.size, kZstdLevel);
  return ZSTD_isError(n) != 0U ? 0 : n;
}

struct FreeLz4 {
  void operator()(LZ4F_dctx* p) const { LZ4F_freeDecompressionContext(p); }
};

bool DecompressLz4(ByteView bytes, Bytes* out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0U) return false;
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(raw);
  std::size_t read = 0;
  std::size_t written = 0;
  std::size_t wanted = 1;  // 0: the frame is complete
  while (wanted > 0 && read < bytes.size) {
    std::size_t in = bytes.size - read;
    std::size_t room = out->size() - written;
    wanted = LZ4F_decompress(raw, out->data() + written, &room, bytes.data + read, &in, nullptr);
    if (LZ4F_isError(wanted) != 0U || (room == 0 && in == 0)) return false;
    read += in;
    written += room;
  }
  return wanted == 0 && written == out->size() && read == bytes.size;
}

}  // namespace

std::string_view NameOf(Compression compression) {
  switch (compression) {
    case Compression::kNone:
      break;
    case Compression::kLz4:
      return "lz4";
    case Compression::kZstd:
      return "zstd";
  }
  return "";
}

bool Compress(Compression compression, ByteView bytes, Bytes* out) {
  if (compression == Compression::kNone || bytes.empty()) return false;
  const std::size_t n =
      compression == Compression::kLz4 ? CompressLz4(bytes, out) : CompressZstd(bytes, out);
  out->resize(n);
  return n > 0 && n < bytes.size - bytes.size / 20;
}

bool Decompress(std::string_view compression, ByteView bytes, std::size_t size, Bytes* out) {
  if (compression.empty()) {
    out->assign(bytes.begin(), bytes.end());
    return bytes.size == size;
  }
  out->resize(size);
  if (compression == NameOf(Compression::kLz4)) return DecompressLz4(bytes, out);
  if (compression != NameOf(Compression::kZstd)) return false;
  const std::size_t n = ZSTD_decompress(out->data(), size, bytes.data, bytes.size);
  return ZSTD_isError(n) == 0U && n == size;
}

}  // namespace lidar::mcap
