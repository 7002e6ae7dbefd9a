// Models that are placed one by one keep their silhouette at every distance until they are smaller
// than the error allowed, whatever else the world has, and whoever places them.
#include "engine/world/edits/edits.hpp"
#include "tests/engine/app/golden.hpp"
#include "tests/engine/handmade/shapes.hpp"

namespace psygen::app {
namespace {

constexpr core::Extent kPictureSize{320, 180};

// A world with a model, a ball of one colour that nothing else has.
struct Place {
  std::string tables = {};  // more of the world
  bool edited = false;      // an edit places the model; else the world file does
  bool levels = true;       // levels of detail
};

class Landscape {
 public:
  explicit Landscape(const Place& place) {
    gltf::Sample sample = handmade::ball(24, 32);
    sample.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0, 1, 1};
    std::ofstream(folder_ / "ball.glb", std::ios::binary) << sample.glb();
    std::ofstream(folder_ / "w.toml")
        << "format = 1\n[world]\nname = \"flat\"\nseed = 5\nblocks = [32, 32]\n[terrain]\n"
           "relief_m = 1\n[sky]\ncloud_cover = 0\n[[model]]\nname = \"ball\"\nfile = \"ball.glb\"\n"
           "size_m = 9\n"
        << place.tables
        << (place.edited ? "" : "[[place]]\nmodel = \"ball\"\nat_m = [1000, 1000]\n");
    SessionOptions options = short_session();
    options.validation = false;
    options.world_file = folder_ / "w.toml";
    options.size = kPictureSize;
    options.scene.view_distance_m = 1900;
    options.scene.levels_of_detail = place.levels;
    auto session = Session::create(options);
    EXPECT_TRUE(session) << session.error().message;
    session_ = std::move(*session);
    if (place.edited) place_by_edit();
  }

  // The pixels of the model from this distance.
  std::size_t pixels_at(double distance_m) {
    const core::CameraPose pose = pose_at(distance_m);
    session_->scene().settle(pose);
    EXPECT_TRUE(session_->tick(pose, 1.0 / 60.0));
    const image::Image image = captured(*session_);
    std::size_t pixels = 0;
    for (std::uint32_t y = 0; y < kPictureSize.height; ++y)
      for (std::uint32_t x = 0; x < kPictureSize.width; ++x) {
        const auto p = image.pixel(x, y);
        pixels += p[0] > p[1] + 12 && p[2] > p[1] + 12 ? 1 : 0;
      }
    return pixels;
  }

 private:
  core::CameraPose pose_at(double distance_m) const {
    core::CameraPose pose;
    pose.position = core::normalised({{0, 0}, {1000, 20, 1000 + distance_m}}, 63);
    pose.pitch = -std::atan2(14, distance_m);
    return pose;
  }
  void place_by_edit() {
    // In view before: nodes get their first merged mesh from the edit.
    session_->scene().settle(pose_at(300));
    EXPECT_TRUE(session_->tick(pose_at(300), 1.0 / 60.0));
    const models::Registry& registry = session_->scene().registry();
    const auto model = static_cast<models::ModelIndex>(registry.find("ball"));
    world::Edits edits;
    const core::WorldPosition at = core::normalised({{0, 0}, {1000, 0, 1000}}, 63);
    EXPECT_TRUE(edits.place(session_->scene().world(), registry,
                            {model, models::default_parameters(registry[model]), at, 0}));
    session_->scene().edit(edits);
  }

  const TemporaryFolder folder_;
  std::unique_ptr<Session> session_;
};

const std::string kRocks = "[[scatter]]\nmodel = \"rock\"\ncount = 2\n";
const std::string kTrees = "[[scatter]]\nmodel = \"tree\"\ncount = 1\n";

TEST(PlacedFar, AModelCoversAsManyPixelsAsWithFullDetailInEveryWorld) {
  constexpr double kDistancesM[] = {40, 100, 180, 300, 420};
  std::vector<std::size_t> full;
  Landscape finest({.levels = false});
  for (const double distance_m : kDistancesM)
    full.push_back(finest.pixels_at(distance_m));
  EXPECT_GT(full.back(), 4U);
  for (const Place& place : {Place{}, Place{kRocks}, Place{kTrees}, Place{"", true}}) {
    Landscape land(place);
    for (std::size_t i = 0; i < full.size(); ++i) {
      const auto expected = static_cast<double>(full[i]);
      EXPECT_NEAR(static_cast<double>(land.pixels_at(kDistancesM[i])), expected,
                  std::max(0.15 * expected, 3.0))
          << place.tables << (place.edited ? "edited" : "") << " at " << kDistancesM[i] << " m";
    }
  }
}

// Scattered models of one shape keep it too.
TEST(PlacedFar, ScatteredModelsOfOneShapeKeepTheirPixels) {
  const std::string scatter = "[[scatter]]\nmodel = \"ball\"\ncount = 1\n";
  Landscape finest({.tables = scatter, .edited = true, .levels = false});
  Landscape land({.tables = scatter, .edited = true});
  for (const double distance_m : {100.0, 300.0}) {
    const auto expected = static_cast<double>(finest.pixels_at(distance_m));
    ASSERT_GT(expected, 4);
    EXPECT_NEAR(static_cast<double>(land.pixels_at(distance_m)), expected, 0.2 * expected);
  }
}

}  // namespace
}  // namespace psygen::app
