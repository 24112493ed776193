// SPDX-License-Identifier: LGPL-2.1-or-later
// Sequence numbers that wrap around (RFC 1982 serial arithmetic).
#pragma once
#include <cstdint>
#include <optional>
#include <type_traits>

namespace lidar {

/// Returns the signed distance from `b` to `a`, which is positive if `a` is newer. The result is
/// correct if the distance is less than half of the range.
template <class U>
constexpr std::make_signed_t<U> SequenceDistance(U a, U b) {
  static_assert(std::is_unsigned_v<U>);
  return static_cast<std::make_signed_t<U>>(static_cast<U>(a - b));
}

/// Extends wrapping numbers to 64 bits. Each result is the value nearest to the newest number so
/// far.
template <class U>
class SequenceUnwrapper {
 public:
  /// Extends `n` and returns the result. Stores the result if it is the newest number.
  std::int64_t Unwrap(U n) {
    const std::int64_t extended = Peek(n);
    if (!newest_ || extended > *newest_) newest_ = extended;
    return extended;
  }
  /// Extends `n` and returns the result, without storing it.
  std::int64_t Peek(U n) const {
    if (!newest_) return n;
    return *newest_ + SequenceDistance(n, static_cast<U>(*newest_));
  }
  std::optional<std::int64_t> newest() const { return newest_; }
  void Reset() { newest_.reset(); }

 private:
  std::optional<std::int64_t> newest_;
};

}  // namespace lidar
