// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/system/faults/stepped_clock.h"

#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <ctime>

namespace {

std::atomic<int> offset{0};

/// Adds the offset to the arrival time (SCM_TIMESTAMPNS) of a message.
void StepArrival(msghdr* message) {
  for (cmsghdr* c = CMSG_FIRSTHDR(message); c != nullptr; c = CMSG_NXTHDR(message, c))
    if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_TIMESTAMPNS)
      reinterpret_cast<timespec*>(CMSG_DATA(c))->tv_sec += offset;
}

}  // namespace

void lidar::test::StepWallClock(int seconds) { offset += seconds; }

// These functions of the program replace the functions of libc. The plugins that the program loads
// use them, too.
extern "C" {

__attribute__((visibility("default"))) int clock_gettime(clockid_t clock, timespec* t) noexcept {
  const int result = static_cast<int>(syscall(SYS_clock_gettime, clock, t));
  if (result == 0 && clock == CLOCK_REALTIME) t->tv_sec += offset;
  return result;
}

__attribute__((visibility("default"))) int gettimeofday(timeval* t, void*) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  *t = {now.tv_sec, now.tv_nsec / 1'000};
  return 0;
}

__attribute__((visibility("default"))) int recvmmsg(int socket, mmsghdr* messages, unsigned count,
                                                    int flags, timespec* timeout) {
  const auto n = static_cast<int>(syscall(SYS_recvmmsg, socket, messages, count, flags, timeout));
  for (int i = 0; i < n; ++i) StepArrival(&messages[i].msg_hdr);
  return n;
}
}
