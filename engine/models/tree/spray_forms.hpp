// The shapes of leaf sprays (SprayForm in plan.hpp): vertices, triangles, the three coordinates of
// the corners, indices. Constants; kernels are compiled for these objects. Internal to trees.
#pragma once

#include "engine/models/tree/plan.hpp"

namespace psygen::models {

// Five leaflets on a twig.
inline constexpr SprayForm kLeaflets{
    10,
    8,
    {{0.0F, 0.34F, 0.34F, 0.76F, 0.64F, 1.04F, 0.64F, 0.76F, 0.34F, 0.34F},
     {0.0F, -0.42F, -0.12F, -0.36F, -0.12F, 0.0F, 0.12F, 0.36F, 0.12F, 0.42F},
     {0.0F, 0.14F, 0.0F, 0.18F, 0.02F, 0.22F, 0.02F, 0.18F, 0.0F, 0.14F}},
    {0, 1, 2, 0, 2, 8, 0, 8, 9, 2, 3, 4, 2, 4, 6, 2, 6, 8, 8, 6, 7, 4, 5, 6}};
// A fan of twigs with needles, longest in the middle, with drooping tips.
inline constexpr SprayForm kNeedles{
    10,
    8,
    {{0.0F, 0.42F, 0.26F, 0.78F, 0.52F, 1.1F, 0.52F, 0.78F, 0.26F, 0.42F},
     {0.0F, -0.44F, -0.09F, -0.34F, -0.07F, 0.0F, 0.07F, 0.34F, 0.09F, 0.44F},
     {0.0F, 0.16F, 0.0F, 0.18F, 0.0F, 0.16F, 0.0F, 0.18F, 0.0F, 0.16F}},
    {0, 1, 2, 0, 2, 8, 0, 8, 9, 2, 3, 4, 2, 4, 6, 2, 6, 8, 8, 6, 7, 4, 5, 6}};
// Four pairs of leaflets of a frond, their narrow ends on the rib.
inline constexpr SprayForm kFrond{
    10,
    8,
    {{0.10F, 1.0F, 0.36F, 0.62F, 0.88F, 1.14F, 0.36F, 0.62F, 0.88F, 1.14F},
     {0.0F, 0.0F, -0.95F, -1.0F, -0.95F, -0.85F, 0.95F, 1.0F, 0.95F, 0.85F},
     {0.0F, 0.0F, 0.34F, 0.42F, 0.36F, 0.40F, 0.34F, 0.42F, 0.36F, 0.40F}},
    {0, 2, 1, 0, 3, 1, 0, 4, 1, 0, 5, 1, 0, 1, 6, 0, 1, 7, 0, 1, 8, 0, 1, 9}};
// Rounder leaves that are closer together.
inline constexpr SprayForm kClump{
    10,
    8,
    {{0.0F, 0.20F, 0.30F, 0.62F, 0.60F, 1.0F, 0.60F, 0.62F, 0.30F, 0.20F},
     {0.0F, -0.56F, -0.24F, -0.52F, -0.20F, 0.0F, 0.20F, 0.52F, 0.24F, 0.56F},
     {0.0F, 0.10F, 0.0F, 0.16F, 0.0F, 0.24F, 0.0F, 0.16F, 0.0F, 0.10F}},
    {0, 1, 2, 0, 2, 8, 0, 8, 9, 2, 3, 4, 2, 4, 6, 2, 6, 8, 8, 6, 7, 4, 5, 6}};
// A rounded patch that replaces all of them at levels 2 and 3.
inline constexpr SprayForm kPatch{6,
                                  4,
                                  {{0.0F, 0.22F, 0.74F, 1.0F, 0.66F, 0.30F},
                                   {0.0F, -0.46F, -0.40F, 0.06F, 0.44F, 0.40F},
                                   {0.12F, 0.06F, 0.0F, 0.16F, 0.0F, 0.06F}},
                                  {0, 1, 5, 1, 2, 5, 2, 4, 5, 2, 3, 4}};

}  // namespace psygen::models
