// SPDX-License-Identifier: LGPL-2.1-or-later
// Sequence numbers that wrap around (RFC 1982 serial arithmetic).
#pragma once
#include <cstdint>
#include <optional>
#include <type_traits>

namespace lidar {

/// Signed distance from `b` to `a`: positive if `a` is newer. Exact within half the range.
template <class U>
constexpr std::make_signed_t<U> SequenceDistance(U a, U b) {
  static_assert(std::is_unsigned_v<U>);
  return static_cast<std::make_signed_t<U>>(static_cast<U>(a - b));
}

/// Extends wrapping numbers to 64 bits: to the value that is nearest to the newest number so far.
template <class U>
class SequenceUnwrapper {
 public:
  /// Extends `n`, and keeps the result if it is the newest.
  std::int64_t Unwrap(U n) {
    const std::int64_t extended = Peek(n);
    if (!newest_ || extended > *newest_) newest_ = extended;
    return extended;
  }
  /// Extends `n` without a change of state.
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
