#include "engine/scene/meshes/fading.hpp"

#include <algorithm>

namespace psygen::scene {

bool replace_mesh(Fading& fading, const Mesh& before, std::uint8_t level, bool pictured) {
  const bool coming = fading.share < 1.0F;
  const bool mostly_old = fading.old_mesh && fading.share < 0.5F;
  if (coming && (!fading.old_mesh || mostly_old)) return false;
  fading.share = 0;
  fading.old_range = before.range;
  fading.old_mesh = before.handle;
  fading.old_shared_indices = before.shared_indices;
  fading.old_level = level;
  fading.old_pictured = pictured;
  return true;
}

float next_phase(float phase, FadeStep step) {
  const float moved = phase + 0.5F * step.share;
  return moved < 1.0F ? moved : moved - 1.0F;
}

float advance_fade_in(Fading& fading, FadeStep step, bool fades_in) {
  if (fading.tick + 1 != step.tick) {
    fading.share = fades_in ? 0.0F : 1.0F;
    fading.old_mesh = {};
  }
  fading.tick = step.tick;
  fading.share = std::min(fading.share + step.share, 1.0F);
  if (fading.share >= 1.0F) fading.old_mesh = {};
  return fading.share;
}

float advance_fade_out(Fading& fading, FadeStep step) {
  if (fading.tick + 1 != step.tick) return 0;
  if (fading.old_mesh) fading.share = 1.0F;  // both meshes together draw all pixels
  fading.old_mesh = {};
  fading.share = std::max(fading.share - step.share, 0.0F);
  if (fading.share > 0) fading.tick = step.tick;
  return fading.share;
}

}  // namespace psygen::scene
