// SPDX-License-Identifier: LGPL-2.1-or-later
// Owning pointers for the types of GLib and libsoup that the server uses.
#pragma once
#include <gio/gio.h>

#include <memory>

namespace lidar::web {

struct GlibFree {
  void operator()(GSource* p) const {
    g_source_destroy(p);
    g_source_unref(p);
  }
  void operator()(GMainContext* p) const { g_main_context_unref(p); }
  void operator()(GMainLoop* p) const { g_main_loop_unref(p); }
  void operator()(GError* p) const { g_error_free(p); }
  void operator()(GBytes* p) const { g_bytes_unref(p); }
  void operator()(gpointer p) const { g_object_unref(p); }
};

/// A pointer that destroys its source, so that the source does not run any more.
using SourcePtr = std::unique_ptr<GSource, GlibFree>;
using ContextPtr = std::unique_ptr<GMainContext, GlibFree>;
using LoopPtr = std::unique_ptr<GMainLoop, GlibFree>;
using GErrorPtr = std::unique_ptr<GError, GlibFree>;
using BytesPtr = std::unique_ptr<GBytes, GlibFree>;
template <class T>
using ObjectPtr = std::unique_ptr<T, GlibFree>;

/// Returns another reference to `object`.
template <class T>
ObjectPtr<T> Ref(T* object) {
  return ObjectPtr<T>(static_cast<T*>(g_object_ref(object)));
}

}  // namespace lidar::web
