// Describes the fields of a type once, with names, units and ranges, for snapshots, editors and
// messages. Values are reached by offset, so only `field` and `describe` need templates. Not a
// serialiser (snapshot.hpp is) and not reflection: a field that is not listed is unknown.
// Descriptions are built on first use, never freed, and safe to read from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "ecs/check.hpp"
#include "ecs/entity.hpp"

namespace psygen::ecs {

// Describes a type. Specialise it to override the defaults; every member is optional:
//   static constexpr std::string_view name = "mesh";   default: the type's name
//   static constexpr bool tracked = true;              default: false, no change bits
//   static constexpr bool sparse = true;               default: false, a column of tables
//   static constexpr auto fields = std::tuple{ecs::field("id", &Mesh::id), ...};
// A component without `fields` is transient: snapshots record which entities have it, but not its
// value.
template <class C>
struct ComponentTraits {};

// Kinds of values. Snapshots store these numbers.
enum class FieldKind : std::uint8_t {
  kBool,
  kSigned,    // 1, 2, 4 or 8 bytes; also enumerations
  kUnsigned,  // as kSigned
  kReal,      // float or double
  kEntity,
  kString,  // std::string
  kStruct,  // fields one after the other
  kArray,   // std::array: `count` elements
  kList,    // std::vector: any number of elements
};

struct TypeDescription;

// Notes for editors beyond the type. Ranges bound sliders; they are not enforced. The strings have
// static storage.
struct FieldNotes {
  std::string_view unit = {};  // "m", "rad"; empty: none
  std::string_view doc = {};
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

// One field of a struct. `name` has static storage; `type` is never freed.
struct FieldDescription {
  std::string_view name;
  std::size_t offset_bytes = 0;  // from the start of the struct
  const TypeDescription* type = nullptr;
  FieldNotes notes;
};

// One type: its kind, its size and its elements or fields. Pointers are null if the kind does not
// use them.
struct TypeDescription {
  FieldKind kind = FieldKind::kStruct;
  std::size_t size_bytes = 0;
  std::size_t count = 0;                      // of a kArray
  const TypeDescription* element = nullptr;   // of a kArray or kList
  std::vector<FieldDescription> fields = {};  // of a kStruct
  // Of a kString or kList: the number of elements, the address of the first element, and a function
  // that resizes it to `count` elements and returns the address of the first.
  std::size_t (*length)(const std::byte* value) = nullptr;
  const std::byte* (*elements)(const std::byte* value) = nullptr;
  std::byte* (*resize)(std::byte* value, std::size_t count) = nullptr;
};

// A field and its name. Descriptions keep the order of ComponentTraits<C>::fields.
template <class C, class T>
struct Field {
  std::string_view name;
  T C::*member;
  FieldNotes notes;
};
// Makes a Field. The strings must have static storage.
template <class C, class T>
constexpr Field<C, T> field(std::string_view name, T C::*member, FieldNotes notes = {}) {
  return {name, member, notes};
}

namespace detail {

// A type whose ComponentTraits list its fields.
template <class T>
concept HasFields = requires {
  ComponentTraits<T>::fields;
};

// Returns the description of T, built on first use. Ends the program if T contains itself. Passes
// on an exception of T's constructor; the next use tries again. Any thread.
template <class T>
const TypeDescription& description_of();

// True if T is a std::array, or a std::vector other than std::vector<bool>.
template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;
template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = !std::is_same_v<T, bool>;

// The types that a field may have.
template <class T>
concept Describable = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, Entity> ||
    std::is_same_v<T, std::string> || kIsArray<T> || kIsList<T> || HasFields<T> ||
    std::is_empty_v<T>;

// True if a value of T takes bytes in a snapshot, which elements of lists and arrays must.
template <class T>
constexpr bool has_content() {
  if constexpr (HasFields<T>) return std::tuple_size_v<decltype(ComponentTraits<T>::fields)> > 0;
  if constexpr (kIsArray<T>) return std::tuple_size_v<T> > 0;
  return !std::is_empty_v<T>;
}

// Describes a std::string or std::vector.
template <class T>
TypeDescription describe_list(FieldKind kind) {
  static_assert(has_content<typename T::value_type>(),
                "elements of a list must take bytes in a snapshot");
  TypeDescription result;
  result.kind = kind;
  result.size_bytes = sizeof(T);
  result.element = &description_of<typename T::value_type>();
  result.length = [](const std::byte* value) { return reinterpret_cast<const T*>(value)->size(); };
  result.elements = [](const std::byte* value) {
    return reinterpret_cast<const std::byte*>(reinterpret_cast<const T*>(value)->data());
  };
  result.resize = [](std::byte* value, std::size_t count) {
    T& list = *reinterpret_cast<T*>(value);
    list.resize(count);
    return reinterpret_cast<std::byte*>(list.data());
  };
  return result;
}

// Describes a struct. Finds offsets on a default-constructed T.
template <class T>
TypeDescription describe_struct() {
  TypeDescription result;
  result.size_bytes = sizeof(T);
  if constexpr (HasFields<T>) {
    const auto model = std::make_unique<const T>();
    const auto add = [&]<class M>(const Field<T, M>& f) {
      const auto* base = reinterpret_cast<const std::byte*>(model.get());
      const auto* at = reinterpret_cast<const std::byte*>(std::addressof(model.get()->*f.member));
      result.fields.push_back(
          {f.name, static_cast<std::size_t>(at - base), &description_of<M>(), f.notes});
    };
    std::apply([&](const auto&... each) { (add(each), ...); }, ComponentTraits<T>::fields);
  }
  return result;
}

// Builds the description of T. Fails to compile if T is not Describable.
template <class T>
TypeDescription make_description() {
  static_assert(Describable<T>,
                "a field is a number, bool, enumeration, Entity, std::string, std::array or "
                "std::vector of these, or a type whose ComponentTraits list its fields");
  if constexpr (std::is_same_v<T, std::string>) return describe_list<T>(FieldKind::kString);
  if constexpr (kIsList<T>) return describe_list<T>(FieldKind::kList);
  if constexpr (kIsArray<T>) {
    static_assert(has_content<T>() && has_content<typename T::value_type>(),
                  "elements of an array must take bytes in a snapshot");
    TypeDescription result;
    result.kind = FieldKind::kArray;
    result.size_bytes = sizeof(T);
    result.count = std::tuple_size_v<T>;
    result.element = &description_of<typename T::value_type>();
    return result;
  }
  if constexpr (std::is_same_v<T, bool>) return {FieldKind::kBool, sizeof(T)};
  if constexpr (std::is_floating_point_v<T>) return {FieldKind::kReal, sizeof(T)};
  if constexpr (std::is_enum_v<T>) return make_description<std::underlying_type_t<T>>();
  if constexpr (std::is_integral_v<T>) {
    return {std::is_signed_v<T> ? FieldKind::kSigned : FieldKind::kUnsigned, sizeof(T)};
  }
  if constexpr (std::is_same_v<T, Entity>) return {FieldKind::kEntity, sizeof(T)};
  return describe_struct<T>();
}

template <class T>
const TypeDescription& description_of() {
  // True while this thread builds the description, also until a constructor of T throws.
  thread_local bool under_way = false;
  if (under_way) give_up("a described type contains itself");
  struct UnderWay {
    UnderWay() { under_way = true; }
    ~UnderWay() { under_way = false; }
  };
  const UnderWay mark;
  static const TypeDescription description = make_description<T>();
  return description;
}

// Like description_of, but null for a type that lists no fields and is not empty.
template <class C>
const TypeDescription* describe_component() {
  static_assert(
      !HasFields<C> || requires { ComponentTraits<C>::name; },
      "a component with fields needs ComponentTraits<>::name: compilers disagree about the "
      "default, and snapshots keep it");
  if constexpr (HasFields<C> || std::is_empty_v<C>) return &description_of<C>();
  return nullptr;
}

}  // namespace detail

// Returns the description of a component; null if its ComponentTraits list no fields. A component
// without members has a description without fields. Never freed. Safe from any thread.
template <class C>
const TypeDescription* describe() {
  return detail::describe_component<C>();
}

}  // namespace psygen::ecs
