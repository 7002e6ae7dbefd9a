#include "engine/image/picture_codec.hpp"

#include <gtest/gtest.h>

#include "tests/faults.hpp"

namespace psygen::image {
namespace {

TEST(PictureCodec, IsNotLoadedIfItsLibrariesCannotStartThreads) {
  EXPECT_TRUE(check_room_for_codec());
  const FewThreads few(2);
  const auto room = check_room_for_codec();
  ASSERT_FALSE(room);
  EXPECT_EQ(room.error().code, core::ErrorCode::kOutOfMemory);
  EXPECT_NE(room.error().message.find("threads"), std::string::npos);
}

TEST(PictureCodec, IsLoadedOnce) {
  const auto codec = picture_codec();
  ASSERT_TRUE(codec) << codec.error().message;
  const FewThreads few(0);
  EXPECT_EQ(picture_codec().value(), *codec);
}

}  // namespace
}  // namespace psygen::image
