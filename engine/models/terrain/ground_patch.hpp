// The patches of a river network (network/network.hpp) as requests, so that modelers make them
// before a main thread needs them. Any thread.
#pragma once

#include <memory>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/models/network/root.hpp"

namespace psygen::models {

// The patches that the ground of a node reads: its meshes, their light, its water, the places of
// models on it, and heights up to `beyond_cells` cells of node level 0 beyond its border, at most
// 512: more would be too many patches. Each once; empty without a network. About 1 µs.
std::vector<network::TileKey> ground_patches(const Parameters& terrain,
                                             std::int64_t beyond_cells = 0);

// The model type "ground_patch": a request for it leaves the patch in the network's store. Its mesh
// has nothing to draw. Without a network it does nothing.
std::unique_ptr<ModelType> make_ground_patch_type();
// Its parameters, for the network of a layer, which must outlive them.
Parameters ground_patch_parameters(const EditLayer* layer, const network::TileKey& tile);

}  // namespace psygen::models
