#include "engine/world/far/merged_models.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <new>
#include <optional>
#include <string_view>

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/far/merged_plan.hpp"
#include "engine/world/far/node_walk.hpp"
#include "engine/world/far/proxy_writer.hpp"
#include "engine/world/ground_blends.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/spacing.hpp"

namespace psygen::world {
namespace {

using models::MeshSize;
using models::MeshView;
using models::Parameters;
using models::ParameterSpec;

constexpr int kDetails = 2;
// Error of the forms of the next node level, relative to the height of the models. It doubles with
// every node level.
constexpr double kNextFormsError = 0.2;

constexpr std::uint64_t kEdition = 4;  // version of the meshes

constexpr ParameterSpec kSchema[kMergedParameterCount] = {
    models::placed(models::integer_parameter("block_x", "nodes", 0,
                                             models::HardRange{-0x1.0p31, 0x1.0p31 - 1},
                                             models::SoftRange{-1000, 1000}, "node along x")),
    models::placed(models::integer_parameter("block_z", "nodes", 0,
                                             models::HardRange{-0x1.0p31, 0x1.0p31 - 1},
                                             models::SoftRange{-1000, 1000}, "node along z")),
    models::placed(models::integer_parameter(
        "node_level", "", 1, models::HardRange{1, kMaxPlacedLevel},
        models::SoftRange{1, kMaxMergedLevel}, "the node is 2^node_level blocks wide and long")),
};

// The world itself if it has no edits, else a copy without them.
std::shared_ptr<const World> without_edits(std::shared_ptr<const World> world) {
  if (!world->edits) return world;
  auto copy = std::make_shared<World>(*world);
  set_edits(*copy, nullptr);
  return copy;
}

int level_of(const Parameters& p) {
  return static_cast<int>(
      std::clamp<std::int64_t>(p.integer(kMergedNodeLevel), 1, kMaxPlacedLevel));
}

// True for models that only modelers may make.
bool is_slow_model(const models::ModelType& type) {
  return type.is_seen_from_far() && !type.may_run_on_main_thread();
}

class MergedType final : public models::ModelType {
 public:
  MergedType(std::shared_ptr<const World> world, const models::Registry& registry,
             std::shared_ptr<const ImpostorSet> pictures,
             std::shared_ptr<const FarScatters> scatters)
      : world_(without_edits(std::move(world))),
        pictures_(std::move(pictures)),
        identity_(merged_identity(*world_, registry)) {
    if (pictures_) identity_ = core::combine(identity_, pictures_->identity());
    held_scatters_ = scatters ? std::move(scatters) : far_scatters(world_, registry);
    scatters_ = held_scatters_->all();
    for (models::ModelIndex i = 0; i < registry.size(); ++i) {
      if (registry[i].is_seen_from_far()) types_.emplace(registry[i].name(), &registry[i]);
      may_run_on_main_thread_ = may_run_on_main_thread_ && !is_slow_model(registry[i]);
    }
    for (int level = 1; level <= kMaxPlacedLevel; ++level)
      make_plans(level);
  }

  std::string_view name() const override { return "vegetation"; }
  std::string_view doc() const override {
    return "all trees and rocks of a node's blocks, a few triangles each";
  }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return kDetails; }
  int level_count_of(const Parameters& p) const override {
    return plan(p, 0).form_level == plan(p, 1).form_level ? 1 : kDetails;
  }
  double level_error_m(const Parameters& p, int level) const override {
    const double relief_m = world_->terrain.real(models::kTerrainReliefM);
    const double height_m = plan(p, 0).box.max.y - relief_m;
    if (level == 0) return 0;
    const double placed_m = std::min(static_cast<double>(extent_m(placed_on(p).reach_m)),
                                     form_error_m(*world_, plan(p, 1).form_level));
    return std::max(kNextFormsError * std::ldexp(height_m, level_of(p) - 1), placed_m);
  }
  core::Bounds bounds(const Parameters& p) const override {
    return with_reach(plan(p, 0).box, placed_on(p).reach_m);
  }
  MeshSize mesh_size(const Parameters& p, int level) const override {
    const LevelPlan& made = plan(p, level);
    return size_of(p, made, placed_plan(p, made));
  }
  double step_seconds() const override { return 350e-9; }
  double complexity(const Parameters& p, int level) const override {
    const LevelPlan& made = plan(p, level);
    return work_of(*world_, scatters_, made) + placed_plan(p, made).work();
  }
  double log2_cost(const Parameters& p) const override {
    return std::log2(static_cast<double>(std::max<std::uint64_t>(plan(p, 0).triangles, 1)));
  }
  std::optional<core::Bounds> scattered_bounds(int level) const {
    const LevelPlan& own = plans_[static_cast<std::size_t>(level)][0];
    return own.vertices > 0 ? std::optional(own.box) : std::nullopt;
  }
  core::Bounds synthesise(const Parameters& p, int level, const MeshView& out) const override;
  std::uint64_t identity() const override { return identity_; }
  bool may_run_on_main_thread() const override { return may_run_on_main_thread_; }

 private:
  struct Making;    // state of one call of synthesise()
  struct Instance;  // an instance to be added to the mesh

  void make_plans(int level) {
    auto& [own, next] = plans_[static_cast<std::size_t>(level)];
    const auto scatters = level <= kMaxMergedLevel ? scatters_ : std::span<const FarScatter>{};
    own = plan_level(*world_, scatters, pictures_.get(), level, level);
    next = plan_level(*world_, scatters, pictures_.get(), level, level + 1);
    if (next.vertices == 0) next = own;  // all models too small: keep the finer forms
    own.box = next.box = core::united(own.box, next.box);
  }
  static models::QuadCoord node_of(const Parameters& p) {
    const core::BlockCoord node{static_cast<std::int32_t>(p.integer(kMergedBlockX)),
                                static_cast<std::int32_t>(p.integer(kMergedBlockZ))};
    return models::QuadCoord::of(node, static_cast<std::uint32_t>(level_of(p)));
  }
  // The number of models that edits and the file have placed on the blocks of a node.
  models::BlockEdits::Summary placed_on(const Parameters& p) const {
    const models::QuadCoord at = node_of(p);
    models::BlockEdits::Summary sum;
    for (const models::EditLayer* layer : {p.edits(), world_->places.by_block.get()}) {
      const auto* cell = layer != nullptr ? layer->blocks.at_or_below(at) : nullptr;
      if (cell != nullptr) sum.add(cell->summary);
    }
    return sum;
  }
  MeshSize size_of(const Parameters& p, const LevelPlan& made, const PlacedPlan& placed) const {
    // Placed models that are too small leave a degenerate triangle.
    const std::uint64_t min = placed_on(p).placed > 0 ? 1 : 0;
    return {static_cast<std::uint32_t>(std::max(made.vertices + placed.vertices, min)),
            static_cast<std::uint32_t>(3 * std::max(made.triangles + placed.triangles, min)), 0,
            core::VertexLayout::kModel};
  }
  PlacedPlan placed_plan(const Parameters& p, const LevelPlan& made) const {
    const models::EditLayer* const layers[] = {p.edits(), world_->places.by_block.get()};
    return {*world_, types_, layers, node_of(p), made.form_level, made.vertices};
  }
  void add_scattered(const NodeWalk& walk, const models::EditLayer* edits, Making& making) const;
  void add_placed(const PlacedForm& form, std::uint64_t together, Making& making) const;
  const LevelPlan& plan(const Parameters& p, int level) const {
    return plans_[static_cast<std::size_t>(level_of(p))][static_cast<std::size_t>(level)];
  }
  void add_scatter(std::size_t s, const NodeBlock& block, BlockObstacles& obstacles,
                   Making& making) const;
  void make_from_like(const Instance& instance, const Parameters& p, Making& making) const;
  void add_instance(Instance& instance, const Scattering& scattering, Making& making) const;

  std::shared_ptr<const World> world_;
  std::shared_ptr<const ImpostorSet> pictures_;  // null: none
  std::uint64_t identity_;
  TypesByName types_;  // of the registry, if they are seen from far
  std::shared_ptr<const FarScatters> held_scatters_;
  std::span<const FarScatter> scatters_;  // of these
  bool may_run_on_main_thread_ = true;
  // Indexed by node level (0 is unused) and level of detail. Plans of one node level have equal
  // boxes.
  std::array<std::array<LevelPlan, kDetails>, kMaxPlacedLevel + 1> plans_;
};

struct MergedType::Making {
  const LevelPlan& plan;
  std::uint64_t key;  // key of the node's random numbers
  ProxyWriter writer;
  models::BlockGround node_ground;            // ground of the whole node
  int drawn_stride;                           // stride of the drawn ground
  std::optional<models::BlockGround> ground;  // ground of the current tile, for slopes and heights
  SampleMesh mesh;
  ProxyMesh form;
  std::vector<std::uint64_t> room;            // for further forms of each scatter
  const models::BlockEdits* edits = nullptr;  // edits of the current block; may be null
};

struct MergedType::Instance {
  std::size_t scatter;
  const NodeBlock& block;
  std::uint32_t index;     // within the block
  std::uint32_t together;  // number of models that it represents
  std::uint64_t hash;
  glm::vec3 place{0.0F};  // metres from the block's corner
};

// A unit vector from a hash, without sines. Its distribution is not uniform.
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

// Makes the form of an instance from a representative, without synthesis.
void MergedType::make_from_like(const Instance& instance, const Parameters& p,
                                Making& making) const {
  const FarScatter& far = scatters_[instance.scatter];
  const Form form = making.plan.scatters[instance.scatter].form;
  if (form == Form::kPicture) {
    SampleMesh* const scratch = making.plan.form_level == 1 ? &making.mesh : nullptr;
    return pictures_->make_quad(far.scatter().model, p, scratch, making.form);
  }
  const core::Bounds box = far.type().bounds(p);
  const Likeness like = far.like(box.max.x - box.min.x, box.max.y - box.min.y, instance.hash >> 8);
  const Outline outline = like.model->outline.scaled(like.across, like.up);
  if (!is_billboard(form))
    return make_proxy(form, outline, far.width_of(form), direction_of(instance.hash), making.form);
  const Silhouette area = like.model->silhouette.scaled(like.across, like.up);
  make_billboard(form, outline,
                 billboard_of(form, outline, area, static_cast<float>(instance.together)),
                 making.form);
}

void MergedType::add_instance(Instance& instance, const Scattering& scattering,
                              Making& making) const {
  const FarScatter& far = scatters_[instance.scatter];
  const ScatterPlan& how = making.plan.scatters[instance.scatter];
  const NodeBlock& block = instance.block;
  const auto place = scattering.place(*making.ground, instance.index, block.in_tile_m);
  if (!place || making.room[instance.scatter] == 0) return;
  --making.room[instance.scatter];
  instance.place = place->position;
  const glm::dvec2 in_node = block.in_node_m + glm::dvec2(place->position.x, place->position.z);
  instance.place.y =
      static_cast<float>(making.node_ground.at(in_node, making.drawn_stride).height_m);
  if (far.scatter().footprint_m > 0) {  // as far below the ground as near
    const glm::dvec2 in_tile = in_node - block.in_node_m + block.in_tile_m;
    instance.place.y -= static_cast<float>(making.ground->at(in_tile).height_m) - place->position.y;
  }
  const Parameters p = scattering.parameters(instance.index);
  const glm::vec3 foot = instance.place + glm::vec3(block.in_node_m.x, 0, block.in_node_m.y);
  const bool sways = making.plan.form_level == 1;
  if (how.mesh != nullptr) {
    making.mesh.make(far.type(), p, how.mesh->level);
    if (making.mesh.vertices().size() == how.mesh->vertices * sizeof(core::ModelVertex))
      making.writer.add(making.mesh.vertices(), making.mesh.indices(far.type()), making.mesh.box(),
                        foot, sways);
    return;
  }
  if (how.each_is_synthesised) {
    making.mesh.make(far.type(), p);
    const auto outline = making.mesh.outline();
    if (!outline) return;
    make_proxy(how.form, *outline, far.width_of(how.form), direction_of(instance.hash),
               making.form);
  } else {
    make_from_like(instance, p, making);
  }
  making.writer.add(how.form, making.form, foot, sways);
}

// Numbers the instances of the whole node block by block. Every `together` consecutive instances
// form a group, which one random member represents.
void MergedType::add_scatter(std::size_t s, const NodeBlock& block, BlockObstacles& obstacles,
                             Making& making) const {
  const FarScatter& far = scatters_[s];
  const ScatterPlan& how = making.plan.scatters[s];
  if (how.forms == 0) return;
  const Scattering scattering(*world_, far.type(), far.scatter(), obstacles);
  const std::uint64_t count = far.scatter().count, first = block.ordinal * count;
  const std::uint64_t all = count << (2 * making.plan.level);
  for (std::uint64_t g = first / how.together; g * how.together < first + count; ++g) {
    const std::uint64_t begin = g * how.together;
    const std::uint64_t size = std::min<std::uint64_t>(how.together, all - begin);
    const std::uint64_t drawn = core::combine(making.key, (std::uint64_t{s} << 32) | g);
    const std::uint64_t member = begin + (size == 1 ? 0 : drawn % size);
    if (member < first || member >= first + count) continue;
    const std::uint32_t index = far.first_index() + static_cast<std::uint32_t>(member - first);
    if (making.edits != nullptr && making.edits->is_removed(index)) continue;
    core::RandomStream random(world_->seed, block.coord.x, block.coord.z, index,
                              core::Purpose::kStructure);
    Instance instance{s, block, index, static_cast<std::uint32_t>(size), random.next_u64()};
    add_instance(instance, scattering, making);
  }
}

void MergedType::add_scattered(const NodeWalk& walk, const models::EditLayer* edits,
                               Making& making) const {
  const std::size_t questions = questions_per_tile(*world_, making.plan);
  constexpr std::uint32_t kSharing = 64;  // 8 × 8 blocks draw their candidates together
  std::optional<SpacedBlocks> spaced;
  for (std::uint32_t i = 0; i < walk.block_count(); ++i) {
    if (walk.starts_tile(i)) making.ground.reset();
    const NodeBlock block = walk.block(i);
    if (!world_->contains(block.coord)) continue;
    if (!making.ground) walk.make_ground(i, questions, making.ground);
    making.edits = edits != nullptr ? edits->block(block.coord) : nullptr;
    if (i % kSharing == 0) spaced.emplace(*world_);
    BlockObstacles obstacles(*world_, block.coord, &*spaced);
    for (std::size_t s = 0; s < scatters_.size(); ++s)
      add_scatter(s, block, obstacles, making);
  }
}

// `together`: models that the form stands for.
void MergedType::add_placed(const PlacedForm& placed, std::uint64_t together,
                            Making& making) const {
  const models::PlacedModel& model = *placed.model;
  const double ground_m = making.node_ground.at(placed.in_node_m, making.drawn_stride).height_m;
  const glm::vec3 foot{placed.in_node_m.x, static_cast<float>(ground_m) + model.above_m,
                       placed.in_node_m.y};
  const bool sways = making.plan.form_level == 1;
  if (placed.mesh_level == PlacedForm::kProxy) {
    const auto form = make_placed_proxy(placed, making.plan.form_level, together, making.mesh,
                                        direction_of(core::mix64(model.id)), making.form);
    if (form) making.writer.add(*form, making.form, foot, sways);
    return;
  }
  try {  // user types may throw; our own code throws only when memory is exhausted
    making.mesh.make(*placed.type, model.parameters, placed.mesh_level);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
    return;
  }
  making.writer.add(making.mesh.vertices(), making.mesh.indices(*placed.type), making.mesh.box(),
                    foot, sways);
}

core::Bounds MergedType::synthesise(const Parameters& p, int level, const MeshView& out) const {
  const core::RoundToNearest rounding;
  const LevelPlan& made = plan(p, level);
  const PlacedPlan placed = placed_plan(p, made);
  const MeshSize size = size_of(p, made, placed);
  PSYGEN_CHECK(out.vertices.size() == size.vertex_count * sizeof(core::ModelVertex) &&
                   out.indices.size() == size.index_count,
               "the destination must have exactly the size of the mesh");
  const NodeWalk walk(*world_,
                      {static_cast<std::int32_t>(p.integer(kMergedBlockX)),
                       static_cast<std::int32_t>(p.integer(kMergedBlockZ))},
                      level_of(p));
  Parameters node = p;  // edits do not change the members that represent groups
  node.set_edits(nullptr, 0);
  Making making{made,
                core::combine(world_->seed, node.hash()),
                ProxyWriter(bounds(p), out),
                walk.whole_ground(p.edits()),
                walk.drawn_stride(),
                std::nullopt,
                {},
                {},
                {}};
  for (const ScatterPlan& how : made.scatters)
    making.room.push_back(how.forms);
  if (made.vertices > 0) add_scattered(walk, p.edits(), making);
  for (std::size_t i = 0; i < placed.forms.size(); ++i)
    add_placed(placed.forms[i], i < placed.shared_from ? 1 : placed.together, making);
  return making.writer.finish();
}

}  // namespace

std::uint64_t merged_identity(const World& world, const models::Registry& registry) {
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
    if (s.limits_depth() || s.water_reach_m() > 0) {
      add_real(s.max_depth_m);
      add_real(s.near_water_m);
      add_real(world.water.level_m);
    }
    if (const std::uint64_t site = site_hash(s.site); site != 0) add(site);
    if (s.site.edge_size < 1) add_real(s.site.edge_size);
    if (const std::uint64_t mask = mask_hash(s.mask); mask != 0) add(mask);
    if (s.keeps_apart() || s.footprint_m > 0 || s.tilt < 1) {
      add_real(s.spacing_m);
      add_real(s.footprint_m);
      add_real(s.tilt);
    }
  }
  if (const std::uint64_t shape = shape_hash(world); shape != 0) add(shape);
  if (const std::uint64_t places = places_hash(world, registry); places != 0) {
    add(places);
    for (const Place& place : world.places.all)
      add(registry[place.model].identity());
  }
  if (const std::uint64_t ground = placing_hash(world); ground != 0) add(ground);
  return h;
}

std::unique_ptr<models::ModelType> make_merged_type(std::shared_ptr<const World> world,
                                                    const models::Registry& registry,
                                                    std::shared_ptr<const ImpostorSet> pictures,
                                                    std::shared_ptr<const FarScatters> scatters) {
  return std::make_unique<MergedType>(std::move(world), registry, std::move(pictures),
                                      std::move(scatters));
}

std::optional<core::Bounds> scattered_bounds(const models::ModelType& merged, int node_level) {
  return static_cast<const MergedType&>(merged).scattered_bounds(node_level);
}

models::Parameters merged_parameters(core::BlockCoord node, int node_level) {
  models::Parameters p;
  p.set_integer(kMergedBlockX, node.x);
  p.set_integer(kMergedBlockZ, node.z);
  p.set_integer(kMergedNodeLevel, node_level);
  return p;
}

models::Parameters merged_parameters(const World& world, core::BlockCoord node, int node_level) {
  models::Parameters p = merged_parameters(node, node_level);
  if (!world.edits) return p;
  const auto at = models::QuadCoord::of(node, static_cast<std::uint32_t>(node_level));
  std::uint64_t hash =
      world.edits->ground.edits.hash_of(at, ground_margin(world, node_level), world.block_size_m());
  if (const auto* cell = world.edits->blocks.at_or_below(at); cell != nullptr)
    hash = core::combine(hash, cell->hash);
  if (hash != 0) p.set_edits(world.edits.get(), hash);
  return p;
}

}  // namespace psygen::world
