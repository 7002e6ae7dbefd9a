// What a procedural model is: a schema of parameters, conservative bounds, exact sizes, a cost
// formula and a synthesis function, all pure functions of the parameters (paper, section 5.2:
// ProceduralModel). Immutable after construction and usable from any thread. Users derive their own
// types and register them (registry.hpp). One virtual seam; no data is inherited.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/vertex_layout.hpp"

namespace psygen::models {

enum class ParameterType : std::uint8_t { kInteger, kReal };

// Who sets a parameter: world files and editors (kUser), or the world when it places the model
// (kPlaced: seed, block coordinates).
enum class ParameterSource : std::uint8_t { kUser, kPlaced };

struct ParameterSpec {
  std::string_view name;  // snake_case, as in world files
  ParameterType type = ParameterType::kReal;
  std::string_view unit;  // "m", "1", "vertices"; "" for none
  double default_value = 0;
  double hard_min = 0, hard_max = 0;  // outside: refused
  double soft_min = 0, soft_max = 0;  // what a slider shows
  std::string_view doc;
  ParameterSource source = ParameterSource::kUser;
};

// The values of one model, in the order of its type's schema. Integers keep all 64 bits (seeds).
class Parameters {
 public:
  static constexpr std::size_t kMaxCount = 16;
  std::int64_t integer(std::size_t i) const { return std::bit_cast<std::int64_t>(bits_[i]); }
  double real(std::size_t i) const { return std::bit_cast<double>(bits_[i]); }
  void set_integer(std::size_t i, std::int64_t v) { bits_[i] = std::bit_cast<std::uint64_t>(v); }
  void set_real(std::size_t i, double v) { bits_[i] = std::bit_cast<std::uint64_t>(v); }
  std::uint64_t hash() const {
    std::uint64_t h = 0;
    for (const std::uint64_t b : bits_)
      h = core::combine(h, b);
    return h;
  }
  friend bool operator==(const Parameters&, const Parameters&) = default;

 private:
  std::array<std::uint64_t, kMaxCount> bits_{};
};
static_assert(sizeof(Parameters) == 128);

struct MeshSize {
  std::uint32_t vertex_count = 0;
  std::uint32_t index_count = 0;     // triangles · 3, whether indices are shared or its own
  std::uint32_t shared_indices = 0;  // 0: the mesh writes its own; else the id of a shared list
  core::VertexLayout layout = core::VertexLayout::kModel;
  std::uint32_t triangle_count() const { return index_count / 3; }
  friend bool operator==(const MeshSize&, const MeshSize&) = default;
};

// Destination of one synthesis. `indices` is empty where the indices are shared.
struct MeshView {
  std::span<std::byte> vertices;
  std::span<std::uint16_t> indices;
};

class ModelType {
 public:
  virtual ~ModelType() = default;

  virtual std::string_view name() const = 0;  // "terrain", "rock", "tree"
  virtual std::string_view doc() const = 0;
  virtual std::span<const ParameterSpec> parameters() const = 0;

  // Levels of detail: 0 is full detail, level_count() − 1 the coarsest.
  virtual int level_count() const = 0;
  // How many of them these parameters need, at least one and at most level_count(): from there on
  // every level is the mesh of the one before. Only these are listed, so that no mesh is held under
  // several keys.
  virtual int level_count_of(const Parameters&) const { return level_count(); }
  // Largest distance in metres between the surface of this level and that of level 0 (an estimate
  // from the parameters). Grows with the level; 0 at level 0.
  virtual double level_error_m(const Parameters& p, int level) const = 0;

  // Box that holds every vertex of every level, local to the model's foot (for terrain: to the
  // block's corner). Also the box of snorm16 positions; for terrain its y range is the same in
  // every block of a world and is what unorm16 heights span. Without synthesis.
  virtual core::Bounds bounds(const Parameters& p) const = 0;
  // Exactly what synthesize() will write. vertex_count <= 65,536.
  virtual MeshSize mesh_size(const Parameters& p, int level) const = 0;
  // Operations by the asymptotic formula, scaled so that level 0 is the paper's formula; time = c ·
  // this.
  virtual double complexity(const Parameters& p, int level) const = 0;
  // What a level is made from, in steps of about equal time (branches of trees, samples and octaves
  // of terrain, vertices of rocks), counted for this very seed: beside the triangles of the level
  // what its time is predicted from. 0: as many as level 0 has triangles. Without synthesis.
  virtual double steps(const Parameters&, int) const { return 0; }
  // About what a step takes on a core of today, in seconds: what is predicted before anything was
  // measured, and always where nothing may be (a virtual clock).
  virtual double step_seconds() const { return 10e-9; }
  // Upper bound of the triangles of level 0 over all seeds, as log2, computed without overflow for
  // any parameters inside or outside their hard ranges. Used to refuse hostile values.
  virtual double log2_cost(const Parameters& p) const = 0;

  // Fills `out`, whose spans have exactly the sizes of mesh_size(), and returns the tight box of
  // the vertices written (inside bounds(p)). Deterministic: same bits for the same (p, level) on
  // any thread and any CPU. No allocation that outlives the call, no I/O, no globals.
  virtual core::Bounds synthesize(const Parameters& p, int level, const MeshView& out) const = 0;
  // Tells types of one name apart whose functions differ, such as two editions of a species: it is
  // part of every mesh's key (parameters_hash). 0 for types that never change.
  virtual std::uint64_t identity() const { return 0; }
  // False for what is smaller than a pixel where single models end: the meshes that stand for
  // everything on a node and the colour of far ground leave it out.
  virtual bool is_seen_from_far() const { return true; }
  // By what it is judged whether a single model is large enough on screen to be drawn, in metres:
  // for many small things that are one model, the size of one. 0: the sphere around its mesh.
  virtual double seen_size_m(const Parameters&) const { return 0; }
  // True only for types that are certain to end, and in about the time that is predicted, whatever
  // their parameters: the main thread may synthesise them itself when their absence is seen. A type
  // that could hang must leave this to the modelers, which are watched.
  virtual bool may_run_on_main_thread() const { return false; }
  // Writes the shared index list `id` (as named by mesh_size), `index_count` entries.
  virtual void write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const = 0;
};

// What names a mesh beside its place and level: the parameters and which function they are for.
inline std::uint64_t parameters_hash(const ModelType& type, const Parameters& p) {
  const std::uint64_t identity = type.identity();
  return identity == 0 ? p.hash() : core::combine(p.hash(), identity);
}

// "predicted cost: 8192 triangles", or "2^82.0" where the number itself says nothing any more.
std::string predicted_cost_text(double log2_triangles);

// All parameters at their defaults.
Parameters default_parameters(const ModelType& type);

// Position of a parameter in the schema, or -1.
int parameter_index(const ModelType& type, std::string_view name);

// Refuses values outside hard ranges, NaN and infinities, and meshes of more than `max_log2_cost`
// (log2 of triangles). The message names the parameter, the allowed range and the predicted cost.
core::Result<void> validate(const ModelType& type, const Parameters& p,
                            double max_log2_cost = 20.0);

}  // namespace psygen::models
