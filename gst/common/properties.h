// SPDX-License-Identifier: LGPL-2.1-or-later
// GObject properties from one table: each row binds a property to a field of Settings, or to a
// function that reads the element.
//
//     const std::array<Property<Settings>, 3> kProperties = {{
//         {"port", "UDP port", &Settings::port, 1, 65535},
//         {"mss", "Largest packet [bytes]", At<&Settings::scream, &Parameters::mss>, 100, 65535},
//         {"stats", "packets, bytes [bytes]", Stats},  // StructurePtr Stats(GObject*)
//     }};
//     ServeState<GstLidarThing, gst_lidar_thing_parent_class, kProperties>(klass);
#pragma once
#include <array>
#include <string_view>

#include "gst/common/fields.h"

namespace lidar::gst {

/// A property of an element. Its default is the initialiser of the field. If `field` is a function,
/// the property is read-only.
template <class Settings>
struct Property {
  using Struct = Settings;

  const char* name;
  const char* blurb;  // contains the unit in brackets
  Field<Settings> field;
  gdouble min = 0;  // if both are 0, all values of the type are allowed
  gdouble max = 0;
  // GST_PARAM_MUTABLE_PLAYING if a change is effective at once. With G_PARAM_WRITABLE, the property
  // cannot be read.
  gint mutability = GST_PARAM_MUTABLE_READY;

  GParamFlags flags() const {
    if (field.read_only())
      return static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
    const gint access = mutability & G_PARAM_WRITABLE ? 0 : G_PARAM_READWRITE;
    return static_cast<GParamFlags>(access | G_PARAM_STATIC_STRINGS | mutability);
  }
};

/// Returns the row of `table` with this name. Ends the program if there is none.
template <class Settings, std::size_t N>
const Property<Settings>* FindRow(const std::array<Property<Settings>, N>& table,
                                  std::string_view name) {
  for (const auto& row : table)
    if (row.name == name) return &row;
  g_error("no property row is called \"%s\"", std::string(name).c_str());
}

/// Within<&Settings::part>(kPartRows, "name") converts the row "name" of a table for the struct
/// `part` to a row for Settings, of which `part` is a member. gcc 12 may merge instances of this
/// template from two source files. So structs in two files of a plugin must have different names.
template <auto part, class Settings, class Part, std::size_t N>
Property<Settings> WithinOf(Part Settings::*, const std::array<Property<Part>, N>& table,
                            std::string_view name) {
  const auto* row = FindRow(table, name);
  return {row->name, row->blurb, Field<Settings>(row, AtPath<part>{}),
          row->min,  row->max,   row->mutability};
}
template <auto part, class Part, std::size_t N>
auto Within(const std::array<Property<Part>, N>& table, std::string_view name) {
  return WithinOf<part>(part, table, name);
}

/// Converts a row of the table of a child element to a row for the table of its bin. `child`
/// returns the child, or NULL. The default value comes from `defaults`, which must have static
/// storage.
template <class Settings, class ChildSettings, std::size_t N>
Property<Settings> Proxy(const std::array<Property<ChildSettings>, N>& table, std::string_view name,
                         GObject* (*child)(GObject*), const ChildSettings* defaults = nullptr) {
  static const ChildSettings kDefaults{};
  const auto* row = FindRow(table, name);
  const Field<Settings> field(row, defaults != nullptr ? defaults : &kDefaults, child);
  return {row->name, row->blurb, field, row->min, row->max, row->mutability};
}

template <class Settings, std::size_t N, std::size_t M, std::size_t... i, std::size_t... j>
std::array<Property<Settings>, N + M> JoinRows(const std::array<Property<Settings>, N>& a,
                                               const std::array<Property<Settings>, M>& b,
                                               std::index_sequence<i...>,
                                               std::index_sequence<j...>) {
  return {{a[i]..., b[j]...}};
}
/// Returns the rows of `a` followed by the rows of `b`.
template <class Settings, std::size_t N, std::size_t M>
auto Join(const std::array<Property<Settings>, N>& a, const std::array<Property<Settings>, M>& b) {
  return JoinRows(a, b, std::make_index_sequence<N>(), std::make_index_sequence<M>());
}

/// Installs the rows of `table` with the ids first_id, first_id + 1, ...
template <class Settings, std::size_t N>
void InstallProperties(GObjectClass* klass, const std::array<Property<Settings>, N>& table,
                       guint first_id = 1) {
  const Settings defaults{};
  for (const auto& p : table) {
    const SpecArgs args{p.name, p.blurb, p.flags(), p.min, p.max};
    g_object_class_install_property(klass, first_id++, p.field.Spec(args, defaults));
  }
}

template <class Settings>
void SetProperty(Settings& s, const Property<Settings>& p, const GValue* v) {
  p.field.Set(&s, nullptr, v);
}

/// Reads a property. If the row is a function, it needs `object` and takes locks itself.
template <class Settings>
void GetProperty(const Settings& s, const Property<Settings>& p, GValue* v,
                 GObject* object = nullptr) {
  p.field.Get(&s, object, v);
}

/// Does nothing. It is the default of `changed` in ServeProperties().
inline void NothingMore(GObject*, GParamSpec*) {}

/// Returns the rows of `table`, which is an array or a function that returns an array.
template <class Table>
const auto& RowsOf(const Table& table) {
  if constexpr (std::is_function_v<Table>) {
    return table();
  } else {
    return table;
  }
}

/// Locks a mutex if `wanted` is true.
template <class Mutex>
class LockIf {
 public:
  LockIf(bool wanted, Mutex& mutex) : mutex_(wanted ? &mutex : nullptr) {
    if (mutex_ != nullptr) mutex_->lock();
  }
  ~LockIf() {
    if (mutex_ != nullptr) mutex_->unlock();
  }
  LockIf(const LockIf&) = delete;
  LockIf& operator=(const LockIf&) = delete;

 private:
  Mutex* mutex_;
};

/// Returns a copy of the settings, made with the mutex locked. For the type of `state`, see
/// ServeProperties().
template <class State>
auto Snapshot(State& state) {
  const LockIf lock(true, state.mutex);
  return state.settings;
}

/// Installs `table` and the two property methods of the element `Self`. The `state` of `Self` must
/// have `settings` and a `mutex` that guards them. `changed` is called after each change, with the
/// mutex unlocked.
template <class Self, auto& table, void (*changed)(GObject*, GParamSpec*) = NothingMore>
void ServeProperties(GObjectClass* klass) {
  klass->set_property = [](GObject* object, guint id, const GValue* v, GParamSpec* spec) {
    auto& state = *reinterpret_cast<Self*>(object)->state;
    const auto& field = RowsOf(table)[id - 1].field;
    {
      const LockIf lock(!field.of_object(), state.mutex);
      field.Set(&state.settings, object, v);
    }
    changed(object, spec);
  };
  klass->get_property = [](GObject* object, guint id, GValue* v, GParamSpec*) {
    auto& state = *reinterpret_cast<Self*>(object)->state;
    const auto& field = RowsOf(table)[id - 1].field;
    const LockIf lock(!field.of_object(), state.mutex);
    field.Get(&state.settings, object, v);
  };
  InstallProperties(klass, RowsOf(table));
}

/// Makes finalize() delete `state`. `parent_class` is the variable that G_DEFINE_TYPE defines.
template <class Self, gpointer& parent_class>
void OwnState(GObjectClass* klass) {
  klass->finalize = [](GObject* object) {
    delete reinterpret_cast<Self*>(object)->state;
    G_OBJECT_CLASS(parent_class)->finalize(object);
  };
}

/// Calls OwnState() and ServeProperties(), which nearly every element needs.
template <class Self, gpointer& parent_class, auto& table,
          void (*changed)(GObject*, GParamSpec*) = NothingMore>
void ServeState(gpointer klass) {
  OwnState<Self, parent_class>(G_OBJECT_CLASS(klass));
  ServeProperties<Self, table, changed>(G_OBJECT_CLASS(klass));
}

}  // namespace lidar::gst
