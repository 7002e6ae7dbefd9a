#include "editor/pictures/picture_request.hpp"

#include <gtest/gtest.h>

namespace psygen::editor {
namespace {

TEST(PictureRequest, ALineTransfersARequestUnchanged) {
  PictureRequest request;
  request.id = 17;
  request.kind = PictureKind::kExportModel;
  request.text = "format = 1\n[world]\nname = \"größer\"\n";
  request.file = "/tmp/a b.toml";
  request.out = "/tmp/out.glb";
  request.size = {320, 200};
  request.place = PicturePlace{{-1.5, 2, 1e6}, 0.25, -0.5, true};
  request.now_s = 12.5;
  request.block_x = -7;
  request.block_z = 9;
  request.index = (1U << 30) + 5;
  request.level = 3;
  const QByteArray line = to_line(request);
  EXPECT_TRUE(line.endsWith('\n'));
  EXPECT_EQ(line.count('\n'), 1);
  const auto read = request_from(line);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->id, request.id);
  EXPECT_EQ(read->kind, request.kind);
  EXPECT_EQ(read->text, request.text);
  EXPECT_EQ(read->file, request.file);
  EXPECT_EQ(read->out, request.out);
  EXPECT_EQ(read->size, request.size);
  ASSERT_TRUE(read->place.has_value());
  EXPECT_EQ(read->place->at_m, request.place->at_m);
  EXPECT_EQ(read->place->yaw, 0.25);
  EXPECT_EQ(read->place->pitch, -0.5);
  EXPECT_TRUE(read->place->above_ground);
  EXPECT_EQ(read->now_s, 12.5);
  EXPECT_EQ(read->block_x, -7);
  EXPECT_EQ(read->block_z, 9);
  EXPECT_EQ(read->index, request.index);
  EXPECT_EQ(read->level, 3);
}

TEST(PictureRequest, AReplyKeepsItsCostAndItsError) {
  PictureReply reply;
  reply.id = 4;
  reply.error = "world.toml:3: \"no\"";
  reply.cost = BlockCost{2, 1e6, 3e7, 0.25, std::nullopt};
  const auto read = reply_from(to_line(reply));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->id, 4U);
  EXPECT_EQ(read->error, reply.error);
  ASSERT_TRUE(read->cost.has_value());
  EXPECT_EQ(read->cost->triangles, 1e6);
  EXPECT_FALSE(read->dropped);
}

TEST(PictureRequest, InvalidLinesAreIgnored) {
  for (const char* line : {"", "{}", "[]", "{\"id\":1", "{\"id\":1,\"kind\":99}", "\xff\xfe", "7"})
    EXPECT_FALSE(request_from(line).has_value()) << line;
  EXPECT_FALSE(reply_from("hello").has_value());
}

TEST(PictureRequest, SizesAreBounded) {
  const auto read = request_from("{\"id\":1,\"kind\":0,\"width\":1000000000,\"height\":-4}");
  ASSERT_TRUE(read.has_value());
  EXPECT_LE(read->size.width, 8192U);
  EXPECT_EQ(read->size.height, 1U);
}

}  // namespace
}  // namespace psygen::editor
