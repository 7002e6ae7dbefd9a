#include "engine/render/shader_code.hpp"

namespace psygen::render {

namespace {

constexpr std::uint32_t kTerrainVert[] =
#include "terrain_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainPushedVert[] =
#include "terrain_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainLitVert[] =
#include "terrain_lit_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainLitPushedVert[] =
#include "terrain_lit_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainColouredVert[] =
#include "terrain_coloured_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainColouredPushedVert[] =
#include "terrain_coloured_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainShadowVert[] =
#include "terrain_shadow_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainShadowPushedVert[] =
#include "terrain_shadow_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelVert[] =
#include "model_vert_spv.h"
    ;
constexpr std::uint32_t kModelPushedVert[] =
#include "model_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelLitVert[] =
#include "model_lit_vert_spv.h"
    ;
constexpr std::uint32_t kModelLitPushedVert[] =
#include "model_lit_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelColouredVert[] =
#include "model_coloured_vert_spv.h"
    ;
constexpr std::uint32_t kModelColouredPushedVert[] =
#include "model_coloured_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelShadowVert[] =
#include "model_shadow_vert_spv.h"
    ;
constexpr std::uint32_t kModelShadowPushedVert[] =
#include "model_shadow_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingVert[] =
#include "model_fading_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingPushedVert[] =
#include "model_fading_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingLitVert[] =
#include "model_fading_lit_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingLitPushedVert[] =
#include "model_fading_lit_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingColouredVert[] =
#include "model_fading_coloured_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingColouredPushedVert[] =
#include "model_fading_coloured_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingShadowVert[] =
#include "model_fading_shadow_vert_spv.h"
    ;
constexpr std::uint32_t kModelFadingShadowPushedVert[] =
#include "model_fading_shadow_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelPictureVert[] =
#include "model_picture_vert_spv.h"
    ;
constexpr std::uint32_t kModelPicturePushedVert[] =
#include "model_picture_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelPictureLitVert[] =
#include "model_picture_lit_vert_spv.h"
    ;
constexpr std::uint32_t kModelPictureLitPushedVert[] =
#include "model_picture_lit_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelPictureColouredVert[] =
#include "model_picture_coloured_vert_spv.h"
    ;
constexpr std::uint32_t kModelPictureColouredPushedVert[] =
#include "model_picture_coloured_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelPictureShadowVert[] =
#include "model_picture_shadow_vert_spv.h"
    ;
constexpr std::uint32_t kModelPictureShadowPushedVert[] =
#include "model_picture_shadow_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kSurfacePictureFrag[] =
#include "surface_picture_frag_spv.h"
    ;
constexpr std::uint32_t kSurfaceLitPictureFrag[] =
#include "surface_lit_picture_frag_spv.h"
    ;
constexpr std::uint32_t kSurfaceColouredPictureFrag[] =
#include "surface_coloured_picture_frag_spv.h"
    ;
constexpr std::uint32_t kShadowPictureFrag[] =
#include "shadow_picture_frag_spv.h"
    ;
constexpr std::uint32_t kShadowFadingFrag[] =
#include "shadow_fading_frag_spv.h"
    ;
constexpr std::uint32_t kSurfaceFrag[] =
#include "surface_frag_spv.h"
    ;
constexpr std::uint32_t kSurfaceLitFrag[] =
#include "surface_lit_frag_spv.h"
    ;
constexpr std::uint32_t kSurfaceFadingFrag[] =
#include "surface_fading_frag_spv.h"
    ;
constexpr std::uint32_t kSurfaceLitFadingFrag[] =
#include "surface_lit_fading_frag_spv.h"
    ;
constexpr std::uint32_t kModelDetailVert[] =
#include "model_detail_vert_spv.h"
    ;
constexpr std::uint32_t kModelDetailPushedVert[] =
#include "model_detail_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kModelDetailFrag[] =
#include "model_detail_frag_spv.h"
    ;
constexpr std::uint32_t kTerrainDetailVert[] =
#include "terrain_detail_vert_spv.h"
    ;
constexpr std::uint32_t kTerrainDetailPushedVert[] =
#include "terrain_detail_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kGroundDetailFrag[] =
#include "ground_detail_frag_spv.h"
    ;
constexpr std::uint32_t kGroundLitFrag[] =
#include "ground_lit_frag_spv.h"
    ;
constexpr std::uint32_t kGroundLitNearFrag[] =
#include "ground_lit_near_frag_spv.h"
    ;
constexpr std::uint32_t kWaterVert[] =
#include "water_vert_spv.h"
    ;
constexpr std::uint32_t kWaterLitVert[] =
#include "water_lit_vert_spv.h"
    ;
constexpr std::uint32_t kWaterColourFrag[] =
#include "water_colour_frag_spv.h"
    ;
constexpr std::uint32_t kWaterFrag[] =
#include "water_frag_spv.h"
    ;
constexpr std::uint32_t kWaterMirrorFrag[] =
#include "water_mirror_frag_spv.h"
    ;
constexpr std::uint32_t kLineVert[] =
#include "line_vert_spv.h"
    ;
constexpr std::uint32_t kSkyVert[] =
#include "sky_vert_spv.h"
    ;
constexpr std::uint32_t kSkyFrag[] =
#include "sky_frag_spv.h"
    ;
constexpr std::uint32_t kSkyDomeVert[] =
#include "sky_dome_vert_spv.h"
    ;
constexpr std::uint32_t kSkyDomeFrag[] =
#include "sky_dome_frag_spv.h"
    ;
constexpr std::uint32_t kSkyBelowVert[] =
#include "sky_below_vert_spv.h"
    ;
constexpr std::uint32_t kSunVert[] =
#include "sun_vert_spv.h"
    ;
constexpr std::uint32_t kScaleUpVert[] =
#include "scale_up_vert_spv.h"
    ;
constexpr std::uint32_t kScaleUpFrag[] =
#include "scale_up_frag_spv.h"
    ;
constexpr std::uint32_t kOverlayVert[] =
#include "overlay_vert_spv.h"
    ;
constexpr std::uint32_t kOverlayFrag[] =
#include "overlay_frag_spv.h"
    ;

constexpr std::uint32_t kObjectVert[] =
#include "object_vert_spv.h"
    ;
constexpr std::uint32_t kObjectPushedVert[] =
#include "object_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kObjectLitVert[] =
#include "object_lit_vert_spv.h"
    ;
constexpr std::uint32_t kObjectLitPushedVert[] =
#include "object_lit_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kObjectColouredVert[] =
#include "object_coloured_vert_spv.h"
    ;
constexpr std::uint32_t kObjectColouredPushedVert[] =
#include "object_coloured_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kObjectShadowVert[] =
#include "object_shadow_vert_spv.h"
    ;
constexpr std::uint32_t kObjectShadowPushedVert[] =
#include "object_shadow_pushed_vert_spv.h"
    ;
constexpr std::uint32_t kObjectFrag[] =
#include "object_frag_spv.h"
    ;
constexpr std::uint32_t kObjectFadingFrag[] =
#include "object_fading_frag_spv.h"
    ;
constexpr std::uint32_t kObjectTexturedFrag[] =
#include "object_textured_frag_spv.h"
    ;
constexpr std::uint32_t kObjectTexturedFadingFrag[] =
#include "object_textured_fading_frag_spv.h"
    ;
constexpr std::uint32_t kObjectShadowFrag[] =
#include "object_shadow_frag_spv.h"
    ;
constexpr std::uint32_t kParticleVert[] =
#include "particle_vert_spv.h"
    ;
constexpr std::uint32_t kParticleFrag[] =
#include "particle_frag_spv.h"
    ;
constexpr std::uint32_t kParticleTexturedFrag[] =
#include "particle_textured_frag_spv.h"
    ;

// Indexed by layout, look and whether the data is pushed.
constexpr ShaderCode kMeshes[2][4][2] = {
    {{kTerrainVert, kTerrainPushedVert},
     {kTerrainLitVert, kTerrainLitPushedVert},
     {kTerrainColouredVert, kTerrainColouredPushedVert},
     {kTerrainShadowVert, kTerrainShadowPushedVert}},
    {{kModelVert, kModelPushedVert},
     {kModelLitVert, kModelLitPushedVert},
     {kModelColouredVert, kModelColouredPushedVert},
     {kModelShadowVert, kModelShadowPushedVert}},
};

// Fading models, indexed by look and whether the data is pushed.
constexpr ShaderCode kFadingModels[4][2] = {
    {kModelFadingVert, kModelFadingPushedVert},
    {kModelFadingLitVert, kModelFadingLitPushedVert},
    {kModelFadingColouredVert, kModelFadingColouredPushedVert},
    {kModelFadingShadowVert, kModelFadingShadowPushedVert},
};

// Models with pictures, indexed by look and whether the data is pushed.
constexpr ShaderCode kPicturedModels[4][2] = {
    {kModelPictureVert, kModelPicturePushedVert},
    {kModelPictureLitVert, kModelPictureLitPushedVert},
    {kModelPictureColouredVert, kModelPictureColouredPushedVert},
    {kModelPictureShadowVert, kModelPictureShadowPushedVert},
};

// Objects, indexed by look and whether the data is pushed.
constexpr ShaderCode kObjects[4][2] = {
    {kObjectVert, kObjectPushedVert},
    {kObjectLitVert, kObjectLitPushedVert},
    {kObjectColouredVert, kObjectColouredPushedVert},
    {kObjectShadowVert, kObjectShadowPushedVert},
};

constexpr OtherCode kOthers{kSurfaceFrag,
                            kSurfaceLitFrag,
                            kSurfaceFadingFrag,
                            kSurfaceLitFadingFrag,
                            kShadowFadingFrag,
                            kWaterVert,
                            kWaterLitVert,
                            kWaterColourFrag,
                            kWaterFrag,
                            kWaterMirrorFrag,
                            kLineVert,
                            kSkyVert,
                            kSkyFrag,
                            kSkyDomeVert,
                            kSkyDomeFrag,
                            kSkyBelowVert,
                            kSunVert,
                            kScaleUpVert,
                            kScaleUpFrag,
                            kOverlayVert,
                            kOverlayFrag,
                            kObjectFrag,
                            kObjectFadingFrag,
                            kObjectTexturedFrag,
                            kObjectTexturedFadingFrag,
                            kObjectShadowFrag,
                            kParticleVert,
                            kParticleFrag,
                            kParticleTexturedFrag,
                            kModelDetailVert,
                            kModelDetailPushedVert,
                            kModelDetailFrag,
                            kTerrainDetailVert,
                            kTerrainDetailPushedVert,
                            kGroundDetailFrag,
                            kGroundLitFrag,
                            kGroundLitNearFrag,
                            kSurfacePictureFrag,
                            kSurfaceLitPictureFrag,
                            kSurfaceColouredPictureFrag,
                            kShadowPictureFrag};

}  // namespace

ShaderCode mesh_vertex_code(core::VertexLayout layout, MeshLook look, bool pushed) {
  const std::size_t mesh = layout == core::VertexLayout::kTerrain ? 0 : 1;
  return kMeshes[mesh][static_cast<std::size_t>(look)][pushed ? 1 : 0];
}

ShaderCode fading_vertex_code(MeshLook look, bool pushed) {
  return kFadingModels[static_cast<std::size_t>(look)][pushed ? 1 : 0];
}

ShaderCode picture_vertex_code(MeshLook look, bool pushed) {
  return kPicturedModels[static_cast<std::size_t>(look)][pushed ? 1 : 0];
}

ShaderCode object_vertex_code(MeshLook look, bool pushed) {
  return kObjects[static_cast<std::size_t>(look)][pushed ? 1 : 0];
}

const OtherCode& other_code() {
  return kOthers;
}

}  // namespace psygen::render
