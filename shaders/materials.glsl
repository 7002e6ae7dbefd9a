// The materials of objects, and with PSYGEN_TEXTURED the textures of the one that is drawn.
layout(set = 0, binding = PSYGEN_BINDING_MATERIALS, std430) readonly buffer Materials {
  MaterialData materials[];
};
#ifdef PSYGEN_TEXTURED
layout(set = 1, binding = PSYGEN_TEXTURE_BASE) uniform sampler2D base_map;
layout(set = 1, binding = PSYGEN_TEXTURE_NORMAL) uniform sampler2D normal_map;
layout(set = 1, binding = PSYGEN_TEXTURE_EMISSIVE) uniform sampler2D emissive_map;
#endif
