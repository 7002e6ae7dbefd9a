#include "engine/cluster/mesh_messages.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "engine/core/bytes.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/out_of_memory.hpp"

namespace psygen::cluster {
namespace {

using synthesis::RemoteMesh;

constexpr std::size_t kHashBytes = sizeof(std::uint64_t);
// Size of an answer's header, a multiple of the alignment of vertices: kind, answer, 6 unused
// bytes, ticket, seconds, bounds, size of the mesh, 8 unused bytes.
constexpr std::size_t kAnswerHeader = 64;

template <class... T>
Bytes begin(MessageKind kind, T... values) {
  Bytes bytes;
  core::put(bytes, kind, values...);
  return bytes;
}

Bytes sealed(Bytes bytes) {
  core::put(bytes, core::hash_bytes(bytes));
  return bytes;
}

void write_answer_header(std::span<std::byte> to, std::uint64_t ticket, RemoteMesh::Answer answer,
                         double seconds, const core::Bounds& tight, std::uint64_t mesh_bytes) {
  Bytes header = begin(MessageKind::kAnswer, answer);
  header.resize(8);
  core::put(header, ticket, seconds, tight.min, tight.max, mesh_bytes);
  header.resize(kAnswerHeader);
  std::ranges::copy(header, to.begin());
}

bool read_answer(core::ByteReader& in, Message& message, Bytes&& bytes) {
  RemoteMesh& mesh = message.mesh;
  in.read(mesh.answer);
  in.get_text(6);
  std::uint64_t mesh_bytes = 0;
  in.read(message.ticket, mesh.seconds, mesh.tight.min, mesh.tight.max, mesh_bytes);
  in.get_text(8);
  if (in.failed() || mesh.answer > RemoteMesh::Answer::kNone || !std::isfinite(mesh.seconds))
    return false;
  if (mesh.answer == RemoteMesh::Answer::kMade) {
    if (mesh_bytes != in.left()) return false;
    mesh.storage = std::move(bytes);
    mesh.bytes = std::span(mesh.storage).subspan(kAnswerHeader, mesh_bytes);
  } else {
    mesh.error = in.get_text(in.left());
  }
  return true;
}

bool read_make(core::ByteReader& in, MakeMessage& make) {
  in.read(make.ticket, make.parameters_hash);
  for (std::size_t i = 0; i < models::Parameters::kMaxCount; ++i)
    make.parameters.set_integer(i, in.get<std::int64_t>());
  in.read(make.level, make.size.vertex_count, make.size.index_count, make.size.shared_indices,
          make.size.layout);
  make.type = in.get_text(in.left());
  return !in.failed() && make.size.layout <= core::VertexLayout::kObject;
}

}  // namespace

Bytes ping_message(std::uint64_t ticket, std::uint64_t wanted_bytes) {
  return sealed(begin(MessageKind::kPing, ticket, wanted_bytes));
}

Bytes pong_message(std::uint64_t ticket, std::uint64_t count) {
  Bytes bytes = begin(MessageKind::kPong, ticket);
  bytes.resize(bytes.size() + count);
  return sealed(std::move(bytes));
}

Bytes make_message(const MakeMessage& request) {
  Bytes bytes = begin(MessageKind::kMake, request.ticket, request.parameters_hash);
  for (std::size_t i = 0; i < models::Parameters::kMaxCount; ++i)
    core::put(bytes, request.parameters.integer(i));
  const models::MeshSize& size = request.size;
  core::put(bytes, request.level, size.vertex_count, size.index_count, size.shared_indices,
            size.layout);
  core::put_all(bytes, std::span<const char>(request.type));
  return sealed(std::move(bytes));
}

Bytes plain_message(MessageKind kind) {
  return sealed(begin(kind));
}

core::Result<AnswerWriter> AnswerWriter::make(std::uint64_t ticket, const models::MeshSize& size) {
  AnswerWriter writer;
  writer.size_ = size;
  const std::size_t mesh_bytes = size.bytes();
  try {
    writer.bytes_.reserve(kAnswerHeader + mesh_bytes + kHashBytes);
    writer.bytes_.resize(kAnswerHeader + mesh_bytes);
  } catch (const std::bad_alloc&) {
    return core::fail(core::ErrorCode::kOutOfMemory,
                      core::out_of_memory("a mesh for another rank"));
  }
  write_answer_header(writer.bytes_, ticket, RemoteMesh::Answer::kMade, 0, {}, mesh_bytes);
  return writer;
}

models::MeshView AnswerWriter::mesh() {
  return models::mesh_view(bytes_.data() + kAnswerHeader, size_);
}

Bytes AnswerWriter::finish(const core::Bounds& tight, double seconds) && {
  core::ByteReader header{std::span<const std::byte>(bytes_).subspan(8)};
  const auto ticket = header.get<std::uint64_t>();
  write_answer_header(bytes_, ticket, RemoteMesh::Answer::kMade, seconds, tight, size_.bytes());
  return sealed(std::move(bytes_));
}

Bytes failed_message(std::uint64_t ticket, RemoteMesh::Answer answer, const std::string& error) {
  Bytes bytes(kAnswerHeader);
  write_answer_header(bytes, ticket, answer, 0, {}, 0);
  core::put_all(bytes, std::span<const char>(error));
  return sealed(std::move(bytes));
}

std::optional<Message> read_message(Bytes&& bytes) {
  if (bytes.size() < 1 + kHashBytes) return std::nullopt;
  const std::span all(bytes);
  const auto body = all.first(bytes.size() - kHashBytes);
  core::ByteReader seal(std::span<const std::byte>(all.last(kHashBytes)));
  if (seal.get<std::uint64_t>() != core::hash_bytes(body)) return std::nullopt;
  core::ByteReader in{std::span<const std::byte>(body)};
  Message message;
  message.kind = in.get<MessageKind>();
  bool whole = true;
  switch (message.kind) {
    case MessageKind::kPing:
      in.read(message.ticket, message.wanted_bytes);
      whole = !in.failed();
      break;
    case MessageKind::kPong:
      in.read(message.ticket);
      whole = !in.failed();
      break;
    case MessageKind::kMake:
      whole = read_make(in, message.make);
      break;
    case MessageKind::kAnswer:
      whole = read_answer(in, message, std::move(bytes));
      break;
    case MessageKind::kEnd:
    case MessageKind::kBye:
      break;
    default:
      whole = false;
  }
  if (!whole) return std::nullopt;
  return message;
}

}  // namespace psygen::cluster
