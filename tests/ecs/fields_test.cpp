// Fields are described once and reached by offset.
#include "ecs/fields.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "tests/ecs/described.hpp"

namespace psygen::ecs::test {
namespace {
// A type whose first construction fails.
struct Reluctant {
  static inline int made = 0;
  int value = 0;
  Reluctant() {
    if (made++ == 0) throw std::runtime_error("not yet");
  }
};
}  // namespace
}  // namespace psygen::ecs::test

template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::Reluctant> {
  static constexpr std::string_view name = "reluctant";
  static constexpr auto fields = std::tuple{field("value", &test::Reluctant::value)};
};

namespace psygen::ecs::test {
namespace {

const FieldDescription* find(const TypeDescription& type, std::string_view name) {
  for (const FieldDescription& field : type.fields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

TEST(Fields, EachHasNameKindAndNotesInTheListedOrder) {
  const TypeDescription* type = describe<Creature>();
  ASSERT_NE(type, nullptr);
  ASSERT_EQ(type->fields.size(), 10U);
  using enum FieldKind;
  const FieldKind kinds[] = {kString, kStruct, kArray,    kList, kList,
                             kEntity, kReal,   kUnsigned, kBool, kSigned};
  for (std::size_t i = 0; i < type->fields.size(); ++i)
    EXPECT_EQ(type->fields[i].type->kind, kinds[i]) << type->fields[i].name;
  EXPECT_EQ(find(*type, "place")->notes.unit, "m");
  EXPECT_EQ(find(*type, "place")->notes.doc, "its position");
  EXPECT_EQ(find(*type, "age")->notes.max, 100);
  EXPECT_EQ(find(*type, "sizes")->type->count, 3U);
  EXPECT_EQ(find(*type, "path")->type->element->fields.size(), 3U);
}

TEST(Fields, ValuesAreReachedByOffset) {
  Creature creature;
  auto* bytes = reinterpret_cast<std::byte*>(&creature);
  const TypeDescription& type = *describe<Creature>();
  const double age_s = 12;
  std::memcpy(bytes + find(type, "age")->offset_bytes, &age_s, sizeof(age_s));
  EXPECT_EQ(creature.age_s, 12);
  const FieldDescription& place = *find(type, "place");
  const float z = 3;
  std::memcpy(bytes + place.offset_bytes + find(*place.type, "z")->offset_bytes, &z, sizeof(z));
  EXPECT_EQ(creature.place.z, 3);
  const FieldDescription& name = *find(type, "name");
  std::memcpy(name.type->resize(bytes + name.offset_bytes, 3), "fox", 3);
  EXPECT_EQ(creature.name, "fox");
  const FieldDescription& path = *find(type, "path");
  path.type->resize(bytes + path.offset_bytes, 2);
  EXPECT_EQ(creature.path.size(), 2U);
  EXPECT_EQ(path.type->length(bytes + path.offset_bytes), 2U);
}

TEST(Fields, ATypeWithoutTraitsIsNotDescribedAndAnEmptyOneHasNoFields) {
  EXPECT_EQ(describe<Position>(), nullptr);
  ASSERT_NE(describe<Hidden>(), nullptr);
  EXPECT_TRUE(describe<Hidden>()->fields.empty());
}

// Runs in a separate process, because a description stays for the rest of the process.
void describe_the_reluctant_twice_and_exit() {
  bool threw = false;
  try {
    describe<Reluctant>();
  } catch (const std::runtime_error&) {
    threw = true;
  }
  const TypeDescription* type = describe<Reluctant>();
  std::_Exit(threw && type != nullptr && type->fields.size() == 1 ? 0 : 1);
}

TEST(Fields, AThrowingConstructorIsRetriedOnTheNextUse) {
  EXPECT_EXIT(describe_the_reluctant_twice_and_exit(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace psygen::ecs::test
