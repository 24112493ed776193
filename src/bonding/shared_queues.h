// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds out which links pass one queue.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/bonding/packet_id.h"

namespace lidar::bonding {

/// While a FIFO does not run empty, two packets of a link arrive as far apart as all packets that
/// entered between them take to leave. Packets of another link add to that time only if they pass
/// the same FIFO. So the spacing of arrivals is regressed on what the other link sent in between,
/// what the link itself sent, and the spacing of departures, which stands for the flows of others.
/// RFC 8382 compares delays instead, so it would take two queues for one if copies fill both alike.
/// Spacings distinguish them, because packets in one queue do not change the spacing in the other.
/// In addition, links that share a FIFO must see equally long queues at the same time.
class SharedQueues {
 public:
  /// A packet of a report.
  struct Arrival {
    Time sent{};
    std::uint32_t report_timestamp = 0;  // in 1/65536 s of the receiver's clock
    Duration age{0};                     // of the packet at report_timestamp
  };

  void OnSent(Time now, std::size_t link, DataSize size);
  /// Packets that overtook each other are left out.
  void OnArrival(std::size_t link, const Arrival& arrival);
  /// Forgets a link, which may have another path.
  void Forget(std::size_t link);
  bool Shared(std::size_t a, std::size_t b) const { return pairs_[a][b].shared; }

 private:
  /// Least squares, with less weight for older samples.
  class Regression {
   public:
    static constexpr std::size_t kTerms = 4;
    using Terms = std::array<double, kTerms>;

    void Add(const Terms& x, double y);
    /// Reduces the weight of all samples so far to `share` of what it was.
    void Fade(double share);
    /// Returns the slope of the last term over its standard error, or 0 if the samples do not show
    /// the slope.
    double Significance() const;

   private:
    double count_ = 0;
    std::array<Terms, kTerms> xx_{};  // sums of products
    Terms xy_{};
    double yy_ = 0;
  };
  struct Pair {
    Regression spacing;  // of the first link's packets, by what the second sent
    // Mean difference of the two queues, and mean of the longer one, when packets left together.
    // Only pairs_[a][b] with a < b has these means.
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
    double delay_ms = 0;  // above the first packet's
    double queue_ms = 0;  // that the last packet met
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
