#include "engine/world/merged_models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "engine/core/assert.hpp"
#include "engine/models/packing.hpp"
#include "engine/models/terrain.hpp"
#include "engine/world/far_scatter.hpp"
#include "engine/world/node_walk.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

using models::MeshSize;
using models::MeshView;
using models::Parameters;
using models::ParameterSpec;

constexpr models::ParameterType kInteger = models::ParameterType::kInteger;
constexpr models::ParameterSource kPlaced = models::ParameterSource::kPlaced;
constexpr std::uint64_t kEdition = 1;  // of what this file makes of a world
constexpr std::uint64_t kMostVertices = 65'536;

// A node of side s is drawn from about 2.4 s on, by 700 pixels a radian; what is less wide and high
// than 1.2 of them then is left out, but trees and bushes are first put together, up to so many.
constexpr double kNearestSides = 2.4, kPixelsPerRadian = 700, kLeastPixels = 1.2;
constexpr std::uint32_t kMostTogether = 32;

// How many models of this size must be together so that they can be seen from `distance_m` on.
std::uint32_t least_together(double side_m2, double distance_m) {
  const double least_m = kLeastPixels / kPixelsPerRadian * distance_m;
  return static_cast<std::uint32_t>(std::ceil(std::min(least_m * least_m / side_m2, 1e6)));
}

constexpr ParameterSpec kSchema[kMergedParameterCount] = {
    {"block_x", kInteger, "nodes", 0, -0x1.0p31, 0x1.0p31 - 1, -1000, 1000, "node along x",
     kPlaced},
    {"block_z", kInteger, "nodes", 0, -0x1.0p31, 0x1.0p31 - 1, -1000, 1000, "node along z",
     kPlaced},
    {"node_level", kInteger, "", 1, 1, kMaxMergedLevel, 1, kMaxMergedLevel,
     "the node is 2^node_level blocks wide and long", kPlaced},
};

int level_of(const Parameters& p) {
  return static_cast<int>(
      std::clamp<std::int64_t>(p.integer(kMergedNodeLevel), 1, kMaxMergedLevel));
}

std::uint64_t identity_of(const World& world, const models::Registry& registry) {
  std::uint64_t h = core::combine(kEdition, world.seed);
  const auto add = [&h](std::uint64_t v) { h = core::combine(h, v); };
  const auto add_real = [&add](double v) { add(std::bit_cast<std::uint64_t>(v)); };
  add(static_cast<std::uint64_t>(world.blocks_x));
  add(static_cast<std::uint64_t>(world.blocks_z));
  add(models::parameters_hash(registry[world.terrain_model], world.terrain));
  for (const Scatter& s : world.scatter) {
    const models::ModelType& type = registry[s.model];
    add(core::hash_bytes(std::as_bytes(std::span(type.name()))));
    add(models::parameters_hash(type, models::default_parameters(type)));
    add(s.count);
    for (const ParameterRange& range : s.ranges) {
      add_real(range.low);
      add_real(range.high);
    }
    add_real(s.min_height_m);
    add_real(s.max_height_m);
    add_real(s.max_slope_deg);
  }
  return h;
}

// What a node level makes of one scatter.
struct ScatterPlan {
  Form form = Form::kSpire;
  std::uint32_t together = 1;  // instances that one form stands for
  std::uint64_t forms = 0;     // 0: left out
};

struct LevelPlan {
  std::vector<ScatterPlan> scatters;
  std::uint64_t vertices = 0, triangles = 0;
  core::Bounds box;
};

// Appends forms to a mesh.
class FormWriter {
 public:
  FormWriter(const core::Bounds& box, const MeshView& out) : box_(box), packer_(box), out_(out) {}

  void add(Form form, const FormMesh& mesh, const glm::vec3& foot, bool sways) {
    const FormSize size = size_of(form);
    for (std::size_t i = 0; i < 3 * std::size_t{size.triangles}; ++i)
      out_.indices[indices_++] = static_cast<std::uint16_t>(vertices_ + mesh.indices[i]);
    for (std::size_t i = 0; i < size.vertices; ++i)
      write(mesh.corners[i], foot, sways);
  }
  // Fills the rest with triangles that cannot be seen and returns the box of what can.
  core::Bounds finish() {
    if (vertices_ == 0) {
      std::fill(out_.vertices.begin(), out_.vertices.end(), std::byte{0});
      low_ = high_ = {0, 0, 0};
    }
    constexpr std::size_t kSize = sizeof(core::ModelVertex);
    for (std::size_t at = std::max<std::size_t>(vertices_, 1) * kSize; at < out_.vertices.size();
         at += kSize)
      std::memcpy(out_.vertices.data() + at, out_.vertices.data(), kSize);
    std::fill(out_.indices.begin() + static_cast<std::ptrdiff_t>(indices_), out_.indices.end(),
              std::uint16_t{0});
    const auto place = [this](const std::array<std::int16_t, 3>& q) {
      return box_.center() + box_.half_extent() * (glm::vec3(q[0], q[1], q[2]) * (1.0F / 32767.0F));
    };
    return {place(low_), place(high_)};
  }

 private:
  void write(const Corner& c, const glm::vec3& foot, bool sways) {
    core::ModelVertex v;
    packer_.pack(foot + c.position, v.position);
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], v.position[k]);
      high_[k] = std::max(high_[k], v.position[k]);
      v.colour[k] = models::pack_unorm8(c.colour[static_cast<int>(k)]);
    }
    const glm::vec2 normal = models::encode_octahedral(c.normal);
    v.normal[0] = models::pack_snorm16(normal.x);
    v.normal[1] = models::pack_snorm16(normal.y);
    v.ambient = models::pack_unorm8(c.ambient);
    v.sway = sways ? models::pack_unorm8(c.sway) : std::uint8_t{0};
    v.material = c.material;
    std::memcpy(out_.vertices.data() + vertices_++ * sizeof v, &v, sizeof v);
  }

  core::Bounds box_;
  models::BoxPacker packer_;
  MeshView out_;
  std::size_t vertices_ = 0, indices_ = 0;
  std::array<std::int16_t, 3> low_{32767, 32767, 32767}, high_{-32767, -32767, -32767};
};

class MergedType final : public models::ModelType {
 public:
  MergedType(std::shared_ptr<const World> world, const models::Registry& registry)
      : world_(std::move(world)), identity_(identity_of(*world_, registry)) {
    std::uint32_t first = 0;
    for (const Scatter& scatter : world_->scatter) {
      scatters_.emplace_back(*world_, registry[scatter.model], scatter, first);
      first += scatter.count;
    }
    for (int level = 1; level <= kMaxMergedLevel; ++level)
      plans_[static_cast<std::size_t>(level)] = plan_of(level);
  }

  std::string_view name() const override { return "vegetation"; }
  std::string_view doc() const override {
    return "all trees and rocks of a node's blocks, a few triangles each";
  }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return 1; }
  double level_error_m(const Parameters&, int) const override { return 0; }
  core::Bounds bounds(const Parameters& p) const override { return plan(p).box; }
  MeshSize mesh_size(const Parameters& p, int) const override {
    return {static_cast<std::uint32_t>(plan(p).vertices),
            static_cast<std::uint32_t>(3 * plan(p).triangles), 0, core::VertexLayout::kModel};
  }
  double complexity(const Parameters& p, int) const override;
  double log2_cost(const Parameters& p) const override {
    return std::log2(static_cast<double>(std::max<std::uint64_t>(plan(p).triangles, 1)));
  }
  core::Bounds synthesize(const Parameters& p, int level, const MeshView& out) const override;
  std::uint64_t identity() const override { return identity_; }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {
    PSYGEN_CHECK(false, "vegetation shares no indices");
  }

 private:
  struct Making;  // one call of synthesize()

  const LevelPlan& plan(const Parameters& p) const {
    return plans_[static_cast<std::size_t>(level_of(p))];
  }
  LevelPlan plan_of(int level) const;
  void plan_scatters(int level, std::uint32_t thinning, LevelPlan& plan) const;
  bool is_by_synthesis(const FarScatter& far, const ScatterPlan& how, int level) const {
    return level <= 2 && how.together == 1 && far.is_cheap();
  }
  void add_scatter(std::size_t s, const NodeBlock& block, Making& making) const;
  void add_instance(std::size_t s, const NodeBlock& block, const Scattering& scattering,
                    std::uint32_t index, Making& making) const;

  std::shared_ptr<const World> world_;
  std::uint64_t identity_;
  std::vector<FarScatter> scatters_;
  std::array<LevelPlan, kMaxMergedLevel + 1> plans_;  // [0] is not used
};

void MergedType::plan_scatters(int level, std::uint32_t thinning, LevelPlan& plan) const {
  const double side = std::ldexp(world_->block_size_m(), level);
  plan.scatters.clear();
  plan.vertices = plan.triangles = 0;
  for (const FarScatter& far : scatters_) {
    ScatterPlan how;
    const std::uint32_t least =
        far.empty() ? 0 : least_together(far.mean_silhouette().side_m2, kNearestSides * side);
    how.together = std::max(thinning, far.is_leafy() ? least : 1);
    const std::uint32_t most = far.is_leafy() ? std::max(thinning, kMostTogether) : thinning;
    if (!far.empty() && least <= most) {
      how.form = how.together > 1 ? Form::kSheet : far.form_at(level);
      const std::uint64_t instances = std::uint64_t{far.scatter().count} << (2 * level);
      how.forms = (instances + how.together - 1) / how.together;
    }
    plan.vertices += how.forms * size_of(how.form).vertices;
    plan.triangles += how.forms * size_of(how.form).triangles;
    plan.scatters.push_back(how);
  }
}

LevelPlan MergedType::plan_of(int level) const {
  LevelPlan plan;
  std::uint32_t thinning = level <= 3 ? 1 : 3U << (2 * (level - 4));
  plan_scatters(level, thinning, plan);
  while (plan.vertices > kMostVertices)
    plan_scatters(level, thinning *= 2, plan);
  FarScatter::Reach most;
  for (std::size_t s = 0; s < scatters_.size(); ++s) {
    if (plan.scatters[s].forms == 0) continue;
    const FarScatter::Reach reach =
        scatters_[s].reach(static_cast<float>(plan.scatters[s].together));
    most = {std::max(most.aside, reach.aside), std::max(most.up, reach.up),
            std::max(most.down, reach.down)};
  }
  const auto side = static_cast<float>(std::ldexp(world_->block_size_m(), level));
  const auto relief = static_cast<float>(world_->terrain.real(models::kTerrainReliefM));
  plan.box = {{-most.aside, -most.down, -most.aside},
              {side + most.aside, relief + most.up, side + most.aside}};
  return plan;
}

// Terms in nanoseconds of one machine; only their proportions count.
double MergedType::complexity(const Parameters& p, int) const {
  const int level = level_of(p);
  const LevelPlan& all = plan(p);
  const auto vertices = static_cast<double>(world_->terrain.integer(models::kTerrainSize));
  const double ground = 0.35 * vertices * vertices *
                        static_cast<double>(world_->terrain.integer(models::kTerrainOctaves)) *
                        (world_->terrain.real(models::kTerrainWarp) > 0 ? 8 : 1);
  double sum = ground * static_cast<double>(ground_tiles(level));
  for (std::size_t s = 0; s < scatters_.size(); ++s) {
    const ScatterPlan& how = all.scatters[s];
    const FarScatter& far = scatters_[s];
    const double make = !is_by_synthesis(far, how, level) ? 500 : far.is_leafy() ? 3000 : 400;
    const double search = far.scatter().has_filter() ? 200 : 0;
    sum += (make + search) * static_cast<double>(how.forms) + std::ldexp(80, 2 * level);
  }
  return sum + 100;
}

struct MergedType::Making {
  const LevelPlan& plan;
  int level;
  std::uint64_t key;  // of the node
  double tile_side_m;
  FormWriter writer;
  std::optional<models::BlockGround> ground;  // of the tile
  CoarsestMesh mesh;
  FormMesh form;
};

// A unit vector; not uniform, but without sines.
glm::vec2 direction_of(std::uint64_t hash) {
  const float t = static_cast<float>(hash >> 40) * 0x1.0p-24F;
  const float scale = 1 / (1 + t * t);
  const glm::vec2 v{(1 - t * t) * scale, 2 * t * scale};
  switch (hash & 3) {
    case 0:
      return v;
    case 1:
      return {-v.y, v.x};
    case 2:
      return {-v.x, -v.y};
    default:
      return {v.y, -v.x};
  }
}

void MergedType::add_instance(std::size_t s, const NodeBlock& block, const Scattering& scattering,
                              std::uint32_t index, Making& making) const {
  const FarScatter& far = scatters_[s];
  const ScatterPlan& how = making.plan.scatters[s];
  const auto place = scattering.place(*making.ground, index, block.in_tile_m);
  if (!place) return;
  const Parameters p = scattering.parameters(index);
  core::RandomStream random(world_->seed, block.coord.x, block.coord.z, index,
                            core::Purpose::kStructure);
  const std::uint64_t hash = random.next_u64();
  const glm::vec2 turn = direction_of(hash);
  if (is_by_synthesis(far, how, making.level)) {
    making.mesh.make(far.type(), p);
    const auto outline = making.mesh.outline();
    if (!outline) return;
    make_form(how.form, *outline, far.stretch_of(how.form), turn, making.form);
  } else {
    const core::Bounds box = far.type().bounds(p);
    const float width = box.max.x - box.min.x, height = box.max.y - box.min.y;
    const Representative& r = far.like(width, height, hash >> 8);
    const float across = width / r.bounds_width_m, up = height / r.bounds_height_m;
    const Outline outline = r.outline.scaled(across, up);
    if (how.form == Form::kSheet) {
      const Silhouette area{r.silhouette.side_m2 * across * up,
                            r.silhouette.plan_m2 * across * across};
      const Sheet sheet = sheet_of(outline, area, static_cast<float>(how.together));
      const auto end = [&](float sign) {
        const glm::dvec2 at = block.in_tile_m + glm::dvec2(place->x, place->z) +
                              glm::dvec2(turn) * static_cast<double>(sign * sheet.half_length_m);
        const double limit = making.tile_side_m * (1 - 1e-9);
        const glm::dvec2 inside{std::clamp(at.x, 0.0, limit), std::clamp(at.y, 0.0, limit)};
        return static_cast<float>(making.ground->at(inside).height_m) - place->y;
      };
      make_sheet(outline, sheet, turn, {end(-1), end(1)}, making.form);
    } else {
      make_form(how.form, outline, far.stretch_of(how.form), turn, making.form);
    }
  }
  const glm::vec3 corner{static_cast<float>(block.in_node_m.x), 0,
                         static_cast<float>(block.in_node_m.y)};
  making.writer.add(how.form, making.form, corner + *place, making.level == 1);
}

// Instances of the whole node are numbered block by block; `together` numbers in a row are one
// group, of which one member, drawn at random, stands for all.
void MergedType::add_scatter(std::size_t s, const NodeBlock& block, Making& making) const {
  const FarScatter& far = scatters_[s];
  const ScatterPlan& how = making.plan.scatters[s];
  if (how.forms == 0) return;
  const Scattering scattering(*world_, far.type(), far.scatter(), block.coord);
  const std::uint64_t count = far.scatter().count, first = block.ordinal * count;
  const std::uint64_t all = count << (2 * making.level);
  for (std::uint64_t g = first / how.together; g * how.together < first + count; ++g) {
    std::uint64_t member = g;
    if (how.together > 1) {
      const std::uint64_t h = core::combine(making.key, (std::uint64_t{s} << 32) | g);
      const std::uint64_t begin = g * how.together;
      member = begin + h % std::min<std::uint64_t>(how.together, all - begin);
    }
    if (member < first || member >= first + count) continue;
    add_instance(s, block, scattering,
                 far.first_index() + static_cast<std::uint32_t>(member - first), making);
  }
}

core::Bounds MergedType::synthesize(const Parameters& p, int, const MeshView& out) const {
  const LevelPlan& level = plan(p);
  PSYGEN_CHECK(out.vertices.size() == level.vertices * sizeof(core::ModelVertex) &&
                   out.indices.size() == 3 * level.triangles,
               "the destination has exactly the size of the mesh");
  const NodeWalk walk(*world_,
                      {static_cast<std::int32_t>(p.integer(kMergedBlockX)),
                       static_cast<std::int32_t>(p.integer(kMergedBlockZ))},
                      level_of(p));
  Making making{level,
                level_of(p),
                core::combine(world_->seed, p.hash()),
                walk.tile_side_m(),
                FormWriter(level.box, out),
                std::nullopt,
                {},
                {}};
  for (std::uint32_t i = 0; level.vertices > 0 && i < walk.block_count(); ++i) {
    if (walk.starts_tile(i)) making.ground.reset();
    const NodeBlock block = walk.block(i);
    if (!world_->contains(block.coord)) continue;
    if (!making.ground) walk.make_ground(i, making.ground);
    for (std::size_t s = 0; s < scatters_.size(); ++s)
      add_scatter(s, block, making);
  }
  return making.writer.finish();
}

}  // namespace

std::unique_ptr<models::ModelType> make_merged_type(std::shared_ptr<const World> world,
                                                    const models::Registry& registry) {
  return std::make_unique<MergedType>(std::move(world), registry);
}

models::Parameters merged_parameters(core::BlockCoord node, int node_level) {
  models::Parameters p;
  p.set_integer(kMergedBlockX, node.x);
  p.set_integer(kMergedBlockZ, node.z);
  p.set_integer(kMergedNodeLevel, node_level);
  return p;
}

}  // namespace psygen::world
