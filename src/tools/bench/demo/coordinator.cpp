// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/coordinator.h"

#include <sys/stat.h>

#include <algorithm>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>

#include "src/tools/bench/demo/measurements.h"
#include "src/tools/bench/demo/report.h"
#include "src/tools/bench/demo/scan_folder.h"
#include "src/tools/bench/demo/slam.h"
#include "src/tools/bench/demo/stream_comparer.h"
#include "src/tools/bench/demo/summary.h"
#include "src/tools/bench/demo/verdict.h"
#include "src/tools/common/child_process.h"
#include "src/tools/common/event_loop.h"
#include "src/tools/common/output_file.h"
#include "src/tools/common/udp_socket.h"

namespace lidar::demo {
namespace {
using namespace std::chrono_literals;
using tools::ChildProcess;
using tools::Now;

// The limit is long, because comparisons of clouds may slow down the receiver at the end.
constexpr auto kPhaseLimit = 60s;
constexpr auto kTick = 100ms;
constexpr int kPoorStream = 3;  // exit code for a poor stream
constexpr auto kArrivalLimit = 3s;
constexpr int kLinesBetweenHeaders = 20;

class Coordinator {
 public:
  explicit Coordinator(const RunOptions& options);
  int Run();

 private:
  enum class Phase {
    kReceiver,
    kLink,
    kSender,
    kStreaming,
    kDraining,
    kArriving,  // the sender has ended, but data may still be on their way
    kReceiverStops,
    kLinkStops
  };

  std::unique_ptr<ChildProcess> Start(const std::vector<std::string>& command, const char* name,
                                      bool clouds);
  void Watch(ChildProcess* child, std::function<void(const nlohmann::json&)> handler);
  void StartLinks();
  bool LinksEnded() const;
  void OnSender(const nlohmann::json& record);
  void OnReceiver(const nlohmann::json& record);
  void OnLink(std::size_t index, const nlohmann::json& record);
  void PrintLive(const nlohmann::json& link);
  void Tick();
  void Enter(Phase phase);
  void CheckLimit();
  bool AllArrived() const;
  void TakeComparisons();
  int Report();

  Measurements m_;
  tools::EventLoop loop_;
  Ports ports_;
  std::unique_ptr<ChildProcess> receiver_;
  struct Link {
    std::unique_ptr<ChildProcess> process;
    bool listens = false;
  };
  std::vector<Link> links_;
  // The latest line of each link, or null before its first line.
  std::vector<nlohmann::json> latest_;
  std::unique_ptr<ChildProcess> sender_;
  std::unique_ptr<StreamComparer> comparer_;
  Phase phase_ = Phase::kReceiver;
  Time phase_since_;
  Time streaming_since_;
  SenderSample last_;
  double last_error_m_ = 0;
  std::uint64_t marked_ = 0;
  std::uint64_t dropped_ = 0;
  int lines_ = 0;
  std::string failure_;
};

/// Returns a port that is free at present. It is below the ports that the kernel assigns by itself.
int FreePort() {
  std::random_device random;
  std::uniform_int_distribution<int> ports(10000, 32767);
  for (int tries = 1;; ++tries) {
    const std::string address = "127.0.0.1:" + std::to_string(ports(random));
    try {
      return tools::UdpSocket::Bind(tools::ResolveAddress(address, "")).LocalPort();
    } catch (const std::exception&) {
      if (tries == 100) throw;
    }
  }
}

std::string Tail(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::string text;
  constexpr std::size_t kLines = 8;
  for (std::size_t i = lines.size() > kLines ? lines.size() - kLines : 0; i < lines.size(); ++i)
    text += "  " + lines[i] + '\n';
  return text;
}

Coordinator::Coordinator(const RunOptions& options) {
  m_.options = options;
  if (options.slam && !CanFollow())
    throw std::runtime_error(
        "--slam needs a build with lidarodometry (libeigen3-dev, robin-map-dev)");
  if (mkdir(options.output.c_str(), 0777) != 0 && errno != EEXIST)
    throw std::runtime_error("cannot make the folder " + options.output);
  RemoveReport(options.output);
  if (!options.scans.empty()) LinkScans(options.scans, options.output);
  for (std::size_t i = 0; options.drive && i < options.links; ++i)
    tools::WriteFile(LinkFile(options, "trace.txt", i), DriveTraceOf(options, i));
  ports_.receiver = FreePort();
  for (std::size_t i = 0; i < options.links; ++i) ports_.links.push_back(FreePort());
}

std::unique_ptr<ChildProcess> Coordinator::Start(const std::vector<std::string>& command,
                                                 const char* name, bool clouds) {
  const std::string log = m_.options.output + "/" + name + ".log";
  return std::make_unique<ChildProcess>(ChildProcess::Config{command, log, clouds});
}

void Coordinator::Watch(ChildProcess* child, std::function<void(const nlohmann::json&)> handler) {
  loop_.Watch(child->output_fd(), [this, child, handler = std::move(handler)] {
    const bool open = child->ReadLines([&](const std::string& line) {
      const auto record = nlohmann::json::parse(line, nullptr, false);
      if (record.is_object()) handler(record);
    });
    if (!open) loop_.Unwatch(child->output_fd());
  });
}

void Coordinator::OnReceiver(const nlohmann::json& record) {
  const std::string type = record.value("type", "");
  if (type == "playing" && phase_ == Phase::kReceiver) Enter(Phase::kLink);
  if (type == "stats") m_.receiver_stats = record;
  m_.ledger.Add(record);
}

void Coordinator::OnSender(const nlohmann::json& record) {
  const std::string type = record.value("type", "");
  if (type == "bounds")
    m_.AddBounds(record.value("unix_ns", std::int64_t{0}), record.value("min", 0.0),
                 record.value("max", 0.0));
  m_.ledger.Add(record);
  if (type != "stats") return;
  m_.sender_stats = record;
  last_ = ReadSample(record);
  m_.samples.push_back(last_);
}

void Coordinator::StartLinks() {
  links_.resize(m_.options.links);
  latest_.resize(m_.options.links);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    auto command = LinkArguments(m_.options, ports_, i);
    command.insert(command.begin(), tools::OwnFolder() + "/lidar-link");
    links_[i].process = std::make_unique<ChildProcess>(
        ChildProcess::Config{command, LinkFile(m_.options, "link.log", i), false});
    Watch(links_[i].process.get(), [this, i](const nlohmann::json& r) { OnLink(i, r); });
  }
}

bool Coordinator::LinksEnded() const {
  return std::all_of(links_.begin(), links_.end(),
                     [](const Link& link) { return link.process->Ended(); });
}

void Coordinator::OnLink(std::size_t index, const nlohmann::json& record) {
  links_[index].listens = links_[index].listens || record.contains("listening");
  if (phase_ == Phase::kLink &&
      std::all_of(links_.begin(), links_.end(), [](const Link& link) { return link.listens; }))
    Enter(Phase::kSender);
  if (!record.contains("origin_unix_ns")) return;
  if (index == 0) m_.origin_unix_ns = record.value("origin_unix_ns", std::int64_t{0});
  if (index == 0 && phase_ == Phase::kSender) Enter(Phase::kStreaming);
  if (!record.contains("time_s")) return;
  latest_[index] = record;
  if (index + 1 == links_.size()) PrintLive(SumOfLinks(latest_));
}

void PrintHeader() {
  std::puts(
      "     Mbit/s                   ms             mm            scans                        "
      "packets\n"
      "   s  capacity target   sent   queue    rtt   step  error  taken skipped  sent  whole "
      "marked  dropped    late");
}

void Coordinator::PrintLive(const nlohmann::json& link) {
  marked_ += link.value("marked", std::uint64_t{0});
  dropped_ += link.value("dropped", std::uint64_t{0});
  const ScanCounts n = m_.ledger.Count();
  if (lines_++ % kLinesBetweenHeaders == 0) PrintHeader();
  std::printf("%4.0f %9.2f %6.2f %6.2f %7.1f %6.1f %6.1f %6.1f %6" PRIu64 " %7" PRIu64 " %5" PRIu64
              " %6" PRIu64 " %6" PRIu64 " %8" PRIu64 " %7" PRIu64 "\n",
              link["time_s"].get<double>(), link["capacity_bps"].get<double>() / 1e6,
              last_.target_bps / 1e6, link["delivered_bps"].get<double>() / 1e6,
              link["sojourn_ms"]["p95"].get<double>(), last_.rtt_ms, last_.step_m * 1e3,
              last_error_m_ * 1e3, n.captured, n.skipped, n.sent, n.complete, marked_, dropped_,
              last_.packets_dropped);
  std::fflush(stdout);
  last_error_m_ = 0;
}

void Coordinator::TakeComparisons() {
  if (!comparer_) return;
  for (const auto& [key, comparison] : comparer_->Take()) {
    // Comparisons slow down a receiver that is stopping, so each result restarts the receiver's
    // time limit.
    if (phase_ == Phase::kReceiverStops) phase_since_ = Now();
    last_error_m_ = std::max(last_error_m_, comparison.max_error_m);
    m_.ledger.Add(key, comparison);
  }
}

void Coordinator::Enter(Phase phase) {
  phase_ = phase;
  phase_since_ = Now();
  const RunOptions& o = m_.options;
  const std::string folder = tools::OwnFolder();
  switch (phase) {
    case Phase::kReceiver:
      receiver_ =
          Start({folder + "/lidar-demo", "receive", ReceiverPipeline(o, ports_)}, "receiver", true);
      Watch(receiver_.get(), [this](const nlohmann::json& r) { OnReceiver(r); });
      break;
    case Phase::kLink:
      StartLinks();
      break;
    case Phase::kSender:
      sender_ = Start({folder + "/lidar-demo", "send", SenderPipeline(o, ports_)}, "sender", true);
      Watch(sender_.get(), [this](const nlohmann::json& r) { OnSender(r); });
      // The reach exceeds the error bound. So the comparer can measure an error above the bound,
      // and does not count the point as missing.
      comparer_ = std::make_unique<StreamComparer>(sender_->clouds_fd(), receiver_->clouds_fd(),
                                                   2 * ErrorBoundOf(o) + 0.01);
      break;
    case Phase::kStreaming:
      streaming_since_ = Time{Duration{m_.origin_unix_ns} - tools::UnixOffset()};
      break;
    case Phase::kDraining:
      m_.ran_s = Seconds(Now() - streaming_since_);
      m_.EndBounds((Now() + tools::UnixOffset()).time_since_epoch().count());
      sender_->Signal(SIGINT);
      break;
    case Phase::kArriving:
      break;
    case Phase::kReceiverStops:
      receiver_->Signal(SIGINT);
      break;
    case Phase::kLinkStops:
      for (const Link& link : links_) link.process->Signal(SIGINT);
      break;
  }
}

void Coordinator::CheckLimit() {
  if (phase_ == Phase::kStreaming || Now() - phase_since_ < kPhaseLimit) return;
  static constexpr const char* kWaitingFor[] = {"the receiver to play",   "the link to listen",
                                                "the first packet",       "",
                                                "the sender to drain",    "",
                                                "the receiver to finish", "the link to finish"};
  failure_ = std::string("gave up waiting for ") + kWaitingFor[static_cast<int>(phase_)];
}

/// Returns true if all data have arrived. Also returns true after kArrivalLimit, because the link
/// may be in a gap in which no data arrive.
bool Coordinator::AllArrived() const {
  const Duration waited = Now() - phase_since_;
  return waited >= kArrivalLimit || (waited >= kTick && m_.ledger.Count().slices_lost == 0);
}

void Coordinator::Tick() {
  const bool streaming = phase_ == Phase::kStreaming;
  struct Child {
    ChildProcess* child;
    const char* name;
    Phase may_end;  // the first phase in which the child may end
    std::string log;
  };
  const std::string folder = m_.options.output + "/";
  std::vector<Child> children = {
      {receiver_.get(), "receiver", Phase::kDraining, folder + "receiver.log"},
      {sender_.get(), "sender", Phase::kDraining, folder + "sender.log"}};
  for (std::size_t i = 0; i < links_.size(); ++i)
    children.push_back(
        {links_[i].process.get(), "link", Phase::kLinkStops, LinkFile(m_.options, "link.log", i)});
  for (const auto& c : children)
    if (c.child != nullptr && phase_ < c.may_end && c.child->Ended())
      failure_ = std::string("the ") + c.name + " ended early, code " +
                 std::to_string(c.child->Wait()) + ":\n" + Tail(c.log);
  TakeComparisons();
  CheckLimit();
  if (!failure_.empty() || (phase_ == Phase::kLinkStops && LinksEnded())) {
    loop_.Stop();
  } else if (streaming && Now() - streaming_since_ >= FromSeconds(m_.options.duration_s)) {
    Enter(Phase::kDraining);
  } else if (phase_ == Phase::kDraining && sender_->Ended()) {
    Enter(Phase::kArriving);
  } else if (phase_ == Phase::kArriving && AllArrived()) {
    Enter(Phase::kReceiverStops);
  } else if (phase_ == Phase::kReceiverStops && receiver_->Ended()) {
    Enter(Phase::kLinkStops);
  }
}

int Coordinator::Run() {
  const std::string page = PageOf(m_.options);
  if (!page.empty()) std::fprintf(stderr, "demo: look at %s\n", page.c_str());
  Enter(Phase::kReceiver);
  Time next = Now();
  const auto before_wait = [&] {
    if (Now() >= next) {
      Tick();
      next = Now() + kTick;
    }
    loop_.SetWakeUp(next);
  };
  loop_.Run(before_wait);
  if (failure_.empty() && phase_ == Phase::kStreaming) {
    // Ctrl-C has ended the loop. The part that was streamed still gets a report.
    Enter(Phase::kDraining);
    loop_.Run(before_wait);
  }
  if (failure_.empty() && phase_ != Phase::kLinkStops) failure_ = "interrupted";
  if (!failure_.empty()) {
    // The comparer ends only after both pipes have ended.
    for (ChildProcess* child : {sender_.get(), receiver_.get()}) {
      if (child == nullptr) continue;
      child->Signal(SIGKILL);
      child->Wait();
    }
    throw std::runtime_error(failure_);
  }
  return Report();
}

int Coordinator::Report() {
  const std::string& folder = m_.options.output;
  comparer_->Finish();
  TakeComparisons();
  m_.packets = ReadLinkLogs(m_.options);
  WriteTables(m_, folder);
  auto summary = Summarise(m_);
  const auto guarantees = CheckGuarantees(m_);
  bool all = true;
  for (const Guarantee& g : guarantees) {
    summary["guarantees"].push_back({{"text", g.text}, {"holds", g.holds}});
    all = all && g.holds;
  }
  const Verdict verdict = Judge(m_);
  summary["verdict"] = verdict.text;
  if (m_.options.slam) AddSlam(m_, folder, &summary);
  tools::WriteFile(folder + "/summary.json", summary.dump(2) + '\n');
  const nlohmann::json stats = {{"sender", m_.sender_stats}, {"receiver", m_.receiver_stats}};
  tools::WriteFile(folder + "/stats.json", stats.dump(2) + '\n');
  PrintTable(summary);
  if (m_.options.slam) PrintSlam(summary);
  for (const Guarantee& g : guarantees)
    std::printf("  %s  %s\n", g.holds ? "holds " : "BROKEN", g.text.c_str());
  std::printf("\n%s\n", verdict.text.c_str());
  for (const std::string& hint : verdict.hints) std::printf("  %s\n", hint.c_str());
  const bool drawn = !m_.options.plots || DrawPlots(m_, folder);
  std::printf("\nReport in %s\n", folder.c_str());
  if (!all || !drawn) return 1;
  return verdict.level == Verdict::Level::kPoor ? kPoorStream : 0;
}

}  // namespace

int RunDemo(const RunOptions& options) { return Coordinator(options).Run(); }

}  // namespace lidar::demo
