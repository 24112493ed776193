// SPDX-License-Identifier: LGPL-2.1-or-later
// Passes packets of an Ouster sensor through parser, CRC check, clocks and batcher. The first byte
// of the input chooses the profile. Each packet differs from the packet before it: the input has a
// time step [ms] in 1 byte, the offset of the change in 2 bytes, its length in 1 byte, and the new
// bytes.
#include <string>
#include <vector>

#include "src/ouster/sensor_stream.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace lidar::ouster;  // NOLINT

std::unique_ptr<SensorStream> MakeStream(std::uint8_t choice) {
  static const Profile profiles[] = {Profile::kLegacy, Profile::kRng19Rfl8Sig16Nir16,
                                     Profile::kRng15Rfl8Nir8, Profile::kRng19Rfl8Sig16Nir16Dual};
  Metadata m;
  m.format.profile = profiles[choice & 3];
  m.format.header = (choice & 4) != 0 ? HeaderType::kFusa : HeaderType::kStandard;
  m.format.beams = 4;
  m.format.columns_per_packet = 4;
  m.window = {(choice & 8) != 0 ? 60U : 0U, 64};
  m.scans_per_second = 10;
  m.model.columns_per_scan = 64;
  m.model.beams.resize(4);
  for (std::size_t i = 0; i < 4; ++i) m.model.beams[i] = {1.0, 10.0 - static_cast<double>(i), 1};
  StreamOptions options;
  options.slices_per_scan = 4;
  std::string error;
  return SensorStream::Create(m, options, &error);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lidar::ByteReader r(data, size);
  auto stream = MakeStream(r.U8());
  FUZZ_CHECK(stream != nullptr);
  std::vector<std::uint8_t> packet(stream->metadata().format.packet_size());
  Arrival arrival;
  while (r.ok() && r.remaining() > 0) {
    arrival.local += std::chrono::milliseconds(r.U8());
    arrival.utc = arrival.local;
    const std::size_t offset = r.Be16();
    const auto change = r.Bytes(std::min<std::size_t>(r.U8(), r.remaining()));
    for (std::size_t i = 0; i < change.size; ++i)
      packet[(offset + i) % packet.size()] = change.data[i];
    // An offset of 0xFF00 or more cuts the packet to the length in its lower byte.
    const std::size_t n = offset >> 8 == 0xFF ? offset & 0xFF : packet.size();
    const std::vector<std::uint8_t> sent(
        packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(std::min(n, packet.size())));
    stream->Push({sent.data(), sent.size()}, arrival);
    while (auto slice = stream->Pop()) {
      FUZZ_CHECK(slice->slice.index < slice->slice.count);
      FUZZ_CHECK(slice->slice.points.size() ==
                 std::size_t{slice->slice.width} * 4 * stream->writer().point_step());
    }
  }
  stream->Flush();
  while (stream->Pop()) continue;
  return 0;
}
