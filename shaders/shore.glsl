// Where water meets the ground: what waves keep wet, and the film of foam that runs up with them.
// Needs frame.glsl; foam.glsl draws foam per pixel.
// Wet ground lies up to so many metres above the surface.
const float kWetM = 0.25;

// Factor of the albedo of ground so many metres under the surface, or above it if negative.
float wet_at(float depth) { return mix(0.62, 1.0, smoothstep(0.0, kWetM, -depth)); }

// Metres along the ground from there to the edge of the water. `up`: y of the ground's normal.
float way_to_shore(float depth, float up) {
  float slope = sqrt(max(1.0 - up * up, 0.0)) / max(up, 0.1);
  return depth / max(slope, 0.04);
}

// Distance of the edge into the water; it moves to and fro. `phase`: varies from place to
// place; 1 is four turns.
float swash_at(float phase) { return 0.5 * sin(0.9 * frame.sun_direction.w + 25.0 * phase) - 0.3; }

// Share of the film's foam so many metres from the moved edge; `fine`: noise.
float film_at(float away, float fine) {
  return (1.0 - smoothstep(0.1, 1.1, abs(away - 0.3))) * smoothstep(0.40, 0.66, fine);
}
