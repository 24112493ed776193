// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-eval static: measures how many bits slices save if they refer to scans that the receiver
// has.
#include <cstdio>
#include <deque>
#include <memory>
#include <stdexcept>

#include "src/codec/effort_control.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"
#include "src/tools/lab/codec_lab/scan_source.h"
#include "src/tools/lab/codec_lab/slice_codec.h"
#include "src/tools/lab/lidar_eval/commands.h"

namespace lidar::tools {
namespace {

struct StaticOptions {
  std::vector<std::string> sources;
  SourceOptions source;
  std::vector<unsigned> efforts = {1, 2, 3};
  std::vector<double> errors = {0.02, 0.05};
  std::uint32_t slices = 8;
  std::uint32_t delay = 2;
  double key_interval_s = 10;
};

struct Sizes {
  std::size_t alone = 0;  // bytes if slices refer to no scan
  std::size_t referring = 0;
  std::size_t returns = 0;
  std::size_t slices = 0;
  std::size_t with_reference = 0;

  Sizes operator-(const Sizes& o) const {
    return {alone - o.alone, referring - o.referring, returns - o.returns, slices - o.slices,
            with_reference - o.with_reference};
  }
};

/// An encoder with a receiver. The receiver gets all slices, and acknowledges them some scans
/// later.
class Link {
 public:
  Link(const StaticOptions& options, unsigned effort, double error, double scans_per_second)
      : o_(options), effort_(effort), period_(FromSeconds(1 / scans_per_second)) {
    settings_.max_error_m = error;
    keeper_.set_key_interval(FromSeconds(options.key_interval_s));
    // The first acknowledgement shows the keeper that there is a receiver.
    keeper_.OnAcknowledged(Now(), 0, 0, 0);
  }

  void Send(const Scan& scan) {
    for (std::uint32_t i = 0; i < o_.slices; ++i) {
      source_.Load(scan, {i, o_.slices});
      if (source_.returns() > 0) SendSlice(i);
    }
    sent_.push_back(scan_++);
    if (sent_.size() < o_.delay) return;
    for (std::uint32_t i = 0; i < o_.slices; ++i)
      keeper_.OnAcknowledged(Now(), 0, sent_.front(), i);
    sent_.pop_front();
  }
  const Sizes& sizes() const { return sizes_; }

 private:
  Time Now() const { return Time{scan_ * period_}; }

  codec::SliceEncoder MakeEncoder() const {
    auto encoder = codec::SliceEncoder::Create(source_.format());
    if (!encoder) throw std::runtime_error("references need a sensor's ranges");
    encoder->set_effort(effort_);
    return *std::move(encoder);
  }

  void SendSlice(std::uint32_t index) {
    if (!encoder_) {
      encoder_.emplace(MakeEncoder());
      decoder_.emplace(source_.format(), 1U << 26);
    }
    encoder_->Load(source_.raw(), source_.first_column(), false);
    encoder_->LinkBy(nullptr);
    encoder_->Encode(settings_, &slice_);
    sizes_.alone += slice_.bytes.size();
    const bool remembers = keeper_.Begin(Now(), {scan_, index, o_.slices});
    encoder_->LinkBy(remembers ? &keeper_ : nullptr);
    encoder_->Encode(settings_, &slice_);
    sizes_.referring += slice_.bytes.size();
    sizes_.returns += source_.returns();
    ++sizes_.slices;
    if (encoder_->Mode().rfind("range-temporal", 0) == 0) ++sizes_.with_reference;
    if (!decoder_->Decode({slice_.bytes.data(), slice_.bytes.size()}))
      throw std::runtime_error("a slice cannot be decoded");
    keeper_.OnEncoded(std::move(slice_.blocks));
    slice_.blocks.clear();
  }

  const StaticOptions& o_;
  unsigned effort_;
  Duration period_;
  codec::SliceSettings settings_;
  SliceCodec source_;
  std::optional<codec::SliceEncoder> encoder_;
  std::optional<codec::SliceDecoder> decoder_;
  codec::ReferenceKeeper keeper_;
  codec::EncodedSlice slice_;
  std::uint32_t scan_ = 0;
  std::deque<std::uint32_t> sent_;
  Sizes sizes_;
};

double BitsAReturn(std::size_t bytes, std::size_t returns) {
  return returns > 0 ? 8 * static_cast<double>(bytes) / static_cast<double>(returns) : 0;
}

void Measure(const ScanSet& set, const StaticOptions& o, unsigned effort, double error) {
  Link link(o, effort, error, set.scans_per_second);
  Sizes half;
  for (std::size_t i = 0; i < set.scans.size(); ++i) {
    if (i == set.scans.size() / 2) half = link.sizes();
    link.Send(set.scans[i]);
  }
  const Sizes all = link.sizes();
  const Sizes late = all - half;
  std::printf("  %6u %9.0f %9.3f %9.3f %9.3f %9.0f %%\n", effort, 1e3 * error,
              BitsAReturn(all.alone, all.returns), BitsAReturn(all.referring, all.returns),
              BitsAReturn(late.referring, late.returns),
              100 * static_cast<double>(all.with_reference) / static_cast<double>(all.slices));
}

void RunStatic(const StaticOptions& o) {
  for (const std::string& source : o.sources) {
    const ScanSet set = LoadScans(source, o.source);
    std::printf("%s: %zu scans, %u slices each, acknowledged %u scans later\n", set.name.c_str(),
                set.scans.size(), o.slices, o.delay);
    std::printf("  %6s %9s %9s %9s %9s %11s\n", "effort", "error", "alone", "referring", "2nd half",
                "slices");
    std::printf("  %6s %9s %9s %9s %9s %11s\n", "", "[mm]", "[bits]", "[bits]", "[bits]",
                "that refer");
    for (const unsigned effort : o.efforts)
      for (const double error : o.errors) Measure(set, o, effort, error);
  }
}

}  // namespace

void AddStaticCommand(CLI::App* app) {
  auto o = std::make_shared<StaticOptions>();
  o->source.speed_mps = 0;
  o->source.max_scans = 100;
  CLI::App* command =
      app->add_subcommand("static", "Bits a return if slices refer to scans that the receiver has");
  command->option_defaults()->always_capture_default();
  command->add_option("SOURCE", o->sources, kSourceHelp)->required();
  command->add_option("--effort", o->efforts, "Efforts of our coder, comma-separated")
      ->delimiter(',')
      ->check(CLI::Range(1U, codec::EffortControl::kHighest));
  AddErrorBounds(command, "--errors", &o->errors, "Error bounds [m], comma-separated");
  command->add_option("--slices", o->slices, "Slices per scan")->check(CLI::Range(1U, 64U));
  command->add_option("--delay", o->delay, "Scans until a receiver's acknowledgement arrives")
      ->check(CLI::Range(1U, 100U));
  command->add_option("--key-interval", o->key_interval_s, "The key-interval of lidarenc [s]");
  command->add_option("--scans", o->source.max_scans, "Scans to read of each source");
  command->add_option("--speed", o->source.speed_mps, "Speed of synthetic drives [m/s]");
  command->add_option("--noise", o->source.noise_m,
                      "Standard deviation of synthetic ranges on a bright target [m]");
  command->callback([o] { RunStatic(*o); });
}

}  // namespace lidar::tools
