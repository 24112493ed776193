// SPDX-License-Identifier: LGPL-2.1-or-later
// Types for amounts and rates of data. The types prevent errors in units.
#pragma once
#include <cstdint>
#include <limits>

#include "src/base/time.h"

namespace lidar {

class DataSize {
 public:
  constexpr DataSize() = default;
  static constexpr DataSize Bytes(std::int64_t n) { return DataSize(n); }
  static constexpr DataSize Infinite() {
    return DataSize(std::numeric_limits<std::int64_t>::max());
  }
  constexpr std::int64_t bytes() const { return bytes_; }
  constexpr double bits() const { return static_cast<double>(bytes_) * 8.0; }

  constexpr DataSize& operator+=(DataSize o) {
    bytes_ += o.bytes_;
    return *this;
  }
  constexpr DataSize& operator-=(DataSize o) {
    bytes_ -= o.bytes_;
    return *this;
  }
  friend constexpr DataSize operator+(DataSize a, DataSize b) {
    return DataSize(a.bytes_ + b.bytes_);
  }
  friend constexpr DataSize operator-(DataSize a, DataSize b) {
    return DataSize(a.bytes_ - b.bytes_);
  }
  friend constexpr DataSize operator*(DataSize a, double f) {
    return DataSize(static_cast<std::int64_t>(static_cast<double>(a.bytes_) * f));
  }
  friend constexpr DataSize operator*(double f, DataSize a) { return a * f; }
  friend constexpr double operator/(DataSize a, DataSize b) {
    return static_cast<double>(a.bytes_) / static_cast<double>(b.bytes_);
  }
  friend constexpr bool operator==(DataSize a, DataSize b) { return a.bytes_ == b.bytes_; }
  friend constexpr bool operator!=(DataSize a, DataSize b) { return a.bytes_ != b.bytes_; }
  friend constexpr bool operator<(DataSize a, DataSize b) { return a.bytes_ < b.bytes_; }
  friend constexpr bool operator>(DataSize a, DataSize b) { return a.bytes_ > b.bytes_; }
  friend constexpr bool operator<=(DataSize a, DataSize b) { return a.bytes_ <= b.bytes_; }
  friend constexpr bool operator>=(DataSize a, DataSize b) { return a.bytes_ >= b.bytes_; }

 private:
  constexpr explicit DataSize(std::int64_t n) : bytes_(n) {}
  std::int64_t bytes_ = 0;
};

class DataRate {
 public:
  constexpr DataRate() = default;
  static constexpr DataRate BitsPerSecond(double r) { return DataRate(r); }
  static constexpr DataRate Infinite() { return DataRate(std::numeric_limits<double>::infinity()); }
  constexpr double bits_per_second() const { return bps_; }

  friend constexpr DataRate operator+(DataRate a, DataRate b) { return DataRate(a.bps_ + b.bps_); }
  friend constexpr DataRate operator-(DataRate a, DataRate b) { return DataRate(a.bps_ - b.bps_); }
  friend constexpr DataRate operator*(DataRate a, double f) { return DataRate(a.bps_ * f); }
  friend constexpr DataRate operator*(double f, DataRate a) { return a * f; }
  friend constexpr DataRate operator/(DataRate a, double f) { return DataRate(a.bps_ / f); }
  friend constexpr double operator/(DataRate a, DataRate b) { return a.bps_ / b.bps_; }
  friend constexpr bool operator==(DataRate a, DataRate b) { return !(a < b) && !(b < a); }
  friend constexpr bool operator!=(DataRate a, DataRate b) { return !(a == b); }
  friend constexpr bool operator<(DataRate a, DataRate b) { return a.bps_ < b.bps_; }
  friend constexpr bool operator>(DataRate a, DataRate b) { return a.bps_ > b.bps_; }
  friend constexpr bool operator<=(DataRate a, DataRate b) { return a.bps_ <= b.bps_; }
  friend constexpr bool operator>=(DataRate a, DataRate b) { return a.bps_ >= b.bps_; }

 private:
  constexpr explicit DataRate(double r) : bps_(r) {}
  double bps_ = 0;
};

constexpr DataRate operator/(DataSize size, Duration time) {
  return DataRate::BitsPerSecond(size.bits() / Seconds(time));
}
constexpr DataSize operator*(DataRate rate, Duration time) {
  return DataSize::Bytes(static_cast<std::int64_t>(rate.bits_per_second() * Seconds(time) / 8.0));
}
constexpr DataSize operator*(Duration time, DataRate rate) { return rate * time; }
/// Returns the time to send `size` at `rate`, or the largest Duration if the rate is zero.
constexpr Duration operator/(DataSize size, DataRate rate) {
  const double s = size.bits() / rate.bits_per_second();
  return s < 9e9 ? FromSeconds(s) : Duration::max();
}

}  // namespace lidar
