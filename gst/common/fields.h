// SPDX-License-Identifier: LGPL-2.1-or-later
// Accesses fields of structs as GValues, for tables of properties and statistics.
#pragma once
#include <gst/gst.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "src/base/units.h"

namespace lidar::gst {

/// The parameters of a property besides its type and default. If `min` and `max` are both 0, the
/// property accepts all values of its type.
struct SpecArgs {
  const char* name;
  const char* blurb;
  GParamFlags flags;
  gdouble min = 0;
  gdouble max = 0;
};

/// Defines how a C++ type is represented as a GValue. Spec() creates a property of this type, and
/// Get() and Set() copy values.
template <class T, class = void>
struct Kind;

/// The implementation for numbers. GObject stores them as `Wire`.
template <class Wire, GType type, auto new_spec, auto get_value, auto set_value>
struct NumberKind {
  static GType Type() { return type; }
  static GParamSpec* Spec(const SpecArgs& a, Wire initial) {
    using Limits = std::numeric_limits<Wire>;
    const bool all = a.min == 0 && a.max == 0;
    return new_spec(a.name, a.name, a.blurb, all ? Limits::lowest() : Clamp(a.min),
                    all ? Limits::max() : Clamp(a.max), initial, a.flags);
  }
  static void Set(Wire* field, const GValue* v) { *field = get_value(v); }
  static void Get(Wire value, GValue* v) { set_value(v, value); }
  static Wire Clamp(gdouble x) {
    using Limits = std::numeric_limits<Wire>;
    if (x >= static_cast<gdouble>(Limits::max())) return Limits::max();
    return x <= static_cast<gdouble>(Limits::lowest()) ? Limits::lowest() : static_cast<Wire>(x);
  }
};
template <>
struct Kind<guint>
    : NumberKind<guint, G_TYPE_UINT, g_param_spec_uint, g_value_get_uint, g_value_set_uint> {};
template <>
struct Kind<gint>
    : NumberKind<gint, G_TYPE_INT, g_param_spec_int, g_value_get_int, g_value_set_int> {};
template <>
struct Kind<guint64> : NumberKind<guint64, G_TYPE_UINT64, g_param_spec_uint64, g_value_get_uint64,
                                  g_value_set_uint64> {};
template <>
struct Kind<gint64>
    : NumberKind<gint64, G_TYPE_INT64, g_param_spec_int64, g_value_get_int64, g_value_set_int64> {};
template <>
struct Kind<gdouble> : NumberKind<gdouble, G_TYPE_DOUBLE, g_param_spec_double, g_value_get_double,
                                  g_value_set_double> {};

/// A duration is a guint64 in ns. A negative duration is read as 0.
template <>
struct Kind<Duration> {
  static GType Type() { return G_TYPE_UINT64; }
  static GParamSpec* Spec(const SpecArgs& a, Duration initial) {
    return Kind<guint64>::Spec(a, Ns(initial));
  }
  static void Set(Duration* field, const GValue* v) {
    *field = Duration{static_cast<gint64>(std::min<guint64>(g_value_get_uint64(v), G_MAXINT64))};
  }
  static void Get(Duration value, GValue* v) { g_value_set_uint64(v, Ns(value)); }
  static guint64 Ns(Duration d) { return static_cast<guint64>(std::max<gint64>(d.count(), 0)); }
};

/// A size in bytes. It is a guint in properties, and a guint64 in statistics.
template <>
struct Kind<DataSize> {
  static GType Type() { return G_TYPE_UINT64; }
  static GParamSpec* Spec(const SpecArgs& a, DataSize initial) {
    return Kind<guint>::Spec(a, static_cast<guint>(Bytes(initial)));
  }
  static void Set(DataSize* field, const GValue* v) {
    *field = DataSize::Bytes(g_value_get_uint(v));
  }
  static void Get(DataSize value, GValue* v) {
    if (G_VALUE_HOLDS_UINT64(v)) return g_value_set_uint64(v, Bytes(value));
    g_value_set_uint(v, static_cast<guint>(std::min<guint64>(Bytes(value), G_MAXUINT)));
  }
  static guint64 Bytes(DataSize d) { return static_cast<guint64>(std::max<gint64>(d.bytes(), 0)); }
};

/// A rate is a guint in bit/s.
template <>
struct Kind<DataRate> {
  static GType Type() { return G_TYPE_UINT; }
  static GParamSpec* Spec(const SpecArgs& a, DataRate initial) {
    return Kind<guint>::Spec(a, Bps(initial));
  }
  static void Set(DataRate* field, const GValue* v) {
    *field = DataRate::BitsPerSecond(g_value_get_uint(v));
  }
  static void Get(DataRate value, GValue* v) { g_value_set_uint(v, Bps(value)); }
  static guint Bps(DataRate r) { return Kind<guint>::Clamp(r.bits_per_second()); }
};

template <>
struct Kind<bool> {
  static GType Type() { return G_TYPE_BOOLEAN; }
  static GParamSpec* Spec(const SpecArgs& a, bool initial) {
    return g_param_spec_boolean(a.name, a.name, a.blurb, initial, a.flags);
  }
  static void Set(bool* field, const GValue* v) { *field = g_value_get_boolean(v) != FALSE; }
  static void Get(bool value, GValue* v) { g_value_set_boolean(v, value); }
};

/// A string. An empty string is read as NULL, as in GStreamer's own elements.
template <>
struct Kind<std::string> {
  static GType Type() { return G_TYPE_STRING; }
  static GParamSpec* Spec(const SpecArgs& a, const std::string& initial) {
    return g_param_spec_string(a.name, a.name, a.blurb, initial.empty() ? nullptr : initial.c_str(),
                               a.flags);
  }
  static void Set(std::string* field, const GValue* v) {
    const gchar* text = g_value_get_string(v);
    *field = text != nullptr ? text : "";
  }
  static void Get(const std::string& value, GValue* v) {
    g_value_set_string(v, value.empty() ? nullptr : value.c_str());
  }
};
/// A text in static storage, for read-only properties and for statistics.
template <>
struct Kind<const char*> {
  static GType Type() { return G_TYPE_STRING; }
  static GParamSpec* Spec(const SpecArgs& a, const char* initial) {
    return g_param_spec_string(a.name, a.name, a.blurb, initial, a.flags);
  }
  static void Get(const char* value, GValue* v) { g_value_set_static_string(v, value); }
};

/// Returns the GType of a boxed type or an object type. It has a specialisation for each type that
/// is used in a table.
template <class T>
GType GTypeOf();
template <>
inline GType GTypeOf<GstCaps>() {
  return GST_TYPE_CAPS;
}
template <>
inline GType GTypeOf<GstStructure>() {
  return GST_TYPE_STRUCTURE;
}

/// Boxed types and objects. A field that can be set is a shared_ptr. The result of a function is a
/// unique_ptr.
template <class Pointer>
struct Kind<Pointer, std::void_t<typename Pointer::element_type, decltype(Pointer().get())>> {
  using T = typename Pointer::element_type;
  static GType Type() { return GTypeOf<T>(); }
  static bool IsObject() { return g_type_is_a(Type(), G_TYPE_OBJECT) != FALSE; }
  static GParamSpec* Spec(const SpecArgs& a, const Pointer&) {
    return IsObject() ? g_param_spec_object(a.name, a.name, a.blurb, Type(), a.flags)
                      : g_param_spec_boxed(a.name, a.name, a.blurb, Type(), a.flags);
  }
  static void Set(Pointer* field, const GValue* v) {
    if (IsObject())
      field->reset(static_cast<T*>(g_value_dup_object(v)), [](T* p) {
        if (p != nullptr) g_object_unref(p);
      });
    else
      field->reset(static_cast<T*>(g_value_dup_boxed(v)), [](T* p) {
        if (p != nullptr) g_boxed_free(GTypeOf<T>(), p);
      });
  }
  static void Get(const Pointer& value, GValue* v) {
    IsObject() ? g_value_set_object(v, value.get()) : g_value_set_boxed(v, value.get());
  }
};
using SharedCaps = std::shared_ptr<GstCaps>;
using SharedStructure = std::shared_ptr<GstStructure>;

/// A path through nested structs to a field, for example
/// At<&Settings::parameters, &Parameters::mss>.
template <auto... path>
struct AtPath {};
template <auto... path>
inline constexpr AtPath<path...> At{};

/// A field with an enumeration. Its C++ type is an enumeration type or gint. `type` returns its
/// GType.
template <class S, class E = gint>
struct EnumField {
  E S::*field;
  GType (*type)();
};

/// Describes how a value is read and written. The value is a field of an `S`, the result of a
/// function of an `S` or of its object, or a property of a child of the object.
template <class S>
class Field {
 public:
  template <class T>
  Field(T S::*member)
      : member_(reinterpret_cast<Member>(member)), ops_(&kReadWrite<T, ByMember<T>>) {}
  template <auto... path>
  Field(AtPath<path...>) : ops_(&kReadWrite<typename ByPath<path...>::Type, ByPath<path...>>) {}
  template <class T>
  Field(T (*work_out)(const S&))
      : function_(reinterpret_cast<Function>(work_out)), ops_(&kReadOnly<T, OfStruct<T>>) {}
  template <class T>
  Field(T (*read)(GObject*))
      : function_(reinterpret_cast<Function>(read)),
        of_object_(true),
        ops_(&kReadOnly<T, OfObject<T>>) {}
  template <class E>
  Field(const EnumField<S, E>& e)
      : member_(reinterpret_cast<Member>(e.field)), type_(e.type), ops_(&kEnum<E>) {}

  /// A field that `row` describes, in the struct at the end of the path. `row` must have static
  /// storage.
  template <class Row, auto... path>
  Field(const Row* row, AtPath<path...>) : row_(row), ops_(&kWithin<Row, ByPath<path...>>) {}
  /// A property of a child. `row` describes this property in the table of the child. The default
  /// value is the field of `defaults`. `row` and `defaults` must have static storage.
  template <class Row>
  Field(const Row* row, const typename Row::Struct* defaults, GObject* (*child)(GObject*))
      : function_(reinterpret_cast<Function>(child)),
        row_(row),
        defaults_(defaults),
        of_object_(true),
        ops_(row->field.read_only() ? &kChildRead<Row> : &kChild<Row>) {}

  bool read_only() const { return ops_->set == nullptr; }
  /// Returns true if Get() and Set() use the object and not the struct.
  bool of_object() const { return of_object_; }

  /// Returns the GType of the value in statistics.
  GType type() const { return ops_->type(*this); }
  GParamSpec* Spec(const SpecArgs& a, const S& initial) const {
    return ops_->spec(*this, a, initial);
  }
  void Set(S* s, GObject* object, const GValue* v) const { ops_->set(*this, s, object, v); }
  void Get(const S* s, GObject* object, GValue* v) const { ops_->get(*this, s, object, v); }
  /// Adds the value in `part` to the value in `sum`. Does nothing if the field is not a number.
  void Add(const S& part, S* sum) const {
    if (ops_->add != nullptr) ops_->add(*this, part, sum);
  }

 private:
  using Member = char S::*;
  using Function = void (*)();
  /// The operations for a type. They cast the stored pointers back to their original types.
  struct Ops {
    GType (*type)(const Field&);
    GParamSpec* (*spec)(const Field&, const SpecArgs&, const S&);
    void (*set)(const Field&, S*, GObject*, const GValue*);  // NULL if read-only
    void (*get)(const Field&, const S*, GObject*, GValue*);
    void (*add)(const Field&, const S& part, S* sum);  // NULL if not a number
  };

  template <class T>
  struct ByMember {
    template <class Struct>
    static auto& In(const Field& f, Struct& s) {
      return s.*reinterpret_cast<T S::*>(f.member_);
    }
  };
  template <auto... path>
  struct ByPath {
    template <class Struct>
    static auto& In(const Field&, Struct& s) {
      return (s.*....*path);
    }
    using Type = std::remove_reference_t<decltype(In(std::declval<Field>(), std::declval<S&>()))>;
  };
  template <class T>
  struct OfStruct {
    static T Read(const Field& f, const S* s, GObject*) {
      return reinterpret_cast<T (*)(const S&)>(f.function_)(*s);
    }
  };
  template <class T>
  struct OfObject {
    static T Read(const Field& f, const S*, GObject* object) {
      return reinterpret_cast<T (*)(GObject*)>(f.function_)(object);
    }
  };

  template <class T, class Way>
  static void AddTo([[maybe_unused]] const Field& f, [[maybe_unused]] const S& part,
                    [[maybe_unused]] S* sum) {
    constexpr bool kAmount = std::is_same_v<T, DataSize> || std::is_same_v<T, Duration>;
    if constexpr (kAmount || (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>))
      Way::In(f, *sum) += Way::In(f, part);
  }

  template <class T, class Way>
  static constexpr Ops kReadWrite = {
      [](const Field&) { return Kind<T>::Type(); },
      [](const Field& f, const SpecArgs& a, const S& s) { return Kind<T>::Spec(a, Way::In(f, s)); },
      [](const Field& f, S* s, GObject*, const GValue* v) { Kind<T>::Set(&Way::In(f, *s), v); },
      [](const Field& f, const S* s, GObject*, GValue* v) { Kind<T>::Get(Way::In(f, *s), v); },
      AddTo<T, Way>};
  template <class T, class Way>
  static constexpr Ops kReadOnly = {
      [](const Field&) { return Kind<T>::Type(); },
      [](const Field&, const SpecArgs& a, const S&) { return Kind<T>::Spec(a, T{}); }, nullptr,
      [](const Field& f, const S* s, GObject* object, GValue* v) {
        Kind<T>::Get(Way::Read(f, s, object), v);
      },
      nullptr};
  // This is a function, because a lambda that initialises a constant cannot use later declarations.
  static GType EnumType(const Field& f) { return f.type_(); }
  template <class E>
  static constexpr Ops kEnum = {EnumType,
                                [](const Field& f, const SpecArgs& a, const S& s) {
                                  const auto initial = static_cast<gint>(ByMember<E>::In(f, s));
                                  return g_param_spec_enum(a.name, a.name, a.blurb, EnumType(f),
                                                           initial, a.flags);
                                },
                                [](const Field& f, S* s, GObject*, const GValue* v) {
                                  ByMember<E>::In(f, *s) = static_cast<E>(g_value_get_enum(v));
                                },
                                [](const Field& f, const S* s, GObject*, GValue* v) {
                                  g_value_set_enum(v, static_cast<gint>(ByMember<E>::In(f, *s)));
                                },
                                nullptr};

  template <class Row>
  static const Row& RowOf(const Field& f) {
    return *static_cast<const Row*>(f.row_);
  }
  static GObject* ChildOf(const Field& f, GObject* object) {
    return reinterpret_cast<GObject* (*)(GObject*)>(f.function_)(object);
  }
  template <class Row>
  static GParamSpec* ChildSpec(const Field& f, const SpecArgs& a, const S&) {
    using Struct = typename Row::Struct;
    return RowOf<Row>(f).field.Spec(a, *static_cast<const Struct*>(f.defaults_));
  }
  template <class Row>
  static void SetChild(const Field& f, S*, GObject* object, const GValue* v) {
    if (GObject* child = ChildOf(f, object)) g_object_set_property(child, RowOf<Row>(f).name, v);
  }
  template <class Row>
  static void GetChild(const Field& f, const S*, GObject* object, GValue* v) {
    if (GObject* child = ChildOf(f, object)) g_object_get_property(child, RowOf<Row>(f).name, v);
  }
  template <class Row, class Way>
  static constexpr Ops kWithin = {nullptr,
                                  [](const Field& f, const SpecArgs& a, const S& s) {
                                    return RowOf<Row>(f).field.Spec(a, Way::In(f, s));
                                  },
                                  [](const Field& f, S* s, GObject* object, const GValue* v) {
                                    RowOf<Row>(f).field.Set(&Way::In(f, *s), object, v);
                                  },
                                  [](const Field& f, const S* s, GObject* object, GValue* v) {
                                    RowOf<Row>(f).field.Get(&Way::In(f, *s), object, v);
                                  },
                                  nullptr};
  template <class Row>
  static constexpr Ops kChild = {nullptr, ChildSpec<Row>, SetChild<Row>, GetChild<Row>, nullptr};
  template <class Row>
  static constexpr Ops kChildRead = {nullptr, ChildSpec<Row>, nullptr, GetChild<Row>, nullptr};

  Member member_ = nullptr;
  Function function_ = nullptr;
  const void* row_ = nullptr;
  const void* defaults_ = nullptr;
  GType (*type_)() = nullptr;
  bool of_object_ = false;
  const Ops* ops_;
};

}  // namespace lidar::gst
