// The sun's shadow maps.
layout(set = 0, binding = PSYGEN_BINDING_SHADOWS) uniform sampler2DArrayShadow shadow_maps;

// Each cascade gives way to the next over this last part of its reach, and the last one to no shadow
// over a larger part, so that no edge shows where cascades end.
const float kCascadeBlend = 0.12, kLastFade = 0.45;

// Visible share of the sun in a cascade, from nine texels around `p`. Those outside have less weight,
// so edges are soft and have no steps.
float sun_in_cascade(int cascade, vec3 p, vec3 n) {
  float texel_m = 2.0 * frame.shadow_reach[cascade] * frame.shadow.x;
  vec3 off = (n + frame.sun_direction.xyz) * (1.5 * texel_m);  // prevents self-shadowing
  vec3 q = (frame.shadow_from_camera[cascade] * vec4(p + off, 1.0)).xyz;
  vec2 uv = q.xy * 0.5 + 0.5;
  float lit = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      float weight = float((2 - abs(x)) * (2 - abs(y)));
      lit += weight * texture(shadow_maps, vec4(uv + vec2(x, y) * frame.shadow.x, float(cascade), q.z));
    }
  }
  return lit * (1.0 / 16.0);
}

// Visible share of the sun in the shadow maps, at `p` with normal `n`.
float sun_at(vec3 p, vec3 n) {
  float away = length(p);
  int last = int(frame.shadow.y) - 1;
  if (last < 0) return 1.0;
  float end = frame.shadow_reach[last];
  if (away > end) return 1.0;
  int cascade = away < frame.shadow_reach.x ? 0 : away < frame.shadow_reach.y ? 1 : 2;
  float lit = sun_in_cascade(cascade, p, n);
  if (cascade == last) return mix(lit, 1.0, smoothstep((1.0 - kLastFade) * end, end, away));
  float reach = frame.shadow_reach[cascade];
  float next = (away - (1.0 - kCascadeBlend) * reach) / (kCascadeBlend * reach);
  return next > 0.0 ? mix(lit, sun_in_cascade(cascade + 1, p, n), next) : lit;
}
