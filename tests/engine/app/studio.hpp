// A headless application for image tests: settled images from any pose, and detection of sky that
// is visible through the ground. Worlds are texts, so that tests can vary them.
#pragma once

#include <fstream>
#include <glm/matrix.hpp>

#include "engine/image/image.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/state.hpp"
#include "tests/engine/app/fixture.hpp"
#include "tests/source_file.hpp"

namespace psygen::app {

// The paper's world with this number of blocks along each side, 0: endless.
inline std::string paper_text(int blocks_x, int blocks_z, const std::string& terrain = {}) {
  const auto number = [](int n) { return std::to_string(n); };
  return "format = 1\n[world]\nname = \"studio\"\nseed = 2009\nblocks = [" + number(blocks_x) +
         ", " + number(blocks_z) + "]\n[terrain]\noctaves = 9\n" + terrain +
         "[[scatter]]\nmodel = \"tree\"\ncount = 23\niterations = [3, 5]\nbranches = [2, 4]\n" +
         "[[scatter]]\nmodel = \"rock\"\ncount = 40\nsubdivisions = 2\n";
}

class Studio {
 public:
  // `world` is a file of game/worlds, or the text of a world.
  Studio(const std::string& world, SessionOptions options) {
    options.world_file = std::filesystem::path(source_file("game/worlds")) / world;
    const TemporaryFolder folder;
    if (world.find('\n') != std::string::npos) {
      options.world_file = folder / "world.toml";
      std::ofstream(options.world_file) << world;
    }
    auto session = Session::create(options);
    EXPECT_TRUE(session) << session.error().message;
    session_ = std::move(*session);
  }

  scene::Scene& scene() { return session_->scene(); }
  scene::State& state() { return scene::state_of(session_->scene()); }
  const scene::State& state() const { return scene::state_of(session_->scene()); }
  std::uint32_t width() { return session_->renderer().size().width; }
  std::uint32_t height() { return session_->renderer().size().height; }

  // A pose at this height above the ground at a position of a block.
  core::CameraPose above(core::BlockCoord block, double x, double z, double height_m, double yaw,
                         double pitch) {
    core::CameraPose pose;
    const double ground_m = models::ground_height_m(state().facts.world.terrain, block, x, z);
    pose.position = {block, {x, ground_m + height_m, z}};
    pose.yaw = yaw;
    pose.pitch = pitch;
    return pose;
  }

  // Makes all meshes ready, as if the camera had always been here.
  void settle(const core::CameraPose& pose) {
    scene().settle(pose);
    draw(pose);
  }
  // Draws the next frame of a flight after all its requested meshes are ready.
  void fly(const core::CameraPose& pose) {
    for (int i = 0; i < 40; ++i) {
      draw(pose);
      state().supply.wait();
      if (scene().statistics().meshes.requests == 0 && !state().supply.has_arrived()) break;
    }
    draw(pose);
  }
  void draw(const core::CameraPose& pose) {
    const auto drawn = session_->tick(pose, 1.0 / 60.0);
    ASSERT_TRUE(drawn) << drawn.error().message;
    frame_took(0, 0);
  }
  // Sets the frame time that the governor sees in the next frame instead of the real one.
  void frame_took(double ms, double triangles) {
    state().input.frame_ms = ms;
    state().input.frame_triangles = triangles;
  }
  // The image of the last frame, with clouds and wind standing still.
  image::Image picture();

  // The image of an earlier frame's lists, from the current camera.
  struct Lists {
    core::WorldPosition eye;
    std::vector<render::TerrainDraw> terrain;
    std::vector<render::MeshDraw> models;
  };
  Lists lists();
  image::Image picture_of(Lists terrain_of, const Lists& models_of);

  // For each pixel, row by row: nonzero if the ground of the last frame (without models) leaves the
  // sky visible. Another colour of the sky changes only sky pixels.
  std::vector<std::uint8_t> sky() {
    const image::Image dark = ground_under(0.0F), bright = ground_under(1e6F);
    std::vector<std::uint8_t> sky(std::size_t{dark.width} * dark.height);
    for (std::size_t i = 0; i < sky.size(); ++i)
      sky[i] = std::abs(dark.rgba[4 * i] - bright.rgba[4 * i]) > 8 ? 1 : 0;
    return sky;
  }

  // Metres; the direction has length 1.
  glm::dvec3 direction_of(double column, double row) {
    const scene::Camera& camera = state().camera;
    const double up = std::tan(camera.projection.vertical_fov / 2);
    const glm::dvec3 ray((2 * (column + 0.5) / width() - 1) * up * camera.projection.aspect,
                         -(2 * (row + 0.5) / height() - 1) * up, -1.0);
    return glm::normalize(glm::transpose(glm::dmat3(core::view_rotation(camera.pose))) * ray);
  }

  // Number of pixels that show the sky although the true ground blocks the view by more than the
  // allowed error of the LODs.
  std::size_t holes();

 private:
  image::Image drawn_again(const render::Light& light, std::span<const render::TerrainDraw> terrain,
                           std::span<const render::MeshDraw> models);
  image::Image ground_under(float haze_colour);
  bool is_hole(const glm::dvec3& direction);

  std::unique_ptr<Session> session_;
};

}  // namespace psygen::app
