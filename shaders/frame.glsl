// The data of the frame, in set 0 of every pipeline.
#ifndef PSYGEN_FRAME_GLSL
#define PSYGEN_FRAME_GLSL
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(set = 0, binding = PSYGEN_BINDING_FRAME, std140) uniform Frame { FrameData frame; };
#endif
