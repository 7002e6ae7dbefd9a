// Particles. Vertices: each is a square that faces the camera, or a streak along its motion. All of
// it follows from the emitter, the number of the particle and the time; nothing is kept between
// frames. A particle is born again when its life is over, as the next generation.
// Pixels: a disc with a soft edge, or with PSYGEN_TEXTURED the base texture of the material. The
// colour is multiplied by the opacity, so particles that cover nothing add their light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "stage.glsl"

layout(location = 0) PASSED vec4 colour;
layout(location = 1) PASSED vec2 place;                // −1 … 1 in the particle
layout(location = 2) flat PASSED vec2 covers_softness;  // x: share of what is behind that it covers

#ifdef PSYGEN_VERT
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"

layout(set = 2, binding = PSYGEN_PARTICLE_EMITTER, std140) uniform Emitter { EmitterData e; };

// Three random numbers in [0, 1) of three numbers (Jarzynski and Olano 2020, pcg3d).
vec3 random(uint a, uint b, uint c) {
  uvec3 v = uvec3(a, b, c) * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return vec3(v >> 8) * (1.0 / 16777216.0);
}

// A smooth wave of period 1 in [-1, 1].
vec3 wave(vec3 t) {
  vec3 f = abs(fract(t) * 2.0 - 1.0);
  return (f * f * (3.0 - 2.0 * f)) * 2.0 - 1.0;
}

void main() {
  uint number = uint(gl_VertexIndex) / PSYGEN_PARTICLE_VERTICES;
  uint vertex = uint(gl_VertexIndex) - number * PSYGEN_PARTICLE_VERTICES;
  vec2 corner = vec2(vertex == 1u || vertex == 2u || vertex == 4u ? 1.0 : -1.0,
                     vertex == 2u || vertex == 4u || vertex == 5u ? 1.0 : -1.0);
  float turns = e.origin.w + float(number) / e.axis_x.w;
  uint generation = uint(turns >= 1.0 ? e.names.y : e.names.x);
  vec3 r0 = random(number, generation, 0u), r1 = random(number, generation, 1u);
  vec3 r2 = random(number, generation, 2u), r3 = random(number, generation, 3u);

  float age = fract(turns) * e.cycle.x;
  float life = e.axis_y.w * (1.0 - e.axis_z.w * r0.x);
  float lived = age / life;

  // Motion under gravity and a drag towards the wind.
  float drag = e.motion.x;
  float kept = exp2(-1.442695 * drag * age);
  float reach = (1.0 - kept) / drag;
  vec3 pull = e.wind.xyz * drag - vec3(0.0, e.wind.w, 0.0);
  vec3 start = e.velocity.xyz + e.velocity.w * (2.0 * r1 - 1.0);
  vec3 moved = start * reach + pull * ((age - reach) / drag);
  vec3 velocity = start * kept + pull * reach;
  moved += e.motion.y * min(2.0 * lived, 1.0) * wave(r3 + age * (0.12 + 0.25 * r3.yzx));
  vec3 from = 2.0 * r2 - 1.0;
  vec3 p = moved + from.x * e.axis_x.xyz + from.y * e.axis_y.xyz + from.z * e.axis_z.xyz;
  float opacity = e.light.y * clamp(lived / e.shape.x, 0.0, 1.0) *
                  clamp((1.0 - lived) / e.shape.y, 0.0, 1.0);
  // In a lattice of boxes the origin is the corner of one; the camera is in its middle.
  bvec3 in_box = bvec3(e.around.x > 0.0);
  vec3 place_in_box = fract((p + e.origin.xyz) / mix(vec3(1.0), e.around.xyz, in_box)) - 0.5;
  vec3 edge = clamp((0.5 - abs(place_in_box)) * 8.0, 0.0, 1.0);
  opacity *= mix(1.0, edge.x * edge.y * edge.z, in_box.x);
  p = mix(p + e.origin.xyz, place_in_box * e.around.xyz, in_box);
  float away2 = max(dot(p, p), 1e-6);

  float size = mix(e.size.x, e.size.y, lived) * (1.0 - e.size.z * r0.y) * 0.5;
  // None fills the picture when the camera passes through it.
  opacity *= clamp(sqrt(away2) / (size + 0.3) - 0.5, 0.0, 1.0);
  vec3 ahead = p * inversesqrt(away2);
  // A streak lies along its motion, all others turn about the line to the camera.
  bool streak = e.size.w > 0.0;
  float speed2 = max(dot(velocity, velocity), 1e-6);
  vec3 along = mix(vec3(0.0, 1.0, 0.0), velocity * inversesqrt(speed2), bvec3(streak));
  vec3 across = cross(ahead, along);
  across *= inversesqrt(max(dot(across, across), 1e-6));
  vec3 above = cross(across, ahead);
  float turned_by = r0.z + age * e.motion.z * (r3.x - 0.5) * 0.3183099;
  vec2 turn = normalize(wave(turned_by + vec3(0.0, 0.25, 0.0)).xy);  // cosine, sine
  vec3 right = mix(turn.x * across + turn.y * above, across, bvec3(streak));
  vec3 up = mix(turn.x * above - turn.y * across, along, bvec3(streak));
  float half_height = size + mix(0.0, 0.5 * e.size.w * sqrt(speed2), streak);
  float tumbled = 0.15 + 0.85 * abs(wave(vec3(r1.x + age * e.motion.w * 0.159)).x);
  float half_width = size * e.shape.w * mix(1.0, tumbled, e.motion.w > 0.0);

  vec4 paint = mix(e.first_colour, e.last_colour, clamp(lived, 0.0, 1.0));
  paint.rgb *= 1.0 - e.around.w * r2.x;
  // Seen from any side, half of the sun falls on it.
  vec3 light = paint.rgb * (ambient_light(vec3(0.0)) + 0.5 * e.light.x * frame.sun_colour.rgb +
                            (lamps ? 0.5 * lamp_light(p, vec3(0.0), 1.0) : vec3(0.0)));
  light = mix(light, paint.rgb * frame.sun_colour.w, e.light.z);
  vec3 air = through_haze(vec3(0.0), p);
  light = through_haze(light, p) - air * (1.0 - e.light.w);
  opacity *= paint.a;
  colour = vec4(shown(max(light, 0.0)), opacity);
  place = corner;
  covers_softness = vec2(e.light.w, max(e.shape.z, 0.05));
  bool there = age < life && age >= e.names.z && age <= e.names.w && opacity > 0.002;
  p += corner.x * half_width * right + corner.y * half_height * up;
  gl_Position = there ? frame.clip_from_camera * vec4(p, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
#else
#include "materials.glsl"

layout(location = 0) out vec4 pixel;

void main() {
#ifdef PSYGEN_TEXTURED
  vec4 texel = texture(base_map, vec2(0.5, -0.5) * place + 0.5);
  vec3 shade = colour.rgb * texel.rgb;
  float opacity = colour.a * texel.a;
#else
  vec3 shade = colour.rgb;
  float inside = clamp((1.0 - dot(place, place)) / covers_softness.y, 0.0, 1.0);
  float opacity = colour.a * inside * inside;
#endif
  pixel = vec4(shade * opacity, opacity * covers_softness.x);
}
#endif
