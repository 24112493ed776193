// SPDX-License-Identifier: LGPL-2.1-or-later
// Detects which links share a queue.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/bonding/packet_id.h"

namespace lidar::bonding {

/// Detects which links share a queue, by the spacing of arrivals. While a FIFO does not run empty,
/// two packets of a link arrive as far apart as all packets that entered the FIFO between them take
/// to leave. Packets of another link add to this time only if they pass through the same FIFO. The
/// spacing of arrivals is therefore regressed on the size that the other link sent in between, the
/// size that the link itself sent, and the spacing of departures, which stands for the flows of
/// others.
///
/// RFC 8382 compares delays instead. If copies of packets fill two queues alike, it takes the two
/// queues for one. Spacings distinguish them, because packets in one queue do not change the
/// spacing in the other. In addition, links that share a FIFO must see equally long queues at the
/// same time.
class SharedQueues {
 public:
  /// A packet that a report acknowledges.
  struct Arrival {
    Time sent{};
    std::uint32_t report_timestamp = 0;  // in 1/65536 s of the receiver's clock
    Duration age{0};                     // of the packet at report_timestamp
  };

  void OnSent(Time now, std::size_t link, DataSize size);
  /// Call it for each packet that a report acknowledges. A packet that was sent before the last one
  /// is ignored.
  void OnArrival(std::size_t link, const Arrival& arrival);
  /// Forgets the measurements of a link whose path may have changed.
  void Forget(std::size_t link);
  bool Shared(std::size_t a, std::size_t b) const { return pairs_[a][b].shared; }

 private:
  /// A linear regression by least squares, in which older samples have less weight.
  class Regression {
   public:
    static constexpr std::size_t kTerms = 4;
    using Terms = std::array<double, kTerms>;

    void Add(const Terms& x, double y);
    /// Multiplies the weight of all samples so far by `share`.
    void Fade(double share);
    /// Returns the slope of the last term divided by its standard error, or 0 if the samples do not
    /// determine the slope.
    double Significance() const;

   private:
    double count_ = 0;
    std::array<Terms, kTerms> xx_{};  // sums of products
    Terms xy_{};
    double yy_ = 0;
  };
  struct Pair {
    Regression spacing;  // of the first link's arrivals, by what the second link sent
    // For a pair of links, from packets that both links sent at the same time: the mean difference
    // between the queue delays of the two links, and the mean of the longer delay. Only
    // pairs_[a][b] with a < b has these means.
    double apart_ms = 0, longer_ms = 0;
    bool shared = false;
  };
  struct Sent {
    Time at{};
    double before_kb = 0;  // size of all earlier packets
  };
  struct Link {
    std::deque<Sent> sent;
    double sent_kb = 0;
    std::optional<Arrival> last;
    double delay_ms = 0;  // of the last packet, relative to the first packet
    double queue_ms = 0;  // queueing delay that the last packet met
    double base_ms = 0, old_base_ms = 0;
    Time base_since{};

    double SentUntil(Time t) const;
    void Measure(Time sent_at, double longer_ms);
  };

  void Compare(std::size_t a, std::size_t b);
  void Decide(std::size_t a, std::size_t b);

  std::array<Link, kMaxLinks> links_;
  std::array<std::array<Pair, kMaxLinks>, kMaxLinks> pairs_;
};

}  // namespace lidar::bonding
