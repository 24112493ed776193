// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "src/bonding/packet_id.h"
#include "src/tools/common/output_file.h"

namespace lidar::demo {
namespace {

constexpr double kBin_s = 0.1;

struct Bin {
  std::vector<double> sent_bits;  // bits that were sent over each link
  double encoded_bits = 0;
  double queue_ms = 0;  // the longest sojourn
  double max_error_m = 0;
  SenderSample sender;
};

Bin* BinAt(std::vector<Bin>* bins, double time_s) {
  if (time_s < 0) return nullptr;
  const auto index = static_cast<std::size_t>(time_s / kBin_s);
  return index < bins->size() ? &(*bins)[index] : nullptr;
}

std::vector<Bin> CollectBins(const Measurements& m) {
  std::vector<Bin> bins(static_cast<std::size_t>(std::ceil(m.ran_s / kBin_s)));
  for (Bin& bin : bins) bin.sent_bits.resize(m.options.links);
  for (const LinkPacket& p : m.packets) {
    Bin* bin = BinAt(&bins, p.time_s);
    if (bin == nullptr || !p.delivered) continue;
    bin->sent_bits[p.link] += static_cast<double>(p.size) * 8;
    bin->queue_ms = std::max(bin->queue_ms, p.sojourn_ms);
  }
  for (const auto& [id, scan] : m.ledger.scans()) {
    for (const SliceLife& s : scan) {
      Bin* bin = s.encoded > 0 ? BinAt(&bins, m.Since(s.encoded)) : nullptr;
      if (bin == nullptr) continue;
      bin->encoded_bits += static_cast<double>(s.bytes) * 8;
      if (s.comparison) bin->max_error_m = std::max(bin->max_error_m, s.comparison->max_error_m);
    }
  }
  for (const SenderSample& s : m.samples)
    if (Bin* bin = BinAt(&bins, m.Since(s.unix_ns))) bin->sender = s;
  return bins;
}

void WriteTimeline(const Measurements& m, const std::string& file) {
  tools::OutputFile output(file);
  std::ostream& out = output.stream();
  out << "time_s,capacity_mbps,target_mbps,encoded_mbps,sent_mbps,queue_ms,rtt_ms,ref_wnd_bytes,"
         "bytes_in_flight,sender_queue_ms,step_m,max_error_m,estimated_capacity_mbps";
  const auto capacities = CapacitiesOf(m.options);
  for (std::size_t i = 1; i < capacities.size(); ++i)
    out << ",capacity" << i + 1 << "_mbps,sent" << i + 1 << "_mbps";
  out << '\n';
  const auto bins = CollectBins(m);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double start = static_cast<double>(i) * kBin_s;
    const auto mbps = [&](const link::Capacity& c) {
      return c.Between(FromSeconds(start), FromSeconds(start + kBin_s)).bits() / kBin_s / 1e6;
    };
    const Bin& b = bins[i];
    char line[320];
    std::snprintf(
        line, sizeof line, "%.1f,%.4f,%.4f,%.4f,%.4f,%.3f,%.3f,%.0f,%.0f,%.3f,%.5f,%.5f,%.4f",
        start, mbps(capacities.front()), b.sender.target_bps / 1e6, b.encoded_bits / kBin_s / 1e6,
        b.sent_bits.front() / kBin_s / 1e6, b.queue_ms, b.sender.rtt_ms, b.sender.ref_wnd_bytes,
        b.sender.bytes_in_flight, b.sender.sender_queue_ms, b.sender.step_m, b.max_error_m,
        b.sender.estimated_capacity_bps / 1e6);
    out << line;
    for (std::size_t k = 1; k < capacities.size(); ++k) {
      std::snprintf(line, sizeof line, ",%.4f,%.4f", mbps(capacities[k]),
                    b.sent_bits[k] / kBin_s / 1e6);
      out << line;
    }
    out << '\n';
  }
  output.Close();
}

void WriteSlices(const Measurements& m, const std::string& file) {
  tools::OutputFile output(file);
  std::ostream& out = output.stream();
  out << "scan,slice,due_s,captured_s,encoded_s,received_s,decoded_s,returns,bytes,encode_ms,"
         "decode_ms,max_error_m,mean_error_m\n";
  const auto time = [&](std::int64_t unix_ns) { return unix_ns > 0 ? m.Since(unix_ns) : -1; };
  for (const auto& [id, scan] : m.ledger.scans()) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const SliceLife& s = scan[i];
      const Comparison c = s.comparison.value_or(Comparison{});
      char line[320];
      std::snprintf(line, sizeof line,
                    "%u,%zu,%.6f,%.6f,%.6f,%.6f,%.6f,%ju,%ju,%.4f,%.4f,%.6f,%.6f\n", id, i,
                    time(s.due), time(s.captured), time(s.encoded), time(s.received),
                    time(s.decoded), static_cast<std::uintmax_t>(s.returns),
                    static_cast<std::uintmax_t>(s.bytes), s.encode_ms, s.decode_ms, c.max_error_m,
                    c.points > 0 ? c.sum_error_m / static_cast<double>(c.points) : 0);
      out << line;
    }
  }
  output.Close();
}

constexpr const char* kPlots = R"(set terminal pngcairo size 1000,420 font "sans,10"
set datafile separator ","
set grid
set xlabel "time [s]"
set key outside right top
set xrange [0:*]
set yrange [0:*]

set output "rate.png"
set ylabel "Mbit/s"
if (links > 1) set yrange [*:*]
plot "timeline.csv" skip 1 using 1:2 with steps lw 2 lc rgb "#999999" title "capacity", \
     "" skip 1 using 1:($13 > 0 ? $13 : NaN) with lines dt 2 lc rgb "#666666" \
       title "capacity, estimated", \
     "" skip 1 using 1:3 with lines lw 2 lc rgb "#d95f02" title "target", \
     "" skip 1 using 1:4 with lines lc rgb "#7570b3" title "encoded", \
     "" skip 1 using 1:5 with lines lc rgb "#1b9e77" title "sent", \
     for [i = 2:links] "" skip 1 using 1:(-column(10 + 2 * i)) with steps lw 2 lc rgb "#999999" \
       title sprintf("capacity of link %d, below", i), \
     for [i = 2:links] "" skip 1 using 1:(-column(11 + 2 * i)) with lines lc i \
       title sprintf("sent by link %d, below", i)
set yrange [0:*]

set output "delay.png"
set ylabel "ms"
plot "packets.csv" skip 1 using 1:11 with points pt 7 ps 0.15 lc rgb "#d95f02" title "queue, each packet", \
     for [i = 2:links] sprintf("packets%d.csv", i) skip 1 using 1:11 with points pt 7 ps 0.15 lc i \
       title sprintf("queue of link %d", i), \
     "timeline.csv" skip 1 using 1:7 with lines lw 2 lc rgb "#7570b3" title "RTT, smoothed", \
     "slices.csv" skip 1 using 3:($7 > 0 ? ($7 - $3) * 1000 : NaN) with points pt 7 ps 0.2 lc rgb "#1b9e77" \
       title "capture to cloud, each slice"

set output "window.png"
set ylabel "kB"
plot "timeline.csv" skip 1 using 1:($8 / 1000) with lines lw 2 lc rgb "#d95f02" title "ref\\_wnd", \
     "" skip 1 using 1:($9 / 1000) with lines lc rgb "#1b9e77" title "bytes in flight"

set output "error.png"
set ylabel "cm"
set yrange [0:1.2 * bound_cm]
plot "timeline.csv" skip 1 using 1:($11 * 100) with steps lw 2 lc rgb "#7570b3" title "step", \
     "" skip 1 using 1:($12 > 0 ? $12 * 100 : NaN) with points pt 7 ps 0.4 lc rgb "#d95f02" \
       title "largest error", \
     bound_cm with lines dt 2 lc rgb "#666666" title "bound"
)";

std::string Field(const nlohmann::ordered_json& value, const char* format, double factor = 1) {
  if (!value.is_number()) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, value.get<double>() * factor);
  return text;
}

void PrintDelays(const nlohmann::ordered_json& summary, const char* label, const char* key) {
  const auto& d = summary[key];
  if (!d.is_object()) {
    std::printf("  %-34s -\n", label);
    return;
  }
  std::printf("  %-34s p50 %7.2f   p95 %7.2f   p99 %7.2f   max %7.2f ms\n", label,
              d["p50"].get<double>(), d["p95"].get<double>(), d["p99"].get<double>(),
              d["max"].get<double>());
}

void PrintLine(const char* label, const std::string& value) {
  std::printf("  %-34s %s\n", label, value.c_str());
}

void PrintLinks(const nlohmann::ordered_json& summary) {
  if (!summary.contains("links")) return;
  int n = 0;
  for (const auto& link : summary["links"])
    PrintLine(("link " + std::to_string(++n)).c_str(),
              Field(link["mean_rate_bps"], "%.2f Mbit/s", 1e-6) +
                  ", packets first / copies / saved " + Field(link["packets_first"], "%.0f / ") +
                  Field(link["packets_copies"], "%.0f / ") + Field(link["packets_saved"], "%.0f"));
}

}  // namespace

void WriteTables(const Measurements& m, const std::string& folder) {
  WriteTimeline(m, folder + "/timeline.csv");
  WriteSlices(m, folder + "/slices.csv");
}

void RemoveReport(const std::string& folder) {
  for (const char* file :
       {"summary.json", "stats.json", "slices.csv", "timeline.csv", "packets.csv",
        "link.json",    "trace.txt",  "rate.png",   "delay.png",    "window.png",
        "error.png",    "plots.gp",   "plots.log",  "sender.log",   "receiver.log",
        "link.log",     "truth.tum",  "edge.tum",   "poses.csv",    "map.png"})
    std::remove((folder + '/' + file).c_str());
  RunOptions options;
  options.output = folder;
  for (std::size_t i = 1; i < bonding::kMaxLinks; ++i)
    for (const char* file : {"packets.csv", "link.json", "link.log", "trace.txt"})
      std::remove(LinkFile(options, file, i).c_str());
}

bool DrawPlots(const Measurements& m, const std::string& folder) {
  tools::OutputFile script(folder + "/plots.gp");
  script.stream() << "bound_cm = " << ErrorBoundOf(m.options) * 100
                  << "\nlinks = " << m.options.links << '\n'
                  << kPlots;
  script.Close();
  std::string quoted = "'";
  for (const char c : folder) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  quoted += '\'';
  if (std::system(("cd " + quoted + " && gnuplot plots.gp 2> plots.log").c_str()) == 0) return true;
  std::cerr << "lidar-demo: gnuplot failed, see " << folder << "/plots.log\n";
  return false;
}

void PrintTable(const nlohmann::ordered_json& s) {
  std::printf("\n");
  PrintLine("scans captured / skipped / complete",
            Field(s["scans_captured"], "%.0f") + " / " + Field(s["scans_skipped"], "%.0f") + " / " +
                Field(s["scans_complete"], "%.0f") + " (in time " +
                Field(s["scans_in_time"], "%.0f") + ")");
  PrintLine("slices sent / lost",
            Field(s["slices_sent"], "%.0f") + " / " + Field(s["slices_lost"], "%.0f"));
  PrintLine("mean rate", Field(s["mean_rate_bps"], "%.2f Mbit/s", 1e-6));
  PrintLine("utilisation, steady", Field(s["utilisation_of_usable"], "%.1f %%", 100) +
                                       " of what the source can use (" +
                                       Field(s["utilisation"], "%.1f %%", 100) + " of the link)");
  PrintLinks(s);
  PrintDelays(s, "queue, whole run", "queue_delay_ms");
  PrintDelays(s, "queue, steady", "queue_delay_steady_ms");
  PrintDelays(s, "capture to cloud, whole run", "capture_to_cloud_ms");
  PrintDelays(s, "capture to cloud, steady", "capture_to_cloud_steady_ms");
  for (const auto& t : s["transients"])
    PrintLine(("step to " + Field(t["to_bps"], "%.1f Mbit/s", 1e-6)).c_str(),
              "queue up to " + Field(t["peak_ms"], "%.1f ms") + ", below 10 ms after " +
                  Field(t["below_10ms_after_s"], "%.2f s"));
  if (s["gaps"]["count"].get<int>() > 0)
    PrintLine("back at 80 % after a gap", "p50 " + Field(s["gaps"]["back_after_s"]["p50"], "%.2f") +
                                              ", max " +
                                              Field(s["gaps"]["back_after_s"]["max"], "%.2f s, ") +
                                              Field(s["gaps"]["count"], "%.0f gaps"));
  PrintLine("error, largest / mean", Field(s["max_error_m"], "%.2f", 100) + " / " +
                                         Field(s["mean_error_m"], "%.2f cm", 100) + " of " +
                                         Field(s["points_compared"], "%.0f points"));
  PrintLine("encode / decode, a scan",
            Field(s["encode_ms_p50"], "%.2f") + " / " + Field(s["decode_ms_p50"], "%.2f ms"));
  PrintLine("bits a return", Field(s["bits_per_return"], "%.2f"));
}

}  // namespace lidar::demo
