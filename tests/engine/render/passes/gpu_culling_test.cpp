#include "engine/render/passes/gpu_culling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <tuple>

#include "engine/render/meshes/layouts.hpp"
#include "engine/render/meshes/view_volume.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

constexpr core::Extent kOddSize{203, 117};  // halves that do not come out even
constexpr int kHillSide = 33;

auto key(const DrawnMesh& m) {
  return std::tuple(m.layout, m.pool_block, m.shared, m.first_index, m.index_count, m.vertex_offset,
                    m.place.x, m.place.y, m.place.z);
}

// Those in view.
template <class Draw>
std::vector<Draw> in_view_of(const FrameInput& input, const std::vector<Draw>& draws) {
  const ViewVolume volume =
      view_volume(core::projection_matrix(input.projection) * core::view_rotation(input.pose));
  std::vector<Draw> seen;
  std::copy_if(draws.begin(), draws.end(), std::back_inserter(seen),
               [&](const Draw& draw) { return in_view(volume, bounds_of(draw)); });
  return seen;
}

// A renderer with a landscape of its own: hills, and sheets of many cells.
class Landscape {
 public:
  void create(RenderPath path, bool occlusion, Preset preset = Preset::kLow) {
    RendererOptions options;
    options.validation = true;
    options.size = kOddSize;
    options.geometry_budget_bytes = 8 << 20;
    options.path = path;
    options.occlusion = occlusion;
    options.preset = preset;
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    renderer = std::move(*made);
    ASSERT_EQ(renderer->path(), path);
    const auto grid = renderer->upload_shared_indices(synthetic::grid_indices(kHillSide));
    ASSERT_TRUE(grid);
    grid_ = *grid;
  }
  void end() {
    if (!renderer) return;
    renderer->wait_idle();
    for (const std::string& message : renderer->validation_messages())
      ADD_FAILURE() << message;
  }

  void add_hills(int nodes) {
    for (int z = -nodes; z < nodes; ++z) {
      for (int x = -nodes; x < nodes; ++x) {
        const auto hill = [=](int i, int k) {
          const float px = static_cast<float>(i + 32 * x), pz = static_cast<float>(k + 32 * z);
          return 0.5F + 0.25F * (std::sin(px * 0.11F) + std::sin(pz * 0.13F));
        };
        const auto range = synthetic::make_terrain(renderer->geometry(), kHillSide, hill);
        ASSERT_TRUE(range);
        TerrainDraw draw;
        draw.range = *range;
        draw.shared_indices = grid_;
        draw.cell_m = 4;
        draw.side_m = 128;
        draw.origin = {static_cast<float>(128 * x), -30, static_cast<float>(128 * z)};
        draw.height_range_m = 50;
        terrain.push_back(draw);
      }
    }
  }
  void add_boxes(int count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-250, 250), size(1, 9);
    for (int i = 0; i < count; ++i) {
      const auto fine = synthetic::make_sheet(renderer->geometry(), 9);
      ASSERT_TRUE(fine);
      MeshDraw draw;
      draw.range = *fine;
      draw.origin = {place(random), -25, place(random)};
      draw.box_half_extent = glm::vec3(size(random));
      draw.box_centre = {0, draw.box_half_extent.y, 0};
      models.push_back(draw);
    }
  }
  // A box of its own mesh, so that it has a bit of its own.
  void add_box(glm::vec3 centre, glm::vec3 half_extent, glm::vec3 albedo) {
    const auto range = synthetic::make_box(renderer->geometry(), albedo);
    ASSERT_TRUE(range);
    MeshDraw draw;
    draw.range = *range;
    draw.origin = centre;
    draw.box_half_extent = half_extent;
    models.push_back(draw);
  }

  FrameResult draw(FrameInput input) {
    // The CPU path draws what it is given.
    const bool all = renderer->path() == RenderPath::kGpu;
    const auto seen_terrain = in_view_of(input, terrain);
    const auto seen_models = in_view_of(input, models);
    input.terrain = all ? terrain : seen_terrain;
    input.models = all ? models : seen_models;
    const auto result = renderer->render(input);
    EXPECT_TRUE(result) << result.error().message;
    return result ? *result : FrameResult{};
  }
  Picture picture() {
    auto made = renderer->capture();
    EXPECT_TRUE(made);
    return made ? *made : Picture{};
  }
  std::vector<DrawnMesh> drawn() {
    auto made = renderer->drawn_meshes();
    EXPECT_TRUE(made);
    std::vector<DrawnMesh> list = made ? *made : std::vector<DrawnMesh>{};
    std::sort(list.begin(), list.end(),
              [](const DrawnMesh& a, const DrawnMesh& b) { return key(a) < key(b); });
    return list;
  }
  bool draws_box(std::size_t index) {
    const auto list = drawn();
    return std::any_of(list.begin(), list.end(), [&](const DrawnMesh& mesh) {
      return mesh.layout == core::VertexLayout::kModel && mesh.place == models[index].origin;
    });
  }

  std::unique_ptr<Renderer> renderer;
  std::vector<TerrainDraw> terrain;
  std::vector<MeshDraw> models;

 private:
  std::uint32_t grid_ = 0;
};

FrameInput look(double yaw, double pitch) {
  FrameInput input = synthetic::look(12.0, pitch, kOddSize);
  input.pose.yaw = yaw;
  input.light.haze_density = 0.0004F;
  return input;
}

void expect_same_lists(const std::vector<DrawnMesh>& a, const std::vector<DrawnMesh>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(key(a[i]), key(b[i])) << i;
}

// 5 of 255 on at most a thousandth of the pixels, as golden pictures demand.
void expect_same_pictures(const Picture& a, const Picture& b) {
  ASSERT_EQ(a.rgba.size(), b.rgba.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}));
    different += most > 5 ? 1 : 0;
  }
  EXPECT_LE(different * 1000, a.rgba.size() / 4);
}

class GpuCullingTest : public testing::Test {
 protected:
  void TearDown() override {
    cpu_.end();
    gpu_.end();
  }
  void landscape(bool occlusion) {
    cpu_.create(RenderPath::kCpu, occlusion);
    gpu_.create(RenderPath::kGpu, occlusion);
    for (Landscape* side : {&cpu_, &gpu_}) {
      side->add_hills(3);
      side->add_boxes(1500);
    }
  }

  Landscape cpu_, gpu_;
};

TEST_F(GpuCullingTest, DrawsTheSameListAsTheCpuPathFromAnyPlace) {
  landscape(false);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> turn(-3, 3), tilt(-0.8, 0.5);
  std::size_t fewest = SIZE_MAX, most = 0;
  for (int i = 0; i < 30; ++i) {
    const FrameInput input = look(turn(random), tilt(random));
    cpu_.draw(input);
    gpu_.draw(input);
    const auto list = gpu_.drawn();
    expect_same_lists(list, cpu_.drawn());
    fewest = std::min(fewest, list.size());
    most = std::max(most, list.size());
  }
  EXPECT_GT(fewest, 10u);
  EXPECT_LT(most, 1000u) << "something is out of view";
}

TEST_F(GpuCullingTest, DrawsAllThatIsInViewInItsFirstFrame) {
  landscape(true);
  cpu_.draw(look(0.4, -0.05));
  gpu_.draw(look(0.4, -0.05));
  expect_same_lists(gpu_.drawn(), cpu_.drawn());
}

TEST_F(GpuCullingTest, ShowsThePicturesOfTheCpuPathWhileTheCameraMoves) {
  landscape(true);
  std::size_t fewer = 0;
  for (int i = 0; i < 16; ++i) {
    const FrameInput input = look(0.1 * i, -0.05);
    cpu_.draw(input);
    gpu_.draw(input);
    expect_same_pictures(gpu_.picture(), cpu_.picture());
    fewer += gpu_.drawn().size() < cpu_.drawn().size() ? 1 : 0;
  }
  EXPECT_GT(fewer, 4u) << "nothing was ever hidden";
}

TEST_F(GpuCullingTest, CullsMeshesBehindAWallFromTheThirdFrameOn) {
  gpu_.create(RenderPath::kGpu, true);
  gpu_.add_box({0, 0, -20}, {15, 15, 1}, {0.5F, 0.1F, 0.1F});  // the wall
  gpu_.add_box({0, 0, -60}, {3, 3, 3}, {0.1F, 0.5F, 0.1F});    // behind it
  gpu_.add_box({20, 0, -30}, {2, 2, 2}, {0.1F, 0.1F, 0.5F});   // beside it
  gpu_.add_box({0, 0, 40}, {2, 2, 2}, {0.1F, 0.1F, 0.5F});     // behind the camera
  const FrameInput ahead = look(0.0, 0.0);
  for (int frame = 0; frame < 5; ++frame) {
    gpu_.draw(ahead);
    EXPECT_TRUE(gpu_.draws_box(0));
    EXPECT_EQ(gpu_.draws_box(1), frame < 2) << frame;
    EXPECT_TRUE(gpu_.draws_box(2));
    EXPECT_FALSE(gpu_.draws_box(3));
  }
  // The wall goes: what it hid is there in the very same frame.
  gpu_.models[0].origin = {200, 0, -20};
  gpu_.draw(ahead);
  EXPECT_TRUE(gpu_.draws_box(1));
  const Picture seen = gpu_.picture();
  const std::size_t middle =
      (std::size_t{kOddSize.height / 2} * kOddSize.width + kOddSize.width / 2) * 4;
  EXPECT_GT(seen.rgba[middle + 1], seen.rgba[middle]);
}

TEST_F(GpuCullingTest, KeepsMeshesThatRiseAPixelAboveAWall) {
  gpu_.create(RenderPath::kGpu, true);
  cpu_.create(RenderPath::kCpu, true);
  for (Landscape* side : {&cpu_, &gpu_}) {
    side->add_box({0, -2, -20}, {40, 2, 1}, {0.5F, 0.1F, 0.1F});
    for (int i = 0; i < 200; ++i) {
      const float x = 0.3F * static_cast<float>(i - 100);
      side->add_box({x, -3, -50}, {0.1F, 0.5F + 0.03F * static_cast<float>(i), 0.1F},
                    {0.1F, 0.9F, 0.1F});
    }
  }
  for (int frame = 0; frame < 4; ++frame) {
    cpu_.draw(look(0.0, 0.0));
    gpu_.draw(look(0.0, 0.0));
    expect_same_pictures(gpu_.picture(), cpu_.picture());
  }
  EXPECT_EQ(gpu_.picture().rgba, cpu_.picture().rgba);
  EXPECT_LT(gpu_.drawn().size(), cpu_.drawn().size());
}

// Samples, shadows and the colours of a view, which have ways of their own through the GPU path.
TEST_F(GpuCullingTest, ShowsThePicturesOfTheCpuPathInTheHighPresetAndInViews) {
  cpu_.create(RenderPath::kCpu, true, Preset::kHigh);
  gpu_.create(RenderPath::kGpu, true, Preset::kHigh);
  for (Landscape* side : {&cpu_, &gpu_}) {
    side->add_hills(2);
    side->add_boxes(200);
  }
  for (int i = 0; i < 6; ++i) {
    FrameInput input = look(0.1 * i, -0.05);
    input.view = i < 4 ? View::kNormal : View::kLevels;
    cpu_.draw(input);
    gpu_.draw(input);
    expect_same_pictures(gpu_.picture(), cpu_.picture());
  }
  EXPECT_LT(gpu_.drawn().size(), cpu_.drawn().size()) << "nothing was ever hidden";
}

TEST_F(GpuCullingTest, CountsTheDrawsOfAFinishedFrame) {
  gpu_.create(RenderPath::kGpu, true);
  gpu_.add_hills(1);
  gpu_.add_box({0, 0, -20}, {1, 1, 1}, {0.5F, 0.1F, 0.1F});
  EXPECT_EQ(gpu_.draw(look(0, 0)).draws, 0u) << "nothing has finished yet";
  FrameResult result;
  for (int i = 0; i < 4; ++i)
    result = gpu_.draw(look(0, 0));
  const auto list = gpu_.drawn();
  EXPECT_EQ(result.draws, list.size());
  std::uint64_t triangles = 0;
  for (const DrawnMesh& mesh : list)
    triangles += mesh.index_count / 3;
  EXPECT_EQ(result.triangles, triangles);
  EXPECT_GT(triangles, 2000u);
}

TEST_F(GpuCullingTest, FollowsChangesOfSizeAndReplaysItsFrame) {
  landscape(true);
  for (const core::Extent size :
       {core::Extent{1, 1}, core::Extent{64, 512}, core::Extent{97, 61}}) {
    for (Landscape* side : {&cpu_, &gpu_}) {
      ASSERT_TRUE(side->renderer->resize(size));
      for (int frame = 0; frame < 3; ++frame)
        side->draw(look(0.3, 0));
    }
    expect_same_pictures(gpu_.picture(), cpu_.picture());
  }
  const Picture before = gpu_.picture();
  const auto floor = gpu_.renderer->replay_floor_ms(3);
  ASSERT_TRUE(floor) << floor.error().message;
  EXPECT_GT(*floor, 0.0);
  expect_same_pictures(gpu_.picture(), before);
}

TEST_F(GpuCullingTest, HoldsMoreDrawsThanItsFirstBuffersAndThanOneCallTakes) {
  gpu_.create(RenderPath::kGpu, false);
  gpu_.add_box({0, 0, -30}, glm::vec3(0.01F), {0.5F, 0.5F, 0.5F});
  gpu_.models.resize(CandidateList::kGroupCapacity + 100, gpu_.models.front());
  gpu_.draw(look(0, 0));
  EXPECT_EQ(gpu_.drawn().size(), CandidateList::kGroupCapacity + 100u);
}

TEST(RenderPathOption, HasNamesAndSaysWhichAreAllowed) {
  for (const RenderPath path : {RenderPath::kAuto, RenderPath::kCpu, RenderPath::kGpu})
    EXPECT_EQ(render_path_from(to_string(path)).value(), path);
  const auto unknown = render_path_from("npu");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message, "render path 'npu' is unknown; allowed are auto, cpu, gpu");
}

TEST(RenderPathOption, TakesTheCpuPathOnSoftwareDevicesUnlessTold) {
  RendererOptions options;
  options.size = {16, 16};
  options.geometry_budget_bytes = 1 << 20;
  const auto renderer = Renderer::create(options);
  ASSERT_TRUE(renderer) << renderer.error().message;
  const DeviceInfo& device = (*renderer)->device();
  EXPECT_EQ((*renderer)->path(),
            device.software() || !device.gpu_path ? RenderPath::kCpu : RenderPath::kGpu);
}

}  // namespace
}  // namespace psygen::render
