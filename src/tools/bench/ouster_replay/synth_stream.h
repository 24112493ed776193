// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes the packets of a sensor that drives through a synthetic world.
#pragma once
#include <memory>
#include <string>

#include "src/ouster/packet_writer.h"
#include "src/synth/scanner.h"
#include "src/tools/bench/ouster_replay/packet_stream.h"

namespace lidar::tools {

struct SynthOptions {
  std::string model = "os1-128";
  synth::SceneKind scene = synth::SceneKind::kStreet;
  double speed_mps = 12;
  std::uint64_t seed = 1;
};

/// The packet format of a synthetic sensor.
struct SynthFormat {
  std::string mode = "1024x10";
  ouster::Profile profile = ouster::Profile::kRng19Rfl8Sig16Nir16;
  ouster::HeaderType header = ouster::HeaderType::kStandard;
  std::uint32_t columns_per_packet = 16;
};
ouster::Metadata MakeSynthMetadata(const SynthOptions& options, const SynthFormat& format);

class SynthStream : public PacketStream {
 public:
  SynthStream(const SynthOptions& options, const ouster::Metadata& metadata);

  void Restart(const Start& start) override;
  std::optional<OutPacket> Next() override;

 private:
  std::optional<OutPacket> LidarPacket();
  OutPacket ImuPacket();
  void WritePixel(ouster::PacketWriter* writer, std::uint32_t column, std::uint32_t beam,
                  std::size_t at) const;
  Duration LidarDue() const;

  ouster::Metadata metadata_;
  synth::Scanner scanner_;
  std::unique_ptr<ouster::PacketWriter> writer_;
  synth::Returns returns_;
  Start start_;
  std::uint64_t scan_ = 0;
  std::uint32_t column_ = 0;
  std::uint64_t imu_ = 0;
};

}  // namespace lidar::tools
