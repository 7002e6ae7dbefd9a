// The sky behind everything: clear sky, clouds, the sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "clouds.glsl"
#include "dither.glsl"

// Clouds as a layer of some thickness, in presets with fine grain.
layout(constant_id = 1) const bool deep_clouds = false;
// Draws only the sun and its surroundings, blended over the picture (sun.vert).
layout(constant_id = 0) const bool only_sun = false;
layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D clouds;
layout(location = 0) in vec3 ray;
layout(location = 0) out vec4 pixel;

// The sky in the direction `d`; below the horizon the depth of water, if there is any: what water
// shows where no ground lies under it.
vec3 clear_light(vec3 d) {
  vec3 sky = sky_light(d);
  if (frame.water.w > 0.0 || frame.water.w < -1e8 || d.y > -1e-6) return sky;
  vec3 p = d * min(frame.water.w / d.y, PSYGEN_WATER_REACH);
  return through_haze(frame.deep_water.rgb, p);
}

const int kCloudSteps = 6;
const float kThickness = 0.20;  // of the layer of clouds, over the height of its base
const float kRise = 0.36;       // density by which the top of a cloud lies that much higher

// Clouds in the direction `d`, from their base to their top: light, multiplied by the opacity, and
// opacity. The denser the texture, the higher a cloud; so it has sides, which move against each
// other, a side towards the sun, and a dark base. `toward`: cosine to the sun's direction.
vec4 deep_cloud(vec3 d, float toward) {
  float clear = 1.0 - frame.haze_colour.w;
  vec2 place = cloud_place(d);
  vec2 up = place - frame.clouds.xy;
  up *= kThickness / (float(kCloudSteps) * (1.0 + length(up)));  // far clouds are flatter
  vec3 sun = frame.sun_direction.xyz;
  vec2 to_sun = sun.xz * (0.03 * inversesqrt(dot(sun.xz, sun.xz) + 0.06));
  float forward = max(toward, 0.0);
  float f2 = forward * forward, f4 = f2 * f2, f8 = f4 * f4;
  vec3 direct = frame.cloud_colour.rgb * (0.40 + 0.30 * f4 + 0.9 * f8 * f8);
  vec3 around = cloud_ambient();
  vec3 sum = vec3(0.0);
  float kept = 1.0;
  // Fringes, of the texture's finest parts on a smaller scale. Far clouds have none.
  float fringe = 0.10 * (texture(clouds, place * 6.0).g - 0.5) * smoothstep(0.05, 0.3, d.y);
  float start = 0.5 + 0.3 * (ordered_noise() - 0.5);
  for (int i = 0; i < kCloudSteps; ++i) {
    float step_ = float(i) + start;
    float height = step_ * (1.0 / float(kCloudSteps));
    vec2 at = place + up * step_;
    float over = texture(clouds, at).r + fringe - clear - kRise * height * height;
    float density = clamp((over + 0.04) * (1.0 / 0.16), 0.0, 1.0);
    float beyond = texture(clouds, at + to_sun).r - clear - kRise * height * height;
    float shade = exp2(-6.0 * max(0.35 * over + 0.65 * beyond + 0.02, 0.0));
    float share = kept * (1.0 - exp2(-2.2 * density * density));
    sum += share * (direct * shade + around * (0.55 + 0.6 * height));
    kept -= share;
  }
  return vec4(sum, 1.0 - kept);
}

void main() {
  vec3 d = ray * inversesqrt(dot(ray, ray));
  float toward = dot(d, frame.sun_direction.xyz);
  float disc = smoothstep(0.99988, 0.99996, toward);
  vec3 light = clear_light(d) + frame.sun_colour.rgb * 12.0 * disc;
  float presence = cloud_presence(max(d.y, 0.0));
  if (deep_clouds) {
    vec4 cloud = deep_cloud(d, toward);
    light = light * (1.0 - cloud.a * presence) + cloud.rgb * presence;
  } else {
    vec2 here = cloud_at(texture(clouds, cloud_place(d)).rg);
    vec3 cloud = frame.cloud_colour.rgb * (cloud_sun(toward) * here.y) + cloud_ambient();
    light = mix(light, cloud, here.x * presence);
  }
  pixel = vec4(shown(light) + dither(), only_sun ? smoothstep(PSYGEN_SUN_EDGE, 0.9996, toward) : 1.0);
}
