#include "editor/cost/block_cost.hpp"

#include <QLocale>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "editor/cost/block_survey.hpp"
#include "editor/document/scale.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

using world::FieldKind;

constexpr int kPoints = 24;        // of a curve of reals
constexpr int kMeasuredEvery = 6;  // points

std::string toml_of(const world::WorldField& field, double value) {
  const bool integer = is_whole(field.kind);
  if (field.kind == FieldKind::kInteger || field.kind == FieldKind::kReal)
    return integer ? world::toml_number(static_cast<std::int64_t>(std::llround(value)))
                   : world::toml_number(value);
  return world::toml_range(std::min(field.numbers[0], value), value, integer);
}

// Makes texts that differ in one value. Finds the position of the value only once.
class TextsOfField {
 public:
  TextsOfField(const std::string& text, const world::TextPath& path) : text_(text), path_(path) {
    static constexpr std::string_view kMark = "\"\\u0001 value \\u0001\"";
    const auto marked = world::with_value(text, path, kMark);
    const std::size_t at = marked ? marked->find(kMark) : std::string::npos;
    if (at == std::string::npos || marked->find(kMark, at + 1) != std::string::npos) return;
    is_found_ = true;
    before_ = marked->substr(0, at);
    behind_ = marked->substr(at + kMark.size());
  }
  core::Result<std::string> with(const std::string& toml) const {
    if (is_found_) return before_ + toml + behind_;
    return world::with_value(text_, path_, toml);
  }

 private:
  const std::string& text_;
  const world::TextPath& path_;
  bool is_found_ = false;
  std::string before_, behind_;
};

std::vector<double> values_of(const world::WorldField& field) {
  const Scale scale = scale_of(field);
  const double span = scale.high - scale.low;
  const int points = scale.whole ? static_cast<int>(std::min<double>(span + 1, kPoints)) : kPoints;
  std::vector<double> values;
  for (int i = 0; i < points; ++i)
    values.push_back(scale.at(points > 1 ? static_cast<double>(i) / (points - 1) : 0));
  return values;
}

}  // namespace

core::BlockCoord block_near(const world::World& world, core::BlockCoord around, int number) {
  // The corners of a square, then the middles of the sides of a larger one, then both farther out.
  constexpr std::array<std::array<int, 2>, 8> kOffsets{
      {{-3, -3}, {3, 3}, {3, -3}, {-3, 3}, {0, -6}, {0, 6}, {-6, 0}, {6, 0}}};
  const auto& offset = kOffsets[static_cast<std::size_t>(number) % kOffsets.size()];
  const int ring = 1 + number / static_cast<int>(kOffsets.size());
  const auto clamped = [](std::int64_t at, std::int64_t blocks) {
    return static_cast<std::int32_t>(blocks == 0 ? at
                                                 : std::clamp<std::int64_t>(at, 0, blocks - 1));
  };
  return {clamped(std::int64_t{around.x} + offset[0] * ring, world.blocks_x),
          clamped(std::int64_t{around.z} + offset[1] * ring, world.blocks_z)};
}

MeshCost mesh_cost(const ParsedWorld& parsed, models::ModelIndex model, const models::Parameters& p,
                   const synthesis::CostModel& costs) {
  MeshCost cost;
  cost.seconds = costs.predict(model, p, 0);
  const auto size = synthesis::mesh_size_guarded(parsed.registry[model], p, 0);
  if (!size) return cost;
  cost.triangles = size->triangle_count();
  cost.bytes = static_cast<double>(size->vertex_count) * core::vertex_stride_bytes(size->layout) +
               (size->shared_indices != 0 ? 0.0 : 2.0 * size->index_count);
  return cost;
}

bool has_cost_curve(const world::WorldField& field) {
  const bool number = field.kind == FieldKind::kInteger || field.kind == FieldKind::kReal ||
                      field.kind == FieldKind::kIntegerRange || field.kind == FieldKind::kRealRange;
  const std::string& table = field.path.empty() ? std::string() : field.path.steps[0].key;
  return number && !field.numbers.empty() && table != "sky" && table != "palette" &&
         table != "water";
}

BlockCost block_cost(const ParsedWorld& parsed, core::BlockCoord around,
                     const synthesis::CostModel* learnt, bool measure) {
  return BlockSurvey(around, learnt).cost(parsed, measure);
}

std::vector<CostPoint> cost_curve(const CurveInput& input, const std::function<bool()>& go_on) {
  const world::WorldField& field = input.field;
  std::vector<CostPoint> curve;
  if (!has_cost_curve(field)) return curve;
  BlockSurvey survey(input.around, input.learnt);
  const TextsOfField texts(input.text, field.path);
  int number = 0;
  for (const double value : values_of(field)) {
    if (!go_on()) return {};
    CostPoint point{.value = value};
    const auto changed = texts.with(toml_of(field, value));
    const auto parsed =
        changed ? parse_world_text(*changed, input.file, input.register_models, input.files)
                : tl::make_unexpected(changed.error());
    if (parsed) {
      point.cost = survey.cost(**parsed, number++ % kMeasuredEvery == 0);
    } else {
      point.error = parsed.error().message;
    }
    curve.push_back(std::move(point));
  }
  return curve;
}

}  // namespace psygen::editor
