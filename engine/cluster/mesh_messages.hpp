// Messages between rank 0 of a flight and the ranks that make meshes for it, as bytes. Each message
// ends with a hash of its content; a damaged one is rejected. A request holds everything that a
// mesh depends on: the receiver needs the model type, but no world. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/cluster/peers.hpp"
#include "engine/models/model_type.hpp"
#include "engine/synthesis/remote_modelers.hpp"

namespace psygen::cluster {

enum class MessageKind : std::uint8_t {
  kPing,    // asks for a kPong of the given size
  kPong,    //
  kMake,    // asks for a mesh
  kAnswer,  // the mesh, or the reason why there is none
  kEnd,     // no more requests follow
  kBye,     // reply to kEnd
};

// Request for one mesh.
struct MakeMessage {
  std::uint64_t ticket = 0;           // identifies the request; the answer repeats it
  std::string type;                   // name of the model type
  std::uint64_t parameters_hash = 0;  // includes the identity of the type
  models::Parameters parameters;      // without edits
  std::uint16_t level = 0;
  models::MeshSize size;
};

// Any message. Only the members of its kind are set.
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
// A message of the kind kEnd or kBye.
Bytes plain_message(MessageKind kind);

// Writes the answer to a request in place: make() with the size, write into mesh(), then finish().
// Allocates memory for one mesh.
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
// An answer without a mesh: `error` is that of the type, or the reason for kNone.
Bytes failed_message(std::uint64_t ticket, synthesis::RemoteMesh::Answer answer,
                     const std::string& error);

// Decodes a message; nullopt if the bytes are damaged.
std::optional<Message> read_message(Bytes&& bytes);

}  // namespace psygen::cluster
