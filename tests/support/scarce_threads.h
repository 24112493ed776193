// SPDX-License-Identifier: LGPL-2.1-or-later
// Simulates a machine on which the calling thread cannot start other threads: this header defines a
// pthread_create(), which replaces that of libc. Only one source file of a program may include it.
#pragma once
#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>

namespace lidar::test {

inline thread_local bool no_more_threads = false;

/// While an object of this class exists, the thread that created it cannot start other threads.
class ScarceThreads {
 public:
  ScarceThreads() { no_more_threads = true; }
  ~ScarceThreads() { no_more_threads = false; }
  ScarceThreads(const ScarceThreads&) = delete;
  ScarceThreads& operator=(const ScarceThreads&) = delete;
};

}  // namespace lidar::test

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*run)(void*), void* argument) {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto next = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (lidar::test::no_more_threads) return EAGAIN;
  return next(thread, attributes, run, argument);
}
