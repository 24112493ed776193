// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ouster/counters.h"

namespace lidar::gst {

using C = Counters;
using B = ouster::BatcherStats;
using S = ouster::StreamStats;

const std::array<Stat<Counters>, 16> kOusterStats = {{
    {"packets", At<&C::batcher, &B::packets>},
    {"packets-lost", At<&C::batcher, &B::lost_packets>},
    {"packets-late", At<&C::batcher, &B::late_packets>},
    {"packets-duplicate", At<&C::batcher, &B::duplicate_packets>},
    {"packets-stray", At<&C::batcher, &B::stray_packets>},
    {"packets-wrong-size", At<&C::stream, &S::wrong_size>},
    {"packets-foreign", At<&C::stream, &S::foreign>},
    {"packets-damaged", At<&C::stream, &S::damaged>},
    {"packets-imu", At<&C::stream, &S::imu_packets>},
    {"dropped-by-kernel", &C::kernel_drops},
    {"restarts", At<&C::batcher, &B::restarts>},
    {"reconnects", &C::reconnects},
    {"slices", At<&C::batcher, &B::slices>},
    {"slices-incomplete", At<&C::batcher, &B::incomplete_slices>},
    {"receive-buffer", &C::receive_buffer},
    {"clock-synchronised", &C::synchronised},
}};

}  // namespace lidar::gst
