// SPDX-License-Identifier: LGPL-2.1-or-later
// Sends a stream for hours through a link with random faults, and checks each minute what must hold
// at any time (for example, that the memory does not grow).
#include <gio/gio.h>

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/system/faults/ends.h"
#include "tests/system/faults/fault_link.h"

namespace {

using namespace lidar::test;  // NOLINT
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::uint64_t kMaxGrowth = std::uint64_t{8} << 20;  // [bytes] since the warm-up
constexpr unsigned kWarmUp = 5;                               // minutes
constexpr std::uint64_t kInFlight = 4;  // slices that may be on their way during a check

struct Options {
  unsigned minutes = 0;
  unsigned seed = 1;
  bool srtp = false;
  std::string link;   // path of lidar-link, which is needed for a trace
  std::string trace;  // file with the capacity of the link, or empty if it is unlimited
};

/// The program lidar-link, which runs between the sender and the link with faults.
class Bottleneck {
 public:
  Bottleneck(const Options& o, std::uint16_t to) : port_(o.trace.empty() ? to : FreePort()) {
    if (o.trace.empty()) return;
    const auto address = [](std::uint16_t port) { return "127.0.0.1:" + std::to_string(port); };
    process_ =
        g_subprocess_new(G_SUBPROCESS_FLAGS_NONE, nullptr, o.link.c_str(), "--quiet", "--listen",
                         address(port_).c_str(), "--forward", address(to).c_str(), "--trace",
                         o.trace.c_str(), "--rtt", "40", "--queue", "300", nullptr);
    if (process_ == nullptr) throw std::runtime_error("lidar-link cannot be started");
  }
  ~Bottleneck() {
    if (process_ == nullptr) return;
    g_subprocess_send_signal(process_, SIGTERM);
    g_subprocess_wait(process_, nullptr, nullptr);
    g_object_unref(process_);
  }
  Bottleneck(const Bottleneck&) = delete;
  Bottleneck& operator=(const Bottleneck&) = delete;
  std::uint16_t port() const { return port_; }

 private:
  std::uint16_t port_;
  GSubprocess* process_ = nullptr;
};

struct Fall {
  const char* name;
  Fault fault;
  seconds length;
};

Fall RandomFall(std::mt19937* random) {
  Fault f;
  switch ((*random)() % 10) {
    case 0:
      f.down = true;
      return {"down 1 s", f, seconds(1)};
    case 1:
      f.down = true;
      return {"down 10 s", f, seconds(10)};
    case 2:
      f.loss = 0.05;
      return {"loss 5 %", f, seconds(10)};
    case 3:
      f.loss = 0.5;
      return {"loss 50 %", f, seconds(5)};
    case 4:
      f.reorder_by = 20;
      return {"reordering", f, seconds(10)};
    case 5:
      f.duplicate = 0.3;
      return {"duplicates", f, seconds(10)};
    case 6:
      f.damage = 0.02;
      return {"damage 2 %", f, seconds(10)};
    case 7:
      f.feedback_loss = 1;
      return {"feedback dead", f, seconds(5)};
    case 8:
      f.garbage_ratio = 20;
      return {"garbage x20", f, seconds(5)};
    default:
      f.mtu = 700;
      return {"MTU 700", f, seconds(3)};
  }
}

class Soak {
 public:
  explicit Soak(const Options& options)
      : options_(options),
        random_(options.seed),
        port_(FreePort()),
        link_(port_, options.seed),
        bottleneck_(options, link_.port()) {
    StartReceiver();
    StartSender();
  }

  unsigned compared() const { return compared_; }

  /// Lets the stream run for a minute with random faults. Returns false if a check fails.
  bool Minute(unsigned minute) {
    const auto end = std::chrono::steady_clock::now() + seconds(60);
    std::string story;
    // The link cannot find slices in encrypted packets, so it has no counts to compare with.
    comparable_ = !options_.srtp;
    while (std::chrono::steady_clock::now() + seconds(16) < end) {
      std::this_thread::sleep_for(milliseconds(1'000 + random_() % 4'000));
      story += std::string(story.empty() ? "" : ", ") + Disturb();
    }
    link_.Set({});
    std::this_thread::sleep_until(end);
    return Check(minute, story);
  }

 private:
  void StartSender() {
    sender_ = std::make_unique<SendingEnd>(&sent_, bottleneck_.port(), Key());
    sender_->pipeline().SetState(GST_STATE_PLAYING);
  }
  std::string Key() const {
    return options_.srtp ? "srtp-key=" + std::string(60, '5') : std::string();
  }
  void StartReceiver() {
    receiver_ = std::make_unique<ReceivingEnd>(&sent_, port_, Key());
    receiver_->pipeline().SetState(GST_STATE_PLAYING);
  }

  std::string Disturb() {
    const auto what = random_() % 20;
    if (what == 0) {
      sender_.reset();
      StartSender();
      comparable_ = false;
      return "sender restarts";
    }
    if (what == 1) {
      foreign_ += receiver_->foreign();
      receiver_.reset();
      StartReceiver();
      // The counts of the new receiver begin at 0.
      last_ = {};
      comparable_ = false;
      return "receiver restarts";
    }
    if (what == 2) {
      link_.Rebind();
      comparable_ = false;
      return "address changes";
    }
    const Fall fall = RandomFall(&random_);
    // The counts can be compared only if the receiver counts all packets that passed the link.
    // Packets that arrive too late count as lost at the receiver, and the kernel may drop packets
    // during a flood.
    if (fall.fault.reorder_by > 0 || fall.fault.garbage_ratio > 0) comparable_ = false;
    link_.Set(fall.fault);
    std::this_thread::sleep_for(fall.length);
    link_.Set({});
    return fall.name;
  }

  /// Returns true if the receiver got as many slices as passed the link whole. Also returns true if
  /// this minute cannot be compared because slices may have been lost elsewhere.
  bool BooksAgree(const Accounts& a) {
    const std::uint64_t whole = link_.counts().slices_whole;
    const std::uint64_t passed = whole - last_whole_;
    const std::uint64_t received = a.received + a.mismatch - last_.received - last_.mismatch;
    last_whole_ = whole;
    if (!comparable_) return true;
    ++compared_;
    return received <= passed + kInFlight && passed <= received + kInFlight;
  }

  bool Check(unsigned minute, const std::string& story) {
    const auto recovery = receiver_->NextCloud(seconds(5));
    const Accounts a = receiver_->accounts();
    const bool agree = BooksAgree(a);
    const std::string error = sender_->pipeline().Error() + receiver_->pipeline().Error();
    const std::uint64_t memory = AllocatedBytes();
    if (minute <= kWarmUp) base_memory_ = std::max(base_memory_, memory);
    const bool grows = minute > kWarmUp && memory > base_memory_ + kMaxGrowth;
    const std::uint64_t foreign = foreign_ + receiver_->foreign();
    std::printf("%4u min  received %7" PRIu64 " lost %6" PRIu64 " damaged %5" PRIu64
                " mismatch %4" PRIu64 "  scans %6" PRIu64 " whole  %4.0f MB  [%s]\n",
                minute, a.received, a.lost, a.damaged, a.mismatch, a.complete,
                static_cast<double>(memory) / 1e6, story.c_str());
    bool good = true;
    const auto demand = [&](bool holds, const char* what) {
      if (!holds) std::printf("FAILED: %s\n", what);
      good = good && holds;
    };
    demand(error.empty(), ("no errors: " + error).c_str());
    demand(recovery != milliseconds::max(), "clouds come once the link is well");
    demand(foreign == 0, "nothing is shown that was not sent");
    demand(a.slices() >= last_.slices(), "accounts do not shrink");
    demand(agree, "the receiver counts what the link let through");
    demand(!grows, "memory does not grow");
    last_ = a;
    std::fflush(stdout);
    return good;
  }

  const Options options_;
  std::mt19937 random_;
  std::uint16_t port_;
  SentSlices sent_;
  FaultLink link_;
  Bottleneck bottleneck_;
  std::unique_ptr<SendingEnd> sender_;
  std::unique_ptr<ReceivingEnd> receiver_;
  std::uint64_t foreign_ = 0;
  std::uint64_t base_memory_ = 0;
  std::uint64_t last_whole_ = 0;
  bool comparable_ = true;  // whether the counts of receiver and link must agree
  unsigned compared_ = 0;   // number of minutes that were compared
  Accounts last_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 6) {
    std::fprintf(stderr, "usage: %s MINUTES SEED [srtp|plain [LIDAR_LINK TRACE]]\n", argv[0]);
    return 2;
  }
  gst_init(nullptr, nullptr);
  Options options;
  options.minutes = static_cast<unsigned>(std::atoi(argv[1]));
  options.seed = static_cast<unsigned>(std::atoi(argv[2]));
  options.srtp = argc > 3 && std::string(argv[3]) == "srtp";
  if (argc == 6) {
    options.link = argv[4];
    options.trace = argv[5];
  }
  bool good = true;
  Soak soak(options);
  for (unsigned minute = 1; minute <= options.minutes; ++minute) good &= soak.Minute(minute);
  std::printf("%s after %u minutes, seed %u; in %u minutes the books could be compared\n",
              good ? "passed" : "FAILED", options.minutes, options.seed, soak.compared());
  return good ? 0 : 1;
}
