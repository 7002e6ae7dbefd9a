#include "engine/render/textures/ground_patterns.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/hash.hpp"

namespace psygen::render {

namespace {

// A coordinate of a texel between two lattice points, and the smooth share of the second one.
struct Between {
  int first = 0, second = 0;
  float share = 0;
};

std::array<Between, kPatternSide> between(int cells) {
  std::array<Between, kPatternSide> out;
  const int step = kPatternSide / cells;
  for (int i = 0; i < kPatternSide; ++i) {
    const float f = static_cast<float>(i % step) / static_cast<float>(step);
    out[static_cast<std::size_t>(i)] = {i / step, (i / step + 1) % cells,
                                        f * f * f * (f * (f * 6 - 15) + 10)};
  }
  return out;
}

void add_octave(int cells_x, int cells_y, float strength, std::uint32_t stream, Field& field) {
  std::vector<float> lattice(static_cast<std::size_t>(cells_x) * static_cast<std::size_t>(cells_y));
  for (std::size_t i = 0; i < lattice.size(); ++i)
    lattice[i] = strength * (2 * random_share(stream, static_cast<std::uint32_t>(i)) - 1);
  const auto across = between(cells_x), down = between(cells_y);
  std::array<float, kPatternSide> row{};  // of the lattice, between two of its rows
  for (int y = 0; y < kPatternSide; ++y) {
    const Between& v = down[static_cast<std::size_t>(y)];
    const float* const top = lattice.data() + v.first * cells_x;
    const float* const bottom = lattice.data() + v.second * cells_x;
    for (int i = 0; i < cells_x; ++i)
      row[static_cast<std::size_t>(i)] = top[i] + (bottom[i] - top[i]) * v.share;
    float* const out = &field.at(0, y);
    for (int x = 0; x < kPatternSide; ++x) {
      const Between& u = across[static_cast<std::size_t>(x)];
      const float left = row[static_cast<std::size_t>(u.first)];
      out[x] += left + (row[static_cast<std::size_t>(u.second)] - left) * u.share;
    }
  }
}

}  // namespace

float random_share(std::uint32_t stream, std::uint32_t number) {
  const std::uint64_t bits = core::mix64((std::uint64_t{stream} << 32) | number);
  return static_cast<float>(bits >> 40) * 0x1.0p-24F;
}

Field tiled_noise(int cells_x, int cells_y, int octaves, float gain, std::uint32_t stream) {
  Field field;
  float strength = 1;
  for (int i = 0; i < octaves && std::max(cells_x, cells_y) <= kPatternSide; ++i) {
    add_octave(cells_x, cells_y, strength, stream + static_cast<std::uint32_t>(i) * 0x9E37U, field);
    strength *= gain;
    cells_x *= 2;
    cells_y *= 2;
  }
  return field;
}

Cells cells(int per_side, std::uint32_t stream) {
  Cells out;
  const int step = kPatternSide / per_side;
  const auto share = [&](int column, int row, std::uint32_t which) {
    const int wrapped = (row & (per_side - 1)) * per_side + (column & (per_side - 1));
    return random_share(stream + which, static_cast<std::uint32_t>(wrapped));
  };
  struct Point {
    float x, y, tone, tilt_x, tilt_y;
  };
  for (int row = 0; row < per_side; ++row) {
    for (int column = 0; column < per_side; ++column) {
      std::array<Point, 9> points{};
      for (int k = 0; k < 9; ++k) {
        const int c = column + k % 3 - 1, r = row + k / 3 - 1;
        points[static_cast<std::size_t>(k)] = {static_cast<float>(c) + 0.1F + 0.8F * share(c, r, 0),
                                               static_cast<float>(r) + 0.1F + 0.8F * share(c, r, 1),
                                               share(c, r, 2), 2 * share(c, r, 3) - 1,
                                               2 * share(c, r, 4) - 1};
      }
      for (int i = 0; i < step * step; ++i) {
        const int tx = column * step + i % step, ty = row * step + i / step;
        const float x = (static_cast<float>(tx) + 0.5F) / static_cast<float>(step);
        const float y = (static_cast<float>(ty) + 0.5F) / static_cast<float>(step);
        float first = 1e9F, second = 1e9F;
        const Point* nearest = points.data();
        for (const Point& p : points) {
          const float d = (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
          if (d < first) {
            second = first;
            first = d;
            nearest = &p;
          } else {
            second = std::min(second, d);
          }
        }
        out.edge.at(tx, ty) = std::sqrt(second) - std::sqrt(first);
        out.tone.at(tx, ty) = nearest->tone;
        out.slope.at(tx, ty) =
            (x - nearest->x) * nearest->tilt_x + (y - nearest->y) * nearest->tilt_y;
      }
    }
  }
  return out;
}

void draw_stroke(const Stroke& s, Field& height, Field& tone) {
  const int steps = 1 + static_cast<int>(1.5F * std::max(std::abs(s.dx), std::abs(s.dy)));
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const float x = s.x + t * s.dx, y = s.y + t * s.dy;
    const float half = 0.5F * s.width * (1.1F - t), h = s.low + t * (s.high - s.low);
    const int reach = static_cast<int>(half);
    for (int v = -reach; v <= reach; ++v) {
      for (int u = -reach; u <= reach; ++u) {
        if (static_cast<float>(u * u + v * v) > half * half) continue;
        float& here = height.at(static_cast<int>(x) + u, static_cast<int>(y) + v);
        if (here >= h) continue;
        here = h;
        tone.at(static_cast<int>(x) + u, static_cast<int>(y) + v) = s.tone;
      }
    }
  }
}

std::array<Field, 2> height_gradient(const Field& height) {
  std::array<Field, 2> out;
  for (int y = 0; y < kPatternSide; ++y) {
    for (int x = 0; x < kPatternSide; ++x) {
      out[0].at(x, y) = 0.5F * (height.at(x + 1, y) - height.at(x - 1, y));
      out[1].at(x, y) = 0.5F * (height.at(x, y + 1) - height.at(x, y - 1));
    }
  }
  return out;
}

Field raised(const Field& height, int reach) {
  const float share = 1.0F / static_cast<float>(2 * reach + 1);
  Field rows, out;
  for (int y = 0; y < kPatternSide; ++y) {
    float sum = 0;
    for (int x = -reach; x <= reach; ++x)
      sum += height.at(x, y);
    for (int x = 0; x < kPatternSide; ++x) {
      rows.at(x, y) = sum * share;
      sum += height.at(x + reach + 1, y) - height.at(x - reach, y);
    }
  }
  std::array<float, kPatternSide> sums{};
  for (int y = -reach; y <= reach; ++y) {
    for (int x = 0; x < kPatternSide; ++x)
      sums[static_cast<std::size_t>(x)] += rows.at(x, y);
  }
  for (int y = 0; y < kPatternSide; ++y) {
    for (int x = 0; x < kPatternSide; ++x) {
      float& sum = sums[static_cast<std::size_t>(x)];
      out.at(x, y) = height.at(x, y) - sum * share;
      sum += rows.at(x, y + reach + 1) - rows.at(x, y - reach);
    }
  }
  return out;
}

}  // namespace psygen::render
