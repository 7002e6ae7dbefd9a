// The interface of a procedural model: a schema of parameters, conservative bounds, exact sizes, a
// cost formula and a synthesis function (paper, section 5.2: ProceduralModel). All are pure
// functions of the parameters. A type is immutable after construction and usable from any thread.
// Users derive their own types and register them (registry.hpp). One virtual seam; no data is
// inherited.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/assert.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/collider.hpp"

namespace psygen::models {

// Storage of a value: a 64-bit integer or a double.
enum class ParameterType : std::uint8_t { kInteger, kReal };

// The source of a value: world files and editors (kUser), or the world when it places the model
// (kPlaced: seed, block coordinates).
enum class ParameterSource : std::uint8_t { kUser, kPlaced };

// One entry of a schema. The strings must outlive the type.
struct ParameterSpec {
  std::string_view name;  // snake_case, as in world files
  ParameterType type = ParameterType::kReal;
  std::string_view unit;  // "m", "1", "vertices"; "" for none
  double default_value = 0;
  double hard_min = 0, hard_max = 0;  // values outside are rejected
  double soft_min = 0, soft_max = 0;  // the range of a slider
  std::string_view doc;               // one line for users
  ParameterSource source = ParameterSource::kUser;
};
// The ranges of a parameter: allowed values, and those of a slider.
struct HardRange {
  double min, max;
};
struct SoftRange {
  double min, max;
};
// Make the entry of a real parameter, of an integer, and of a parameter that the world sets.
constexpr ParameterSpec real_parameter(std::string_view name, std::string_view unit,
                                       double default_value, HardRange hard, SoftRange soft,
                                       std::string_view doc) {
  return {.name = name,
          .type = ParameterType::kReal,
          .unit = unit,
          .default_value = default_value,
          .hard_min = hard.min,
          .hard_max = hard.max,
          .soft_min = soft.min,
          .soft_max = soft.max,
          .doc = doc};
}
constexpr ParameterSpec integer_parameter(std::string_view name, std::string_view unit,
                                          double default_value, HardRange hard, SoftRange soft,
                                          std::string_view doc) {
  ParameterSpec spec = real_parameter(name, unit, default_value, hard, soft, doc);
  spec.type = ParameterType::kInteger;
  return spec;
}
constexpr ParameterSpec placed(ParameterSpec spec) {
  spec.source = ParameterSource::kPlaced;
  return spec;
}

// A number that is not a parameter of a model type, for editors: unit, allowed and usual range, and
// a line of help. The lists of such numbers (tree/species.hpp, world/files/fields.hpp) are visited
// with it. The strings are literals.
struct NumberSpec {
  HardRange hard{};
  SoftRange soft{};
  std::string_view unit;  // "m", "degrees"; "" for none
  std::string_view doc;   // one line for users
};

struct EditLayer;  // edits.hpp

// The values of one model, in the order of its type's schema. Integers keep all 64 bits (seeds).
// Meshes that show the world itself (the ground, and the merged mesh of a node) also name the edits
// of the world that they show.
class Parameters {
 public:
  static constexpr std::size_t kMaxCount = 24;
  // Value `i` of the schema, `i` < kMaxCount. The caller knows the type of value `i` from the
  // schema.
  std::int64_t integer(std::size_t i) const { return std::bit_cast<std::int64_t>(bits_[i]); }
  double real(std::size_t i) const { return std::bit_cast<double>(bits_[i]); }
  void set_integer(std::size_t i, std::int64_t v) { bits_[i] = std::bit_cast<std::uint64_t>(v); }
  void set_real(std::size_t i, double v) { bits_[i] = std::bit_cast<std::uint64_t>(v); }
  // The edits that the mesh shows; null: none. The caller keeps the edit layer alive while it uses
  // the parameters. `hash` identifies the part of the layer that can change this mesh; 0: none.
  void set_edits(const EditLayer* layer, std::uint64_t hash) {
    edits_ = layer;
    edits_hash_ = hash;
  }
  const EditLayer* edits() const { return edits_; }
  std::uint64_t edits_hash() const { return edits_hash_; }
  // Hash of the bits of all values, and of the edits if there are any. Equal parameters have equal
  // hashes. Values from kFirstOptional on count only if they are not 0, so a schema may grow there
  // by parameters with the default 0, and old worlds, edits and saves keep their hashes.
  static constexpr std::size_t kFirstOptional = 16;
  std::uint64_t hash() const {
    std::uint64_t h = 0;
    for (std::size_t i = 0; i < kFirstOptional; ++i)
      h = core::combine(h, bits_[i]);
    for (std::size_t i = kFirstOptional; i < kMaxCount; ++i) {
      if (bits_[i] != 0) h = core::combine(core::combine(h, i), bits_[i]);
    }
    return edits_hash_ == 0 ? h : core::combine(h, edits_hash_);
  }
  // Compares the hash of the edits, so the layers may differ where that changes no mesh.
  friend bool operator==(const Parameters& a, const Parameters& b) {
    return a.bits_ == b.bits_ && a.edits_hash_ == b.edits_hash_;
  }

 private:
  std::array<std::uint64_t, kMaxCount> bits_{};
  std::uint64_t edits_hash_ = 0;
  const EditLayer* edits_ = nullptr;
};
static_assert(sizeof(Parameters) == 208);

// The exact size of one mesh.
struct MeshSize {
  std::uint32_t vertex_count = 0;
  std::uint32_t index_count = 0;     // triangles · 3, for shared and for own indices
  std::uint32_t shared_indices = 0;  // 0: the mesh writes its own; else the id of a shared list
  core::VertexLayout layout = core::VertexLayout::kModel;
  // Triangles of the whole mesh.
  std::uint32_t triangle_count() const { return index_count / 3; }
  // Output of a synthesis: number of own indices, bytes of vertices, and bytes in total.
  std::uint32_t own_index_count() const { return shared_indices == 0 ? index_count : 0; }
  std::size_t vertex_bytes() const {
    return std::size_t{vertex_count} * core::vertex_stride_bytes(layout);
  }
  std::size_t bytes() const { return vertex_bytes() + std::size_t{own_index_count()} * 2; }
  friend bool operator==(const MeshSize&, const MeshSize&) = default;
};

// Destination of one synthesis. `indices` is empty if the indices are shared. Write-only, because
// it may be mapped device memory.
struct MeshView {
  std::span<std::byte> vertices;
  std::span<std::uint16_t> indices;
};
// Returns the destination at `bytes`, which has size.bytes() bytes: vertices, then indices. They
// are aligned as vertices are.
inline MeshView mesh_view(std::byte* bytes, const MeshSize& size) {
  return {{bytes, size.vertex_bytes()},
          {reinterpret_cast<std::uint16_t*>(bytes + size.vertex_bytes()), size.own_index_count()}};
}

// One type of model. Unless stated otherwise, `p` passes validate() and 0 <= level < level_count().
class ModelType {
 public:
  virtual ~ModelType() = default;

  // Name ("terrain", "rock", "tree"), one line for users, and schema. They never change and live as
  // long as the type.
  virtual std::string_view name() const = 0;
  virtual std::string_view doc() const = 0;
  virtual std::span<const ParameterSpec> parameters() const = 0;

  // Levels of detail: 0 is full detail, level_count() − 1 the coarsest.
  virtual int level_count() const = 0;
  // Number of different levels that these parameters have, 1 … level_count(). Every further level
  // has the same mesh as the last one. Only different levels are listed, so no mesh is stored under
  // several keys.
  virtual int level_count_of(const Parameters&) const { return level_count(); }
  // Largest distance in metres between the surface of this level and that of level 0 (an estimate
  // from the parameters). Grows with the level; 0 at level 0.
  virtual double level_error_m(const Parameters& p, int level) const = 0;

  // Bounds of every vertex of every level, in metres from the model's base point (for terrain: from
  // the block's corner). snorm16 positions are relative to them. For terrain the y range is the
  // same in every block of a world, and unorm16 heights span it. Works without synthesis.
  virtual core::Bounds bounds(const Parameters& p) const = 0;
  // The exact output of synthesise(). vertex_count <= 65,536.
  virtual MeshSize mesh_size(const Parameters& p, int level) const = 0;
  // Number of operations by the asymptotic formula, scaled so that level 0 matches the paper's
  // formula. Time is proportional to it.
  virtual double complexity(const Parameters& p, int level) const = 0;
  // Number of steps of about equal time that a level takes: branches of trees, samples and octaves
  // of terrain, vertices of rocks. Counted for this seed. The predicted time of a level depends on
  // its steps and its triangles. 0 stands for the triangles of level 0. Works without synthesis.
  virtual double steps(const Parameters&, int) const { return 0; }
  // Approximate time of a step on a current core, in seconds. Predictions use it until a level has
  // been measured, and always if measuring is not allowed (a virtual clock).
  virtual double step_seconds() const { return 10e-9; }
  // Upper bound of the triangles of level 0 over all seeds, as log2. Computed without overflow for
  // any parameters inside or outside their hard ranges. Used to reject hostile values.
  virtual double log2_cost(const Parameters& p) const = 0;

  // Fills `out`, whose spans have exactly the sizes of mesh_size(). Returns the tight bounds of the
  // vertices written, which are inside bounds(p). Deterministic: same bits for the same (p, level)
  // on any thread and any CPU. No I/O, no globals, and no allocation that outlives the call but
  // scratch memory of the thread. Modelers have core::kThreadStackBytes of stack. The engine's own
  // types, and all that makes meshes on a caller's thread, need 256 KiB at most, the rest of the
  // caller included (small_stack_test.cpp).
  virtual core::Bounds synthesise(const Parameters& p, int level, const MeshView& out) const = 0;
  // Distinguishes types of the same name with different functions, such as two editions of a
  // species. Part of every mesh's key (parameters_hash). 0 for types that never change.
  virtual std::uint64_t identity() const { return 0; }
  // False for types smaller than a pixel at the distance where individual models end. The merged
  // meshes of nodes and the colour of far ground omit them.
  virtual bool is_seen_from_far() const { return true; }
  // Material of the whole model except its leaves.
  virtual core::SurfaceKind surface() const { return core::SurfaceKind::kPlain; }
  // The size in metres that decides if an individual model is large enough on screen to be drawn. A
  // model of many small parts returns the size of one part. 0: the sphere around its mesh.
  virtual double seen_size_m(const Parameters&) const { return 0; }
  // The solid parts, in metres from the base point, within bounds(p) along x and z. None by
  // default. They approximate the mesh of level 0; the type documents the difference. Takes
  // microseconds and needs no mesh: queries request the colliders of a whole block together
  // (engine/query/).
  virtual Collider collider(const Parameters&) const { return {}; }
  // For types whose instances all have one shape, scaled and turned about +Y: the turn of this
  // instance in degrees. Such types need only one impostor each (world/far/tree_impostors.hpp), and
  // a second one without leaves. Nothing for all others.
  virtual std::optional<double> turn_deg(const Parameters&) const { return std::nullopt; }
  // True only if synthesis always ends, in about the predicted time, for all parameters. Then the
  // main thread may synthesise a mesh itself when its absence would be visible. A type that could
  // hang must return false: a watchdog observes the modelers, but not the main thread.
  virtual bool may_run_on_main_thread() const { return false; }
  // Writes the shared index list `id` of a MeshSize; `out` has that size's index_count entries.
  // Only for types whose meshes share lists; for others an assertion fails, also in release.
  virtual void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const {
    PSYGEN_CHECK(false, "the type has shared index lists");
  }
};

// Part of a mesh's key, together with its position and level: its parameters and the type's
// identity().
inline std::uint64_t parameters_hash(const ModelType& type, const Parameters& p) {
  const std::uint64_t identity = type.identity();
  return identity == 0 ? p.hash() : core::combine(p.hash(), identity);
}

// Returns "predicted cost: 8192 triangles"; from 2^40 on "predicted cost: 2^82.0 triangles", and
// "predicted cost: unbounded" for infinities and NaN.
std::string predicted_cost_text(double log2_triangles);

// Returns all parameters at their defaults.
Parameters default_parameters(const ModelType& type);

// Returns the value of parameter `i` as a number; integers beyond 2^53 are rounded.
double parameter_number(const ModelType& type, const Parameters& p, std::size_t i);

// Returns the index of a parameter in the schema, or -1. Linear in the number of parameters.
int parameter_index(const ModelType& type, std::string_view name);

// Fails with kInvalidArgument for values outside their hard ranges, NaN and infinities, and with
// kOverBudget if log2_cost() is above `max_log2_cost`. The message names the parameter, the allowed
// range and the predicted cost.
core::Result<void> validate(const ModelType& type, const Parameters& p,
                            double max_log2_cost = 20.0);

}  // namespace psygen::models
