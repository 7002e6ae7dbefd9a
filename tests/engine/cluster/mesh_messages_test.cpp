#include "engine/cluster/mesh_messages.hpp"

#include <gtest/gtest.h>

namespace psygen::cluster {
namespace {

using synthesis::RemoteMesh;

MakeMessage request() {
  MakeMessage make{7, "fence", 0x1234567890ABCDEF, {}, 2, {10, 36, 0, core::VertexLayout::kModel}};
  make.parameters.set_real(3, 1.5);
  make.parameters.set_integer(15, -9);
  return make;
}

Bytes answer() {
  auto writer = AnswerWriter::make(7, request().size).value();
  const models::MeshView mesh = writer.mesh();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.vertices[i] = static_cast<std::byte>(i);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    mesh.indices[i] = static_cast<std::uint16_t>(1000 + i);
  return std::move(writer).finish({{-1, -2, -3}, {4, 5, 6}}, 0.25);
}

TEST(MeshMessages, SurviveARoundTrip) {
  auto read = read_message(make_message(request()));
  ASSERT_TRUE(read && read->kind == MessageKind::kMake);
  EXPECT_EQ(read->make.ticket, 7u);
  EXPECT_EQ(read->make.type, "fence");
  EXPECT_EQ(read->make.parameters_hash, request().parameters_hash);
  EXPECT_EQ(read->make.parameters, request().parameters);
  EXPECT_EQ(read->make.level, 2);
  EXPECT_EQ(read->make.size, request().size);

  read = read_message(answer());
  ASSERT_TRUE(read && read->kind == MessageKind::kAnswer);
  EXPECT_EQ(read->ticket, 7u);
  EXPECT_EQ(read->mesh.answer, RemoteMesh::Answer::kMade);
  EXPECT_EQ(read->mesh.tight, (core::Bounds{{-1, -2, -3}, {4, 5, 6}}));
  EXPECT_EQ(read->mesh.seconds, 0.25);
  ASSERT_EQ(read->mesh.bytes.size(), 10u * 16 + 36 * 2);
  EXPECT_EQ(read->mesh.bytes[159], std::byte{159});
  EXPECT_EQ(read->mesh.bytes[160], std::byte{1000 & 0xFF});

  read = read_message(failed_message(9, RemoteMesh::Answer::kFailed, "fence level 2 threw: no"));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->ticket, 9u);
  EXPECT_EQ(read->mesh.error, "fence level 2 threw: no");
  read = read_message(ping_message(3, 1000));
  ASSERT_TRUE(read && read->kind == MessageKind::kPing);
  EXPECT_EQ(read->wanted_bytes, 1000u);
  EXPECT_EQ(read_message(plain_message(MessageKind::kEnd))->kind, MessageKind::kEnd);
}

TEST(MeshMessages, AnyChangedOrMissingByteIsDetected) {
  for (const Bytes& whole :
       {make_message(request()), answer(), pong_message(1, 5), plain_message(MessageKind::kBye)}) {
    for (std::size_t i = 0; i < whole.size(); ++i) {
      Bytes changed = whole;
      changed[i] ^= std::byte{0x40};
      EXPECT_FALSE(read_message(std::move(changed))) << i;
      EXPECT_FALSE(
          read_message(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i))))
          << i;
    }
  }
}

}  // namespace
}  // namespace psygen::cluster
