// Compares the mesh of a tree, `tree` or species, with the oracle, vertex by vertex: positions to
// half a step of the packing and 1e-5 of the tree's size, everything else to half a step and 1e-5.
// Normals of sprays are sums of directions. Where these nearly cancel out, single precision leaves
// the direction of the sum uncertain in inverse proportion to its length: one spray in a thousand
// of random grammars has a sum of 0.01, and an error of 3e-5, while the sum itself is exact to
// 4e-7. No sum excuses more than 1e-4.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "engine/models/kit/packing.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/tree.hpp"

namespace psygen::models::test {

// `expected` is the level's mesh, the last one that an oracle with looks made.
inline void expect_as_oracle(const TreeOracle& oracle,
                             const std::vector<TreeOracle::Vertex>& expected,
                             const core::Bounds& bounds, const Mesh& mesh, int level) {
  const auto vertices = mesh.vertices<core::ModelVertex>();
  ASSERT_EQ(vertices.size(), expected.size()) << "level " << level;
  const double size = glm::length(glm::dvec3(bounds.half_extent()));
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const glm::dvec3 place =
        glm::clamp(expected[k].place, glm::dvec3(bounds.min), glm::dvec3(bounds.max));
    if (expected[k].bark) {
      ASSERT_LT(glm::distance(place, expected[k].place), size / 32767)
          << "level " << level << ": bark beyond the bounds";
    }
    const glm::dvec3 found(unpack_position(vertices[k], bounds));
    ASSERT_LT(glm::distance(place, found), size * (1.0 / 65534 + 1e-5))
        << "level " << level << " vertex " << k;
    Look look = oracle.looks().at(expected[k].look);
    look.normal = expected[k].normal;
    const double uncertainty = std::clamp(1e-6 / glm::length(look.normal), 1e-5, 1e-4);
    ASSERT_EQ(fault_of(vertices[k], look, {.normal = uncertainty}), "")
        << "level " << level << " vertex " << k;
  }
}

}  // namespace psygen::models::test
