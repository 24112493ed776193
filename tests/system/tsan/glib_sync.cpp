// SPDX-License-Identifier: LGPL-2.1-or-later
// Wraps functions of GLib and GStreamer, so that ThreadSanitizer knows in which order threads run
// because of them. GLib's locks are implemented with futexes, and reference counts with inline
// atomics. ThreadSanitizer does not see either of these. tests/run.sh --tsan preloads this library.
#include <dlfcn.h>
#include <glib.h>
#include <gst/gst.h>

#include <mutex>

// These macros have the same names as the functions that are defined below.
#undef g_once_init_enter
#undef g_once_init_leave

extern "C" {
void __tsan_acquire(void*) __attribute__((weak));
void __tsan_release(void*) __attribute__((weak));
}

namespace {

// The functions are null in a program without ThreadSanitizer. A program that a test starts may be
// such a program, because it preloads this library, too.
void Acquire(void* p) {
  if (__tsan_acquire != nullptr) __tsan_acquire(p);
}
void Release(void* p) {
  if (__tsan_release != nullptr) __tsan_release(p);
}

template <class Function>
Function Next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// The following macros define wrappers of GLib's lock functions. What a thread did before it
// unlocked `m` happens before what another thread does after it has locked `m`.
#define LOCKS(name, type)                                   \
  extern "C" void name(type* m) {                           \
    static auto* const next = Next<decltype(&name)>(#name); \
    next(m);                                                \
    Acquire(m);                                             \
  }
#define TRIES(name, type)                                   \
  extern "C" gboolean name(type* m) {                       \
    static auto* const next = Next<decltype(&name)>(#name); \
    const gboolean got = next(m);                           \
    if (got) Acquire(m);                                    \
    return got;                                             \
  }
#define UNLOCKS(name, type)                                 \
  extern "C" void name(type* m) {                           \
    static auto* const next = Next<decltype(&name)>(#name); \
    Release(m);                                             \
    next(m);                                                \
  }
// Defines a wrapper of a function that drops a reference. What any thread did before it dropped its
// reference happens before the object is freed.
#define UNREFS(name, type)                                  \
  extern "C" void name(type o) {                            \
    static auto* const next = Next<decltype(&name)>(#name); \
    Release(o);                                             \
    Acquire(o);                                             \
    next(o);                                                \
  }

LOCKS(g_mutex_lock, GMutex)
TRIES(g_mutex_trylock, GMutex)
UNLOCKS(g_mutex_unlock, GMutex)
LOCKS(g_rec_mutex_lock, GRecMutex)
TRIES(g_rec_mutex_trylock, GRecMutex)
UNLOCKS(g_rec_mutex_unlock, GRecMutex)
LOCKS(g_rw_lock_writer_lock, GRWLock)
UNLOCKS(g_rw_lock_writer_unlock, GRWLock)
LOCKS(g_rw_lock_reader_lock, GRWLock)
UNLOCKS(g_rw_lock_reader_unlock, GRWLock)
UNREFS(gst_mini_object_unref, GstMiniObject*)
UNREFS(g_object_unref, gpointer)
UNREFS(gst_object_unref, gpointer)

extern "C" {

void g_cond_wait(GCond* cond, GMutex* mutex) {
  static auto* const next = Next<decltype(&g_cond_wait)>("g_cond_wait");
  Release(mutex);
  next(cond, mutex);
  Acquire(mutex);
}

gboolean g_cond_wait_until(GCond* cond, GMutex* mutex, gint64 end) {
  static auto* const next = Next<decltype(&g_cond_wait_until)>("g_cond_wait_until");
  Release(mutex);
  const gboolean signalled = next(cond, mutex, end);
  Acquire(mutex);
  return signalled;
}

// A thread may write to a buffer only while it has the only reference. What other threads did
// before they dropped their references happens before that.
gboolean gst_mini_object_is_writable(const GstMiniObject* o) {
  static auto* const next =
      Next<decltype(&gst_mini_object_is_writable)>("gst_mini_object_is_writable");
  const gboolean writable = next(o);
  if (writable) Acquire(const_cast<GstMiniObject*>(o));
  return writable;
}

GstMiniObject* gst_mini_object_make_writable(GstMiniObject* o) {
  static auto* const next =
      Next<decltype(&gst_mini_object_make_writable)>("gst_mini_object_make_writable");
  Acquire(o);
  return next(o);
}

GstMiniObject* gst_mini_object_ref(GstMiniObject* o) {
  static auto* const next = Next<decltype(&gst_mini_object_ref)>("gst_mini_object_ref");
  Acquire(o);
  return next(o);
}

// Wrappers for queues: what a thread did before it pushed an item happens before another thread
// pops the item.
void g_async_queue_push(GAsyncQueue* queue, gpointer data) {
  g_async_queue_lock(queue);
  Acquire(queue);
  g_async_queue_push_unlocked(queue, data);
  Release(queue);
  g_async_queue_unlock(queue);
}

gpointer g_async_queue_try_pop(GAsyncQueue* queue) {
  g_async_queue_lock(queue);
  Acquire(queue);
  gpointer const data = g_async_queue_try_pop_unlocked(queue);
  Release(queue);
  g_async_queue_unlock(queue);
  return data;
}

gpointer g_async_queue_timeout_pop(GAsyncQueue* queue, guint64 timeout) {
  const gint64 end = g_get_monotonic_time() + static_cast<gint64>(MIN(timeout, G_MAXINT32));
  for (;;) {
    gpointer const data = g_async_queue_try_pop(queue);
    if (data != nullptr || g_get_monotonic_time() >= end) return data;
    g_usleep(500);
  }
}

gpointer g_async_queue_pop(GAsyncQueue* queue) {
  for (;;)
    if (gpointer const data = g_async_queue_timeout_pop(queue, G_USEC_PER_SEC)) return data;
}

// The arguments of a thread pool. What was done before work was pushed to the pool happens before a
// thread of the pool runs the work.
struct PoolWork {
  GFunc function;
  gpointer user_data;
};

GThreadPool* g_thread_pool_new(GFunc function, gpointer user_data, gint threads, gboolean exclusive,
                               GError** error) {
  static auto* const next = Next<decltype(&g_thread_pool_new)>("g_thread_pool_new");
  const auto run = [](gpointer data, gpointer work) {
    Acquire(data);
    static_cast<PoolWork*>(work)->function(data, static_cast<PoolWork*>(work)->user_data);
  };
  return next(run, new PoolWork{function, user_data}, threads, exclusive, error);
}

gboolean g_thread_pool_push(GThreadPool* pool, gpointer data, GError** error) {
  static auto* const next = Next<decltype(&g_thread_pool_push)>("g_thread_pool_push");
  Release(data);
  return next(pool, data, error);
}

gboolean gst_bus_post(GstBus* bus, GstMessage* message) {
  static auto* const next = Next<decltype(&gst_bus_post)>("gst_bus_post");
  Release(bus);
  return next(bus, message);
}

gboolean gst_element_post_message(GstElement* element, GstMessage* message) {
  static auto* const next = Next<decltype(&gst_element_post_message)>("gst_element_post_message");
  Release(message);
  return next(element, message);
}

GstMessage* gst_bus_timed_pop_filtered(GstBus* bus, GstClockTime timeout, GstMessageType types) {
  static auto* const next =
      Next<decltype(&gst_bus_timed_pop_filtered)>("gst_bus_timed_pop_filtered");
  GstMessage* const message = next(bus, timeout, types);
  Acquire(bus);
  if (message != nullptr) Acquire(message);
  // The thread that posted the message drops its reference in code that ThreadSanitizer does not
  // see. Waits until it has done so, because ThreadSanitizer would report a race if that thread
  // freed the message.
  for (int i = 0; message != nullptr && i < 100 && GST_MINI_OBJECT_REFCOUNT_VALUE(message) > 1; ++i)
    g_usleep(1000);
  return message;
}

GstMessage* gst_bus_timed_pop(GstBus* bus, GstClockTime timeout) {
  return gst_bus_timed_pop_filtered(bus, timeout, GST_MESSAGE_ANY);
}
GstMessage* gst_bus_pop_filtered(GstBus* bus, GstMessageType types) {
  return gst_bus_timed_pop_filtered(bus, 0, types);
}
GstMessage* gst_bus_pop(GstBus* bus) { return gst_bus_pop_filtered(bus, GST_MESSAGE_ANY); }

// Wrappers for main contexts: what a thread did before it attached a source happens before another
// thread dispatches the source. All contexts share a mutex, because a poll function does not get
// the context as an argument.
static std::mutex attaching;

guint g_source_attach(GSource* source, GMainContext* context) {
  static auto* const next = Next<decltype(&g_source_attach)>("g_source_attach");
  const std::lock_guard lock(attaching);
  return next(source, context);
}

static gint Poll(GPollFD* fds, guint n, gint timeout) {
  const gint ready = g_poll(fds, n, timeout);
  const std::lock_guard lock(attaching);
  return ready;
}

__attribute__((constructor)) static void PollInDefaultContext() {
  g_main_context_set_poll_func(g_main_context_default(), Poll);
}

GMainContext* g_main_context_new() {
  static auto* const next = Next<decltype(&g_main_context_new)>("g_main_context_new");
  GMainContext* const context = next();
  g_main_context_set_poll_func(context, Poll);
  return context;
}

// g_main_loop_quit() needs the mutex as well, because a context with a source of high priority
// dispatches it without polling.
void g_main_loop_quit(GMainLoop* loop) {
  static auto* const next = Next<decltype(&g_main_loop_quit)>("g_main_loop_quit");
  const std::lock_guard lock(attaching);
  next(loop);
}

gboolean g_once_init_enter(volatile void* location) {
  static auto* const next = Next<gboolean (*)(volatile void*)>("g_once_init_enter");
  const gboolean first = next(location);
  Acquire(const_cast<void*>(location));
  return first;
}

void g_once_init_leave(volatile void* location, gsize result) {
  static auto* const next = Next<void (*)(volatile void*, gsize)>("g_once_init_leave");
  Release(const_cast<void*>(location));
  next(location, result);
}
}
