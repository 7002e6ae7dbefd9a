// The nodes of the file's scene, parents first. The order is found without recursion, so any depth
// is allowed, and each node is visited once, so cycles end.
#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

constexpr float kMaxOffset = 1e6F;

// `out` keeps its value if the file has none.
template <class Vector>
core::Result<void> read_numbers(const std::vector<double>& from, const std::string& what,
                                Vector& out) {
  if (from.empty()) return {};
  const auto width = static_cast<std::size_t>(Vector::length());
  if (from.size() != width) return wrong(fmt::format("{} has {} numbers", what, from.size()));
  for (int i = 0; i < Vector::length(); ++i) {
    out[i] = static_cast<float>(from[static_cast<std::size_t>(i)]);
    if (!(std::abs(out[i]) <= kMaxOffset))
      return wrong(fmt::format("{} has {}; at most {} is allowed", what, out[i], kMaxOffset));
  }
  return {};
}

// A matrix as a pose. glTF allows only matrices that are poses.
core::Result<Pose> pose_of_matrix(const std::vector<double>& matrix, const std::string& what) {
  if (matrix.size() != 16) return wrong(fmt::format("{} has {} numbers", what, matrix.size()));
  glm::mat3 columns;
  Pose pose;
  for (std::size_t c = 0; c < 4; ++c) {
    glm::vec3 column(0.0F);
    const std::vector<double> numbers(matrix.begin() + static_cast<std::ptrdiff_t>(4 * c),
                                      matrix.begin() + static_cast<std::ptrdiff_t>(4 * c + 3));
    if (auto ok = read_numbers(numbers, what, column); !ok) return tl::unexpected(ok.error());
    (c < 3 ? columns[static_cast<int>(c)] : pose.translation) = column;
  }
  for (int c = 0; c < 3; ++c)
    pose.scale[c] = glm::length(columns[c]);
  if (glm::determinant(columns) < 0) pose.scale.x = -pose.scale.x;
  constexpr float kSkew = 1e-3F;
  int flat = -1, flat_count = 0;  // an axis of scale 0, and their number
  for (int c = 0; c < 3; ++c) {
    if (pose.scale[c] == 0) flat = c;
    flat_count += pose.scale[c] == 0 ? 1 : 0;
    if (pose.scale[c] != 0) columns[c] /= pose.scale[c];
  }
  if (flat_count > 1) return pose;  // nothing of it has an area
  if (flat_count == 1) columns[flat] = glm::cross(columns[(flat + 1) % 3], columns[(flat + 2) % 3]);
  for (int c = 0; c < 3; ++c) {
    if (std::abs(glm::dot(columns[c], columns[(c + 1) % 3])) > kSkew)
      return wrong(what + " is skewed; it must consist of a translation, rotation and scale");
  }
  pose.rotation = glm::normalize(glm::quat_cast(columns));
  return pose;
}

core::Result<Pose> pose_of(const NodeJson& node, const std::string& name) {
  if (!node.matrix.empty()) return pose_of_matrix(node.matrix, name + ".matrix");
  Pose pose;
  glm::vec4 turn(0, 0, 0, 1);
  auto ok = read_numbers(node.translation, name + ".translation", pose.translation)
                .and_then([&] { return read_numbers(node.rotation, name + ".rotation", turn); })
                .and_then([&] { return read_numbers(node.scale, name + ".scale", pose.scale); });
  if (!ok) return tl::unexpected(ok.error());
  const float length = glm::length(turn);
  if (length < 1e-3F) return wrong(name + ".rotation is zero");
  turn /= length;
  pose.rotation = {turn.w, turn.x, turn.y, turn.z};
  return pose;
}

// The parents of all nodes. Fails for a node with two parents and for a cycle.
core::Result<std::vector<std::uint32_t>> parents_of(const Document& file) {
  const std::size_t count = file.nodes.size();
  std::vector<std::uint32_t> parents(count, kNone);
  for (std::size_t i = 0; i < count; ++i) {
    for (const int child : file.nodes[i].children) {
      const auto index = index_in(child, count, fmt::format("a child of nodes[{}]", i));
      if (!index) return tl::unexpected(index.error());
      if (parents[*index] != kNone)
        return wrong(fmt::format("nodes[{}] is a child of nodes[{}] and nodes[{}]", *index,
                                 parents[*index], i));
      parents[*index] = static_cast<std::uint32_t>(i);
    }
  }
  // Walks up from each node to the first node that is known to have a root.
  std::vector<std::uint32_t> seen_by(count, kNone);
  for (std::uint32_t start = 0; start < count; ++start) {
    for (std::uint32_t node = start; node != kNone && seen_by[node] != start;
         node = parents[node]) {
      if (seen_by[node] != kNone) break;
      seen_by[node] = start;
      if (parents[node] != kNone && seen_by[parents[node]] == start)
        return wrong(fmt::format("nodes[{}] is its own ancestor: the nodes form a cycle", node));
    }
  }
  return parents;
}

core::Result<std::vector<std::uint32_t>> roots_of(const Document& file,
                                                  const std::vector<std::uint32_t>& parents) {
  std::vector<std::uint32_t> roots;
  if (file.scenes.empty()) {
    for (std::uint32_t i = 0; i < parents.size(); ++i) {
      if (parents[i] == kNone) roots.push_back(i);
    }
    return roots;
  }
  const int number = file.scene == kAbsent ? 0 : file.scene;
  const auto scene = index_in(number, file.scenes.size(), "scene");
  if (!scene) return tl::unexpected(scene.error());
  std::vector<bool> listed(parents.size());
  for (const int root : file.scenes[*scene]) {
    const auto index = index_in(root, parents.size(), fmt::format("a node of scenes[{}]", *scene));
    if (!index) return tl::unexpected(index.error());
    if (parents[*index] != kNone || listed[*index])
      return wrong(
          fmt::format("nodes[{}] of scenes[{}] occurs twice, or is not a root", *index, *scene));
    listed[*index] = true;
    roots.push_back(*index);
  }
  return roots;
}

core::Result<void> add_node(Reading& reading, std::uint32_t number, std::uint32_t parent) {
  const NodeJson& described = reading.file.nodes[number];
  const std::string name = fmt::format("nodes[{}]", number);
  Node node;
  node.name = described.name;
  node.parent = parent == kNone ? kNone : reading.node_numbers[parent];
  auto pose = pose_of(described, name);
  if (!pose) return tl::unexpected(pose.error());
  node.rest = *pose;
  if (described.mesh != kAbsent) {
    const auto mesh = index_in(described.mesh, reading.out.meshes.size(), name + ".mesh");
    if (!mesh) return tl::unexpected(mesh.error());
    node.mesh = *mesh;
  }
  if (described.skin != kAbsent)
    reading.note("has skins, which are not supported; skinned meshes keep their rest pose");
  reading.node_numbers[number] = static_cast<std::uint32_t>(reading.out.nodes.size());
  reading.out.nodes.push_back(std::move(node));
  return {};
}

}  // namespace

core::Result<void> read_nodes(Reading& reading) {
  const Document& file = reading.file;
  std::uint64_t count = 0;
  if (auto ok = add_within_limit(count, file.nodes.size(), reading.limits.nodes, "nodes"); !ok)
    return ok;
  const auto parents = parents_of(file);
  if (!parents) return tl::unexpected(parents.error());
  auto open = roots_of(file, *parents);
  if (!open) return tl::unexpected(open.error());
  reading.node_numbers.assign(file.nodes.size(), kNone);
  for (std::size_t next = 0; next < open->size(); ++next) {
    const std::uint32_t number = (*open)[next];
    if (auto ok = add_node(reading, number, (*parents)[number]); !ok) return ok;
    for (const int child : file.nodes[number].children)
      open->push_back(static_cast<std::uint32_t>(child));
  }
  return {};
}

}  // namespace psygen::gltf
