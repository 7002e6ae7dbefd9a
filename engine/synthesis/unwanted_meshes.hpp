// Queue of unwanted ready meshes, in the order in which they became unwanted. Stores handles only:
// some meshes may be wanted again, or freed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "engine/synthesis/mesh_key.hpp"

namespace psygen::synthesis {

// Empty at first.
class UnwantedMeshes {
 public:
  // Adds a mesh. Only the last entry of a slot counts.
  void push(MeshHandle mesh) {
    if (mesh.slot >= turns_.size()) turns_.resize(std::size_t{mesh.slot} + 1);
    turns_[mesh.slot] = ++turn_;
    queue_.push_back({mesh, turn_});
    if (queue_.size() <= 2 * turns_.size()) return;
    std::erase_if(queue_, [this](const Entry& entry) { return !is_last(entry); });
  }

  // Removes and returns the mesh that has been unwanted for longest.
  std::optional<MeshHandle> pop() {
    while (!queue_.empty()) {
      const Entry first = queue_.front();
      queue_.pop_front();
      if (is_last(first)) return first.mesh;
    }
    return std::nullopt;
  }
  // Number of entries, at most two for each slot.
  std::size_t entries() const { return queue_.size(); }

 private:
  struct Entry {
    MeshHandle mesh;
    std::uint64_t turn;
  };
  bool is_last(const Entry& entry) const { return turns_[entry.mesh.slot] == entry.turn; }

  std::deque<Entry> queue_;
  std::vector<std::uint64_t> turns_;  // per slot: sequence number of its last entry
  std::uint64_t turn_ = 0;
};

}  // namespace psygen::synthesis
