// Cross-fades of models: a mesh that replaces another takes over its pixels step by step
// (render::MeshDraw::fade), and so do the models of nodes that replace other nodes. Models that
// come into view from the side or from behind a ridge appear at once. Knows no cache and no
// renderer. Values; main thread only.
#pragma once

#include <cstdint>

#include "engine/scene/components.hpp"
#include "engine/scene/frame/clock.hpp"

namespace psygen::scene {

// The phase of the pattern in which meshes share pixels (render::FrameInput::fade_phase), 0 to 1.
// It advances by half of a fade's step: with a whole step, pixels would change back.
float next_phase(float phase, FadeStep step);

// Starts a cross-fade from `before`, which is resident, to the model's new mesh. `level` and
// `pictured` (an impostor) are those of `before`. A mesh that was itself fading in is replaced by
// the new one. Returns true if `before` is the mesh that fades out.
bool replace_mesh(Fading& fading, const Mesh& before, std::uint8_t level, bool pictured);

// Advances the fade of a model that is drawn in this tick. Returns the fraction of its pixels, in
// (0, 1]. A model that was not drawn in the last tick starts to fade in if `fades_in`, otherwise it
// appears at once.
float advance_fade_in(Fading& fading, FadeStep step, bool fades_in);

// Advances the fade of a model that is no longer drawn. Returns the fraction that is left; 0: none.
float advance_fade_out(Fading& fading, FadeStep step);

}  // namespace psygen::scene
