// The pipelines of meshes, as tables: a lookup is one load. A vertex layout (layouts.hpp) creates
// its pipelines and decides in which entries they stand. Main thread. Private to engine/render.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/core/vertex_layout.hpp"
#include "engine/render/frame/pass_set.hpp"

namespace psygen::render {

// The pixels that a draw covers.
enum class Coverage : std::uint8_t {
  kWhole,
  kPart,      // models that fade in or out, objects with holes; of terrain, near ground
  kPictured,  // models with pictures, whether they fade or not
  kNear,      // near models, whether they fade or not
};

// The properties of draws that may need different pipelines.
struct MeshVariant {
  static constexpr std::size_t kCount = 32;

  Coverage coverage = Coverage::kWhole;
  bool pushed = false;    // the data of a draw is in push constants, else in the buffer of draws
  bool textured = false;  // the textures of a material are bound
  bool lamps = false;     // point lights may reach it

  constexpr std::size_t index() const {
    return static_cast<std::size_t>(coverage) | (pushed ? 4U : 0U) | (textured ? 8U : 0U) |
           (lamps ? 16U : 0U);
  }
  static constexpr MeshVariant at(std::size_t index) {
    return {.coverage = static_cast<Coverage>(index & 3U),
            .pushed = (index & 4U) != 0,
            .textured = (index & 8U) != 0,
            .lamps = (index & 16U) != 0};
  }
};

// A debug colour, 0xRRGGBB, as DrawData has it.
constexpr float packed_colour(std::uint32_t rgb) {
  return static_cast<float>(rgb & 0xFFFFFF);
}

// The pictures that meshes are drawn for.
enum class MeshUse : std::uint8_t { kLandscape, kDrawColour, kWireframe, kShadow };
// The use in a frame's view.
constexpr MeshUse use_in(View view) {
  return view == View::kWireframe ? MeshUse::kWireframe
         : colours_draws(view)    ? MeshUse::kDrawColour
                                  : MeshUse::kLandscape;
}

// The tables and the pipelines in them. Empty until create().
class MeshTables {
 public:
  // Creates what setup.features lacks. After a failure everything is as it was.
  core::Result<void> create(const PassSetup& setup);
  VkPipeline find(core::VertexLayout layout, MeshUse use, MeshVariant variant) const {
    return tables_[static_cast<std::size_t>(layout)][static_cast<std::size_t>(use)]
                  [variant.index()];
  }

  // For vertex layouts. Creates the pipelines of a shape, with the data of draws in their buffer
  // (shape.vert), if the device numbers draws, and pushed (the next shader), and puts each into its
  // entries for which fits(variant).
  template <class Fits>
  core::Result<void> add(const PassSetup& setup, const PipelineShape& shape, MeshUse use,
                         const Fits& fits) {
    MeshTable& table = table_of(*shape.vertices, use);
    for (const bool pushed : {false, true}) {
      if (!pushed && !setup.device.info.numbers_draws()) continue;
      if (core::Result<void> made = make(setup, shape, pushed); !made) return made;
      for (std::size_t i = 0; i < MeshVariant::kCount; ++i) {
        const MeshVariant variant = MeshVariant::at(i);
        if (variant.pushed == pushed && fits(variant)) table[i] = pipelines_.back().get();
      }
    }
    return {};
  }

 private:
  using MeshTable = std::array<VkPipeline, MeshVariant::kCount>;
  MeshTable& table_of(core::VertexLayout layout, MeshUse use) {
    return tables_[static_cast<std::size_t>(layout)][static_cast<std::size_t>(use)];
  }
  core::Result<void> make(const PassSetup& setup, PipelineShape shape, bool pushed);
  core::Result<void> create_missing(const PassSetup& setup, Features wanted);

  std::array<std::array<MeshTable, 4>, 3> tables_{};  // by layout and use
  std::vector<UniquePipeline> pipelines_;
  Features made_;
};

}  // namespace psygen::render
