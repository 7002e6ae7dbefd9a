// What rank 0 of a flight and the ranks that make meshes for it tell each other, as bytes. Every
// message ends with a hash of all before it; what does not fit is refused. A request carries all
// that a mesh depends on, so the receiver needs the type and no world. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/cluster/peers.hpp"
#include "engine/models/model_type.hpp"
#include "engine/synthesis/remote_modelers.hpp"

namespace psygen::cluster {

enum class MessageKind : std::uint8_t {
  kPing,    // → answer with so many bytes
  kPong,    //
  kMake,    // → a mesh
  kAnswer,  // the mesh, or why there is none
  kEnd,     // → no more requests
  kBye,     // what kEnd is answered with
};

// One mesh to make.
struct MakeMessage {
  std::uint64_t ticket = 0;           // of the request; comes back with the answer
  std::string type;                   // its name
  std::uint64_t parameters_hash = 0;  // with the identity of the type
  models::Parameters parameters;      // without edits
  std::uint16_t level = 0;
  models::MeshSize size;
};

// Any message, of which only what its kind has is set.
struct Message {
  MessageKind kind = MessageKind::kBye;
  std::uint64_t ticket = 0;        // kPing, kPong, kAnswer
  std::uint64_t wanted_bytes = 0;  // kPing
  MakeMessage make;                // kMake
  synthesis::RemoteMesh mesh;      // kAnswer; its storage is the message
};

Bytes ping_message(std::uint64_t ticket, std::uint64_t wanted_bytes);
Bytes pong_message(std::uint64_t ticket, std::uint64_t bytes);
Bytes make_message(const MakeMessage& request);
// kEnd or kBye.
Bytes plain_message(MessageKind kind);

// The answer to a request, whose mesh is written in place: begin with the size, write into mesh(),
// then finish. Needs memory for one mesh.
class AnswerWriter {
 public:
  // Fails with kOutOfMemory.
  static core::Result<AnswerWriter> make(std::uint64_t ticket, const models::MeshSize& size);
  models::MeshView mesh();
  Bytes finish(const core::Bounds& tight, double seconds) &&;

 private:
  Bytes bytes_;
  models::MeshSize size_;
};
// An answer without a mesh: `error` of the type, or kNone.
Bytes failed_message(std::uint64_t ticket, synthesis::RemoteMesh::Answer answer,
                     const std::string& error);

// What the bytes say; nothing where they are damaged.
std::optional<Message> read_message(Bytes&& bytes);

}  // namespace psygen::cluster
