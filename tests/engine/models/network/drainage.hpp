// The nodes of a network as a graph with sums over all that lies upstream, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "engine/models/network/network.hpp"

namespace psygen::models::test {

struct Drainage {
  network::NodePatch p;
  double unit_km, cell_km2;
  std::int64_t width, height;
  std::vector<std::int64_t> to, order;  // receivers; nodes that no cycle feeds, upstream first
  std::vector<double> area_km2, length_km;
  std::vector<char> cut;  // part of what drains here lies outside

  Drainage(network::NodePatch nodes, double unit_m, double node_km2)
      : p(std::move(nodes)),
        unit_km(unit_m / 1000),
        cell_km2(node_km2),
        width(p.rect.width()),
        height(p.rect.height()) {
    const auto count = static_cast<std::size_t>(width * height);
    to.assign(count, -1);
    area_km2.assign(count, cell_km2);
    length_km.assign(count, 0);
    cut.assign(count, 0);
    std::vector<int> inflows(count, 0);
    for (std::size_t q = 0; q < count; ++q) {
      const network::Node& n = p.nodes[q];
      const auto u = static_cast<std::int64_t>(q) % width, v = static_cast<std::int64_t>(q) / width;
      cut[q] = u == 0 || v == 0 || u == width - 1 || v == height - 1 ? 1 : 0;
      if (n.kind == network::Kind::kSea || n.receiver == network::kSink) continue;
      const std::int64_t x = u + network::kStepI[n.receiver], y = v + network::kStepJ[n.receiver];
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      to[q] = y * width + x;
      ++inflows[static_cast<std::size_t>(to[q])];
    }
    for (std::size_t q = 0; q < count; ++q) {
      if (inflows[q] == 0) order.push_back(static_cast<std::int64_t>(q));
    }
    for (std::size_t k = 0; k < order.size(); ++k) {
      const auto q = static_cast<std::size_t>(order[k]);
      if (to[q] < 0) continue;
      const auto t = static_cast<std::size_t>(to[q]);
      area_km2[t] += area_km2[q];
      cut[t] = static_cast<char>(cut[t] | cut[q]);
      length_km[t] = std::max(length_km[t], length_km[q] + step_km(q));
      if (--inflows[t] == 0) order.push_back(to[q]);
    }
  }
  std::size_t size() const { return p.nodes.size(); }
  double distance_km(std::size_t a, std::size_t b) const {
    return network::distance(p.nodes[a], p.nodes[b]) * unit_km;
  }
  // Length of the edge to the receiver.
  double step_km(std::size_t q) const {
    return to[q] < 0 ? 0 : distance_km(q, static_cast<std::size_t>(to[q]));
  }
};

using Line = std::vector<std::array<double, 2>>;
// Slope of the least-squares line.
inline double slope_of(const Line& line) {
  double sx = 0, sy = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(line.size());
  for (const auto& [x, y] : line) {
    sx += x;
    sy += y;
    xx += x * x;
    xy += x * y;
  }
  return (n * xy - sx * sy) / (n * xx - sx * sx);
}

struct RiverStatistics {
  double bifurcation, length_ratio, area_ratio, hack, concavity, sinuosity;
};

// Horton's ratios and Hack's exponent of the streams over a threshold, in basins that are much
// larger: the many streams that reach the coast alone are no part of a river's order.
inline RiverStatistics statistics_of(const Drainage& n, double threshold_km2) {
  struct Stream {
    double length, straight, area;
  };
  std::vector<std::vector<Stream>> streams(16);
  std::vector<int> order(n.size(), 0), most(n.size(), 0), twice(n.size(), 0);
  std::vector<double> so_far(n.size(), 0);
  std::vector<std::int64_t> head(n.size(), -1);
  std::map<int, std::array<double, 4>> bins;
  for (const std::int64_t place : n.order) {
    const auto q = static_cast<std::size_t>(place);
    const network::Node& node = n.p.nodes[q];
    if (node.kind == network::Kind::kSea) continue;
    const std::int64_t t = n.to[q];
    const double length = n.step_km(q);
    if (n.cut[q] == 0 && t >= 0 && node.kind == network::Kind::kLand && n.area_km2[q] >= 1) {
      const network::Node& down = n.p.nodes[static_cast<std::size_t>(t)];
      auto& bin = bins[static_cast<int>(std::floor(2 * std::log2(n.area_km2[q])))];
      bin[0] += 1;
      bin[1] += std::log(n.area_km2[q]);
      bin[2] += std::log(n.length_km[q]);
      bin[3] += (node.height - std::max(0, down.height)) / 1024000.0 / length;
    }
    if (n.area_km2[q] < threshold_km2) continue;
    order[q] = most[q] == 0 ? 1 : most[q] + twice[q];
    if (most[q] == 0 || twice[q] != 0) {
      head[q] = place;
      so_far[q] = 0;
    }
    if (t < 0) continue;
    const auto d = static_cast<std::size_t>(t);
    if (order[q] > most[d]) {
      most[d] = order[q];
      twice[d] = 0;
      head[d] = head[q];
      so_far[d] = so_far[q] + length;
    } else if (order[q] == most[d]) {
      twice[d] = 1;
    }
  }
  std::vector<double> basin_km2(n.size(), 0);
  for (std::size_t k = n.order.size(); k-- > 0;) {
    const auto q = static_cast<std::size_t>(n.order[k]);
    basin_km2[q] = n.to[q] < 0 ? n.area_km2[q] : basin_km2[static_cast<std::size_t>(n.to[q])];
  }
  for (const std::int64_t place : n.order) {
    const auto q = static_cast<std::size_t>(place);
    const std::int64_t t = n.to[q];
    if (basin_km2[q] < 200 * threshold_km2) continue;
    if (order[q] == 0 || n.cut[q] != 0 ||
        (t >= 0 && order[static_cast<std::size_t>(t)] == order[q]))
      continue;
    const auto from = static_cast<std::size_t>(head[q]);
    streams[static_cast<std::size_t>(order[q])].push_back(
        {so_far[q] + n.step_km(q), n.distance_km(from, t < 0 ? q : static_cast<std::size_t>(t)),
         n.area_km2[q]});
  }
  Line counts, lengths, areas, hack, slopes;  // of logarithms
  double sinuosity = 0, measured = 0;
  for (std::size_t o = 1; o < streams.size(); ++o) {
    double length = 0, area = 0;
    for (const Stream& s : streams[o]) {
      length += s.length;
      area += s.area;
      if (s.straight > 0.5) {
        sinuosity += s.length / s.straight;
        ++measured;
      }
    }
    const auto count = static_cast<double>(streams[o].size());
    if (count < 40) continue;  // the border cuts too many of the rest
    counts.push_back({static_cast<double>(o), -std::log(count)});
    lengths.push_back({static_cast<double>(o), std::log(length / count)});
    areas.push_back({static_cast<double>(o), std::log(area / count)});
  }
  for (const auto& [key, bin] : bins) {
    if (bin[0] < 20) continue;
    hack.push_back({bin[1] / bin[0], bin[2] / bin[0]});
    slopes.push_back({bin[1] / bin[0], -std::log(bin[3] / bin[0])});
  }
  return {std::exp(slope_of(counts)), std::exp(slope_of(lengths)),
          std::exp(slope_of(areas)),  slope_of(hack),
          slope_of(slopes),           sinuosity / std::max(1.0, measured)};
}

}  // namespace psygen::models::test
