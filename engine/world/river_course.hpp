// The courses of rivers: their curves, values along them, and the order in which rivers that end in
// each other are made. The same bits on every machine. Pure functions. Internal to world.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/world/curve.hpp"
#include "engine/world/water_bodies.hpp"

namespace psygen::world {

struct World;

// The curve of a river, with points 3 to 10 m apart by its narrowest width, or farther where cells
// of the ground are large. Requires two points and one width.
std::vector<CurvePoint> river_curve(const World& world, const River& river);

// The value of a list of the river at a point of its curve: one number for the whole river, or one
// for each control point, linear between them.
double value_at(const std::vector<double>& list, const CurvePoint& at);

// The order in which rivers must be made, so that every river is there when another one begins or
// ends in it; else that of the list. Empty if rivers end in each other.
struct RiverOrder {
  std::vector<std::size_t> order;
  std::vector<bool> flows_on;  // by river: it ends in another one
};
RiverOrder river_order(const World& world, const std::vector<River>& rivers);

}  // namespace psygen::world
