#include "engine/models/registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/models/rock/rock.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::models {
namespace {

using ::testing::HasSubstr;

// A model type with a schema and nothing else of interest.
class SchemaOnly final : public ModelType {
 public:
  SchemaOnly(std::string_view name, std::vector<ParameterSpec> specs)
      : name_(name), specs_(std::move(specs)) {}
  std::string_view name() const override { return name_; }
  std::string_view doc() const override { return "for tests"; }
  std::span<const ParameterSpec> parameters() const override { return specs_; }
  int level_count() const override { return 1; }
  double level_error_m(const Parameters&, int) const override { return 0; }
  core::Bounds bounds(const Parameters&) const override { return {}; }
  MeshSize mesh_size(const Parameters&, int) const override { return {}; }
  double complexity(const Parameters&, int) const override { return 1; }
  double log2_cost(const Parameters&) const override { return 0; }
  core::Bounds synthesise(const Parameters&, int, const MeshView&) const override { return {}; }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}

 private:
  std::string_view name_;
  std::vector<ParameterSpec> specs_;
};

ParameterSpec spec(std::string_view name) {
  return {name, ParameterType::kReal, "m", 1, 0, 10, 0, 5, "a length"};
}

std::string refusal(std::vector<ParameterSpec> specs, std::string_view name = "fence") {
  Registry registry;
  const auto added = registry.add(std::make_unique<SchemaOnly>(name, std::move(specs)));
  EXPECT_FALSE(added.has_value());
  EXPECT_EQ(registry.size(), 0u);
  return added ? "" : added.error().message;
}

TEST(Registry, KnowsTheSurfaceKindOfModels) {
  const Registry registry = make_standard_registry();
  for (ModelIndex i = 0; i < registry.size(); ++i) {
    const std::string_view name = registry[i].name();
    EXPECT_EQ(registry[i].surface(), name == "rock"   ? core::SurfaceKind::kStone
                                     : name == "tree" ? core::SurfaceKind::kBark
                                                      : core::SurfaceKind::kPlain)
        << name;
  }
}

TEST(Registry, StandardOneHoldsTerrainRockTreeAndGrassInThisOrder) {
  const Registry registry = make_standard_registry();
  ASSERT_EQ(registry.size(), 4u);
  EXPECT_EQ(registry[0].name(), "terrain");
  EXPECT_EQ(registry[1].name(), "rock");
  EXPECT_EQ(registry[2].name(), "tree");
  EXPECT_EQ(registry[3].name(), "grass");
  EXPECT_EQ(registry.find("tree"), 2);
  EXPECT_EQ(registry.find("house"), -1);
}

// Otherwise a hole would persist while modelers get no processor.
TEST(Registry, EveryStandardTypeMayFillAHoleOnTheMainThread) {
  const Registry registry = make_standard_registry();
  for (ModelIndex i = 0; i < registry.size(); ++i)
    EXPECT_TRUE(registry[i].may_run_on_main_thread()) << registry[i].name();
}

TEST(Registry, AcceptsTypesOfUsersAndRejectsASecondOfTheSameName) {
  Registry registry;
  const auto first =
      registry.add(std::make_unique<SchemaOnly>("fence", std::vector{spec("height_m")}));
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(*first, 0);
  const auto second = registry.add(std::make_unique<SchemaOnly>("fence", std::vector{spec("a")}));
  ASSERT_FALSE(second.has_value());
  EXPECT_THAT(second.error().message, HasSubstr("fence"));
  EXPECT_FALSE(registry.add(nullptr).has_value());
  EXPECT_EQ(registry.size(), 1u);
}

TEST(Registry, RejectsBrokenSchemasNamingTheParameter) {
  EXPECT_THAT(refusal({spec("a")}, "Fence Post"), HasSubstr("Fence Post"));
  EXPECT_THAT(refusal({spec("a"), spec("Height")}), HasSubstr("Height"));
  EXPECT_THAT(refusal({spec("width"), spec("width")}), HasSubstr("width occurs twice"));
  EXPECT_THAT(refusal(std::vector(25, spec("many"))), HasSubstr("24"));
  ParameterSpec outside = spec("too_long");
  outside.default_value = 11;
  EXPECT_THAT(refusal({outside}), HasSubstr("too_long"));
  ParameterSpec nan = spec("strange");
  nan.hard_max = std::nan("");
  EXPECT_THAT(refusal({nan}), HasSubstr("strange"));
  ParameterSpec fraction = spec("count");
  fraction.type = ParameterType::kInteger;
  fraction.soft_max = 2.5;
  EXPECT_THAT(refusal({fraction}), HasSubstr("count"));
  ParameterSpec reversed = spec("reversed");
  std::swap(reversed.soft_min, reversed.soft_max);
  EXPECT_THAT(refusal({reversed}), HasSubstr("reversed"));
}

TEST(Parameters, DefaultsAreValidAndFoundByName) {
  const Registry registry = make_standard_registry();
  for (ModelIndex i = 0; i < registry.size(); ++i) {
    const auto valid = validate(registry[i], default_parameters(registry[i]));
    EXPECT_TRUE(valid.has_value()) << valid.error().message;
    for (std::size_t k = 0; k < registry[i].parameters().size(); ++k)
      EXPECT_EQ(parameter_index(registry[i], registry[i].parameters()[k].name),
                static_cast<int>(k));
    EXPECT_EQ(parameter_index(registry[i], "no_such"), -1);
  }
}

TEST(Parameters, AreRejectedByNameOutsideTheirRange) {
  const Registry registry = make_standard_registry();
  for (ModelIndex m = 0; m < registry.size(); ++m) {
    const ModelType& type = registry[m];
    for (std::size_t i = 0; i < type.parameters().size(); ++i) {
      const ParameterSpec& s = type.parameters()[i];
      std::vector<Parameters> hostile;
      const auto with = [&](auto set) {
        Parameters p = default_parameters(type);
        set(p);
        hostile.push_back(p);
      };
      if (s.type == ParameterType::kReal) {
        for (const double v :
             {s.hard_min - 1, s.hard_max + 1, std::nan(""), std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()})
          with([&](Parameters& p) { p.set_real(i, v); });
      } else if (s.hard_max < 0x1.0p62) {
        for (const std::int64_t v :
             {static_cast<std::int64_t>(s.hard_min) - 1, static_cast<std::int64_t>(s.hard_max) + 1,
              std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()})
          with([&](Parameters& p) { p.set_integer(i, v); });
      }
      for (const Parameters& p : hostile) {
        const auto result = validate(type, p);
        ASSERT_FALSE(result.has_value()) << type.name() << "." << s.name;
        EXPECT_EQ(result.error().code, core::ErrorCode::kInvalidArgument);
        EXPECT_THAT(result.error().message, HasSubstr(std::string(s.name)));
        EXPECT_THAT(result.error().message, HasSubstr("predicted cost"));
      }
    }
  }
}

TEST(Parameters, OfHostileRocksAreRejectedWithTheirPredictedCost) {
  const auto type = make_rock_type();
  Parameters p = default_parameters(*type);
  p.set_integer(kRockSubdivisions, 40);
  const auto result = validate(*type, p);
  ASSERT_FALSE(result.has_value());
  EXPECT_THAT(result.error().message, HasSubstr("subdivisions = 40"));
  EXPECT_THAT(result.error().message, HasSubstr("from 0 to 6"));
  EXPECT_THAT(result.error().message, HasSubstr("2^82"));
}

TEST(Parameters, OverTheBudgetAreRejectedWithTheirCost) {
  const auto type = make_rock_type();
  Parameters p = default_parameters(*type);
  p.set_integer(kRockSubdivisions, 6);
  EXPECT_TRUE(validate(*type, p).has_value());
  const auto result = validate(*type, p, 10);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, core::ErrorCode::kOverBudget);
  EXPECT_THAT(result.error().message, HasSubstr("subdivisions = 6"));
  EXPECT_THAT(result.error().message, HasSubstr("16384 triangles"));
}

TEST(Parameters, HashChangesWithEveryParameter) {
  const auto type = make_terrain_type();
  const Parameters base = default_parameters(*type);
  for (std::size_t i = 0; i < type->parameters().size(); ++i) {
    Parameters changed = base;
    changed.set_integer(i, base.integer(i) + 1);
    EXPECT_NE(changed.hash(), base.hash());
  }
}

}  // namespace
}  // namespace psygen::models
