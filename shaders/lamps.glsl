// The point lights of the frame. They are compiled in only where a draw may be near one (a
// specialisation constant), because software devices run both sides of a branch.
layout(constant_id = 2) const bool lamps = false;

// Nearer than this a light does not get brighter: half a metre across, like a lantern.
const float kLampRadius2 = 0.0625;

// Light of lamp `i` on a surface at `p` that faces it. `to_lamp` becomes the unit direction to it.
// Inverse square, with a smooth end at the lamp's range (Karis 2013, "Real Shading in Unreal
// Engine 4").
vec3 lamp_at(int i, vec3 p, out vec3 to_lamp) {
  vec4 place = frame.lamps[2 * i];
  to_lamp = place.xyz - p;
  float distance2 = dot(to_lamp, to_lamp);
  to_lamp *= inversesqrt(max(distance2, 1e-8));
  float of_range = distance2 * place.w;
  float inside = max(1.0 - of_range * of_range, 0.0);
  return frame.lamps[2 * i + 1].rgb * (inside * inside / max(distance2, kLampRadius2));
}

// The number of lamps. lavapipe compiles a shader anew, for a tenth of a second, for each value
// of a uniform that alone decides a loop or a branch. So the number seems to depend on the place.
int lamp_count_at(vec3 p) {
  return int(frame.lamp_count.x) - int(p.x > 1e30);
}

// Light of all lamps on a surface at `p` with normal `n`. `wrap`: 0 for solids, towards 1 for what
// is lit from all sides.
vec3 lamp_light(vec3 p, vec3 n, float wrap) {
  vec3 sum = vec3(0.0);
  int count = lamp_count_at(p);
  for (int i = 0; i < count; ++i) {
    vec3 to_lamp;
    vec3 light = lamp_at(i, p, to_lamp);
    sum += light * max(mix(dot(n, to_lamp), 1.0, wrap), 0.0);
  }
  return sum;
}
