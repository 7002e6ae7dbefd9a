#include "engine/world/far/placed_proxies.hpp"

#include <algorithm>
#include <new>

namespace psygen::world {
namespace {

constexpr std::uint64_t kMaxVertices = 65'536;

// The largest form of a placed model in a mesh with the forms of this node level.
ProxySize largest(int form_level) {
  ProxySize most{0, 0, 0};
  const auto add = [&most](Form form) {
    const ProxySize size = size_of(form);
    most.vertices = std::max(most.vertices, size.vertices);
    most.triangles = std::max(most.triangles, size.triangles);
  };
  add(Form::kTent);
  if (form_level <= 2) {
    add(Form::kKiteTrunk);
    add(Form::kChunk);
  }
  if (form_level <= 1) add(Form::kSpindleTrunk);
  return most;
}

Form form_of(const Outline& outline, const PlacedPlan& plan) {
  if (plan.together > 1 || plan.form_level >= 3) return Form::kTent;
  if (!outline.leafy) return Form::kChunk;
  const bool trunk = outline.trunk_radius > 0;
  if (plan.form_level == 2) return trunk ? Form::kKiteTrunk : Form::kKite;
  return trunk ? Form::kSpindleTrunk : Form::kSpindle;
}

}  // namespace

PlacedPlan::PlacedPlan(int level, std::uint64_t models, std::uint64_t vertices)
    : form_level(level) {
  const std::uint64_t room =
      (kMaxVertices - std::min(vertices, kMaxVertices)) / largest(level).vertices;
  const std::uint64_t most = std::min(kMaxProxies, room);
  if (models == 0 || most == 0) return;
  together = (models + most - 1) / most;
  forms = (models + together - 1) / together;
}

std::uint64_t PlacedPlan::vertices() const {
  return forms * largest(form_level).vertices;
}

std::uint64_t PlacedPlan::triangles() const {
  return forms * largest(form_level).triangles;
}

std::optional<Form> make_placed_proxy(const models::ModelType& type,
                                      const models::Parameters& parameters, const PlacedPlan& plan,
                                      SampleMesh& mesh, glm::vec2 turn, ProxyMesh& out) {
  if (plan.forms == 0) return std::nullopt;
  try {  // user types may throw; our own code throws only when memory is exhausted
    mesh.make(type, parameters);
    const auto outline = mesh.outline();
    if (!outline) return std::nullopt;
    const Form form = form_of(*outline, plan);
    if (is_billboard(form)) {
      const Billboard board =
          billboard_of(form, *outline, mesh.silhouette(type), static_cast<float>(plan.together));
      make_billboard(form, *outline, board, out);
    } else {
      make_proxy(form, *outline, 1, turn, out);
    }
    return form;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
    return std::nullopt;
  }
}

core::Bounds with_reach(const core::Bounds& box, const glm::vec3& reach_m) {
  if (reach_m == glm::vec3(0.0F)) return box;
  // Placed models stand in the node, whose square lies within the box.
  return {box.min - glm::vec3(reach_m.x, reach_m.z, reach_m.x),
          box.max + glm::vec3(reach_m.x, reach_m.y, reach_m.x)};
}

}  // namespace psygen::world
