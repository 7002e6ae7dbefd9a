#include "engine/platform/keys.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace psygen::platform {
namespace {

TEST(Keys, EveryKeyHasAUniqueName) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kKeys; ++i) {
    const Key key = static_cast<Key>(i);
    EXPECT_FALSE(name_of(key).empty());
    EXPECT_TRUE(names.insert(name_of(key)).second) << name_of(key);
  }
  EXPECT_EQ(name_of(Key::kKeypad0), "Keypad 0");
  EXPECT_EQ(name_of(Key::kF25), "F25");
  EXPECT_EQ(name_of(Key::kPause), "Pause");
}

TEST(Keys, ButtonsHaveUniqueNames) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kMouseButtons; ++i)
    EXPECT_TRUE(names.insert(name_of(static_cast<MouseButton>(i))).second);
  for (std::size_t i = 0; i < kPadButtons; ++i)
    EXPECT_TRUE(names.insert(name_of(static_cast<PadButton>(i))).second);
  EXPECT_EQ(name_of(MouseButton::k8), "Mouse 8");
  EXPECT_EQ(name_of(PadButton::kLeft), "Gamepad Left");
}

}  // namespace
}  // namespace psygen::platform
