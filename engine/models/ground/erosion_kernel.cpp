// Erosion of rows of heights. First every pivot in reach finds the way of its stripes, octave after
// octave: across the slope of the guide and of the wider gullies under it. Then every sample adds
// the stripes of the nine pivots around it. A pivot's stripes are straight, so no change of the
// slope makes them denser than their wavelength.
#include "engine/models/ground/erosion_kernel.hpp"

#include <algorithm>

#include "engine/models/kit/mix32.hpp"
#include "engine/models/kit/scratch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/ground/erosion_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/ground/erosion_guide-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// Pivots lie up to kJitter from the middle of their cell, in cells, and act on the distance kReach.
// So at least one acts on every place, and none beyond the nine cells around the place.
constexpr std::int64_t kJitterFrom = 2, kJitterOver = 6, kJitterOf = 10;  // parts of a cell
constexpr float kReach = 1.2F;
constexpr float kFaint2 = 0.12F;  // stripes whose mean has this square lose half of their square
constexpr float kClear = 1.5F;    // stripes are full where 1 / kClear of the slopes agree
constexpr float kTinySlope2 = 1e-12F;

// Cosine and sine of an angle in turns, within 0.02: polynomials with their zeros, extremes and
// smooth periods.
struct Wave {
  Float cosine, sine;
};
HWY_INLINE Wave wave(Float turns) {
  const Float t = hn::Sub(turns, hn::Round(turns)), u = hn::Add(t, t), y = square(u);
  const Float a = mad(y, mad(y, set(0.2222222F), set(-0.8888889F)), set(1));
  const Float b = mad(y, mad(y, set(0.48771F), set(-2.02162F)), set(3.14159F));
  return {hn::Mul(hn::Sub(set(1), hn::Mul(set(4), y)), a), hn::Mul(hn::Mul(u, rest(y)), b)};
}

// The pivots of an octave, in rows of kPivotStride. Places count from the corner of the pivot's
// cell, in units of kReach cells; `along` are waves per such unit.
struct Pivots {
  HWY_ALIGN float x[kMaxPivots * kPivotStride];
  HWY_ALIGN float z[kMaxPivots * kPivotStride];
  HWY_ALIGN float along_x[kMaxPivots * kPivotStride];
  HWY_ALIGN float along_z[kMaxPivots * kPivotStride];
  HWY_ALIGN float weight[kMaxPivots * kPivotStride];  // −1 … 1
};

// Looks up the cells of samples along a row: all lie less than a vector behind the first.
struct RowOfCells {
  std::ptrdiff_t first;
  decltype(hn::IndicesFromVec(FloatTag(), Int())) slots;
  HWY_INLINE Float operator()(const float* table, std::ptrdiff_t at) const {
    return hn::TableLookupLanes(hn::LoadU(FloatTag(), table + first + at), slots);
  }
};
// The same where all samples lie in one cell.
struct OneCell {
  std::ptrdiff_t cell;
  HWY_INLINE Float operator()(const float* table, std::ptrdiff_t at) const {
    return set(table[cell + at]);
  }
};
// Looks up any cells.
struct AnyCells {
  Int cells;
  HWY_INLINE Float operator()(const float* table, std::ptrdiff_t at) const {
    return hn::GatherIndex(FloatTag(), table + at, cells);
  }
};

// The mean of the stripes around a place: their cosine, and the sine times the direction in which
// the phase grows. They lie within the unit circle, and nearly on it where stripes agree.
struct Stripes {
  Float cosine, sine_x, sine_z;
};
template <class Look>
HWY_INLINE Stripes stripes_at(const Pivots& p, float turns, Float fraction_x, Float fraction_z,
                              const Look& look) {
  const Float x = hn::Mul(fraction_x, set(1 / kReach)), z = hn::Mul(fraction_z, set(1 / kReach));
  Float cosine = set(0), sine_x = set(0), sine_z = set(0), weights = set(0);
  for (int j = -1; j <= 1; ++j) {
    const Float from_z = hn::Sub(z, set(static_cast<float>(j) / kReach));
    for (int i = -1; i <= 1; ++i) {
      const std::ptrdiff_t at = j * static_cast<std::ptrdiff_t>(kPivotStride) + i;
      const Float dx = hn::Sub(hn::Sub(x, set(static_cast<float>(i) / kReach)), look(p.x, at));
      const Float dz = hn::Sub(from_z, look(p.z, at));
      const Float along_x = look(p.along_x, at), along_z = look(p.along_z, at);
      const Float near = square(at_least(hn::Sub(rest(square(dx)), square(dz)), 0));
      const Wave v = wave(mad(dx, along_x, hn::Mul(dz, along_z)));
      const Float weight = hn::Mul(near, look(p.weight, at)), sine = hn::Mul(weight, v.sine);
      cosine = mad(weight, v.cosine, cosine);
      sine_x = mad(sine, along_x, sine_x);
      sine_z = mad(sine, along_z, sine_z);
      weights = hn::Add(weights, near);
    }
  }
  const Float per = set(1 / (turns * kReach));
  sine_x = hn::Mul(sine_x, per);
  sine_z = hn::Mul(sine_z, per);
  const Float length2 = mad(cosine, cosine, mad(sine_x, sine_x, square(sine_z)));
  const Float scale = hn::Div(set(1), hn::Sqrt(mad(square(weights), set(kFaint2), length2)));
  return {hn::Mul(cosine, scale), hn::Mul(sine_x, scale), hn::Mul(sine_z, scale)};
}

// The same, by the fastest way to look up these cells.
HWY_INLINE Stripes stripes_in(const Pivots& pivots, float turns, Float fraction_x, Float fraction_z,
                              Int cells) {
  const FloatTag d;
  const IntTag di;
  const std::int32_t first = hn::GetLane(cells);
  const Int behind = hn::Sub(cells, hn::Set(di, first));
  if (hn::AllTrue(di, hn::Eq(behind, hn::Zero(di))))
    return stripes_at(pivots, turns, fraction_x, fraction_z, OneCell{first});
  const Int lanes = hn::Set(di, static_cast<std::int32_t>(hn::Lanes(d)));
  if (hn::AllTrue(di, hn::And(hn::Gt(behind, hn::Set(di, -1)), hn::Lt(behind, lanes))))
    return stripes_at(pivots, turns, fraction_x, fraction_z,
                      RowOfCells{first, hn::IndicesFromVec(d, behind)});
  return stripes_at(pivots, turns, fraction_x, fraction_z, AnyCells{cells});
}

// The effect of the guide on the gullies at a place.
struct Site {
  Float band;   // 0 … 1: heights where the erosion acts
  Float steep;  // 0 … 1: fraction of gullies
  Float deep;   // 0 … 1: fraction of their depth
  Float fill;   // metres of sediment
};
HWY_INLINE Site site_of(const ErosionKernel& k, const Guide& g) {
  const Float slope2 = hn::Add(mad(g.x, g.x, square(g.z)), set(kTinySlope2));
  const Float bend2 = mad(g.xx, g.xx, mad(g.zz, g.zz, hn::Mul(set(2), square(g.xz))));
  // Slopes a little way off count too, so that gullies cut through crests.
  const Float around = hn::Sqrt(mad(set(k.octaves[0].reach2_m2), bend2, slope2));
  Site s{hn::Mul(ramp(k.lowest, g.height), rest(ramp(k.highest, g.height))), ramp(k.slope, around),
         ramp(k.full, around), set(0)};
  if (k.max_fill_m > 0) {
    const Float slope = hn::Sqrt(slope2), on_scree = ramp(k.scree, slope);
    const Float deposit = hn::Min(at_least(g.hollow, 0), set(k.max_fill_m));
    const Float kept = mad(set(k.scree_share), hn::Mul(on_scree, rest(ramp(k.cliff, slope))),
                           hn::Mul(set(k.floor_share), rest(on_scree)));
    s.fill = hn::Mul(hn::Mul(deposit, kept), s.band);
    s.steep = hn::Mul(s.steep, rest(hn::Mul(kept, smooth(hn::Mul(deposit, set(k.bury))))));
  }
  s.deep = hn::Mul(s.deep, s.band);
  return s;
}

// The sum of the octaves so far.
struct Gullies {
  Float height;  // metres above the guide, at full depth
  Float x, z;    // the slope of the ground
  Float value;   // −1 in beds … 1 on ridges
  Float open;    // 0 … 1: fraction that finer octaves may change

  HWY_INLINE explicit Gullies(const Guide& g)
      : height(set(0)), x(g.x), z(g.z), value(set(0)), open(set(1)) {}
  // Finer gullies spare the ridges and beds of wider ones.
  HWY_INLINE void add(const ErosionKernel& k, std::size_t octave, const Site& s,
                      const Stripes& stripes) {
    const Float ridge = hn::Sqrt(mad(set(-0.5F), stripes.cosine, set(0.5F + k.ridge_softness)));
    const Float bed = hn::Sqrt(mad(set(0.5F), stripes.cosine, set(0.5F + k.bed_softness)));
    const Float profile = hn::Mul(hn::Sub(bed, ridge), set(k.profile_scale));
    // Cliffs stay a little smoother.
    const Float cliff = smooth(mad(mad(x, x, square(z)), set(0.5F), set(-0.3F)));
    const Float part = hn::Mul(hn::Mul(open, s.steep), mad(cliff, set(-0.2F), set(1)));
    value = mad(part, hn::Sub(profile, value), value);
    height = mad(value, set(k.octaves[octave].depth_m), height);
    const Float side = hn::Mul(hn::Mul(part, s.deep), set(-k.octaves[octave].side));
    x = mad(stripes.sine_x, side, x);
    z = mad(stripes.sine_z, side, z);
    const Float sine2 = mad(stripes.sine_x, stripes.sine_x, square(stripes.sine_z));
    open = hn::Mul(rest(square(rest(open))), rest(square(square(rest(sine2)))));
  }
};

// Working memory: the guide's lines at the columns of the samples, and all pivots.
struct Memory {
  Field hollows, blurred;  // sediment on the guide's lines, in metres
  HWY_ALIGN float value[kMaxErosionAxis][kMaxErosionAxis];
  HWY_ALIGN float slope[kMaxErosionAxis][kMaxErosionAxis];
  HWY_ALIGN float bend[kMaxErosionAxis][kMaxErosionAxis];
  HWY_ALIGN float hollow[kMaxErosionAxis][kMaxErosionAxis];
  Pivots pivots[kMaxErosionOctaves];
};

// Finds the pivots of an octave, a vector at a time, after those of the wider ones.
class PivotFinder {
 public:
  PivotFinder(const ErosionCall& call, std::size_t octave, Memory& memory)
      : call_(call),
        k_(*call.kernel),
        o_(octave),
        memory_(memory),
        per_place_(1 / (static_cast<float>(k_.octaves[octave].size) * kReach)) {
    for (std::size_t q = 0; q < octave; ++q) {
      const ErosionOctave& wide = k_.octaves[q];
      lattices_[q].set_size(wide.size);
      lattices_[q].first_x = call.x->first_cell[q] * wide.size + wide.origin_x;
      lattices_[q].first_z = call.z->first_cell[q] * wide.size + wide.origin_z;
      lattices_[q].stride = static_cast<std::int32_t>(kPivotStride);
    }
    Lattice& guide = lattices_[octave];
    guide.set_size(call.spacing);
    guide.first_x = (call.x->first_line + 1) * call.spacing;  // the first tap is one line before
    guide.first_z = (call.z->first_line + 1) * call.spacing;
    guide.stride = static_cast<std::int32_t>(kMaxErosionAxis);
  }

  void run() {
    const std::size_t columns = call_.x->cells[o_], count = columns * call_.z->cells[o_];
    const std::size_t lanes = hn::Lanes(FloatTag());
    for (std::size_t i = 0; i < count; i += lanes) {
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::size_t n = std::min(i + l, count - 1);
        place(l, n % columns, n / columns);
      }
      find_ways();
      for (std::size_t l = 0; l < std::min(lanes, count - i); ++l)
        store(l, (i + l) / columns * kPivotStride + (i + l) % columns);
    }
  }

 private:
  // Draws a pivot and places it on the guide and on the wider octaves.
  void place(std::size_t lane, std::size_t column, std::size_t row) {
    const ErosionOctave& octave = k_.octaves[o_];
    const std::int64_t cell_x = call_.x->first_cell[o_] + static_cast<std::int64_t>(column);
    const std::int64_t cell_z = call_.z->first_cell[o_] + static_cast<std::int64_t>(row);
    const std::uint32_t h =
        models::mix32(static_cast<std::uint32_t>(cell_x) ^
                      models::mix32(static_cast<std::uint32_t>(cell_z) ^ octave.key));
    const std::int64_t in_x = jittered(octave.size, h & 0x7FFFU),
                       in_z = jittered(octave.size, h >> 15 & 0x7FFFU);
    x_[lane] = static_cast<float>(in_x) * per_place_;
    z_[lane] = static_cast<float>(in_z) * per_place_;
    sign_[lane] = h >> 31 != 0 ? -1.0F : 1.0F;
    const std::int64_t x = cell_x * octave.size + octave.origin_x + in_x;
    const std::int64_t z = cell_z * octave.size + octave.origin_z + in_z;
    for (std::size_t q = 0; q <= o_; ++q) {
      const Lattice& l = lattices_[q];
      const std::int32_t at_x = l.place(x - l.first_x, share_x_[q][lane]);
      const std::int32_t at_z = l.place(z - l.first_z, share_z_[q][lane]);
      cells_[q][lane] = at_z * l.stride + at_x;
    }
  }

  // Finds the directions of stripes: across the slopes around the pivot. The mean product of
  // slopes there has no sign, so it turns no faster than the ground.
  void find_ways() {
    const FloatTag d;
    const IntTag di;
    const Guide g = guide();
    const Site site = site_of(k_, g);
    Gullies ground(g);
    for (std::size_t q = 0; q < o_; ++q)
      ground.add(k_, q, site,
                 stripes_in(memory_.pivots[q], k_.turns, hn::Load(d, share_x_[q]),
                            hn::Load(d, share_z_[q]), hn::Load(di, cells_[q])));
    const Float reach2 = set(k_.octaves[o_].reach2_m2);
    const Float xx = mad(reach2, mad(g.xx, g.xx, square(g.xz)), square(ground.x));
    const Float zz = mad(reach2, mad(g.zz, g.zz, square(g.xz)), square(ground.z));
    const Float xz = mad(reach2, hn::Mul(g.xz, hn::Add(g.xx, g.zz)), hn::Mul(ground.x, ground.z));
    const Float a = hn::Sub(xx, zz), b = hn::Add(xz, xz);  // twice the angle
    const Float length = hn::Add(hn::Sqrt(mad(a, a, square(b))), set(1e-13F));
    const Float all = hn::Add(hn::Add(xx, zz), set(kTinySlope2));
    const Float half = hn::Mul(set(0.5F), hn::Div(a, length)), turns = set(k_.turns * kReach);
    const Float x = hn::Sqrt(at_least(hn::Add(set(0.5F), half), 0));
    const Float z = hn::CopySign(hn::Sqrt(at_least(hn::Sub(set(0.5F), half), 0)), b);
    hn::Store(hn::Mul(hn::Neg(z), turns), d, along_x_);
    hn::Store(hn::Mul(x, turns), d, along_z_);
    hn::Store(hn::Mul(hn::Load(d, sign_), smooth(hn::Mul(hn::Div(length, all), set(kClear)))), d,
              weight_);
  }

  Guide guide() const {
    const FloatTag d;
    const float per_m = 1 / call_.spacing_m;
    const Taps along_x(hn::Load(d, share_x_[o_]), per_m), along_z(hn::Load(d, share_z_[o_]), per_m);
    const Int first = hn::Load(IntTag(), cells_[o_]);
    Guide g;
    for (std::size_t b = 0; b < 4; ++b) {
      const std::size_t line = b * kMaxErosionAxis;
      g.add(point_on(call_.guide + line,
                     call_.passes == 0 ? nullptr : memory_.hollows.line(0) + line, first, along_x),
            along_z, b);
    }
    return g;
  }

  void store(std::size_t lane, std::size_t at) {
    Pivots& out = memory_.pivots[o_];
    out.x[at] = x_[lane];
    out.z[at] = z_[lane];
    out.along_x[at] = along_x_[lane];
    out.along_z[at] = along_z_[lane];
    out.weight[at] = weight_[lane];
  }

  static std::int64_t jittered(std::int64_t size, std::uint32_t random15) {
    return (size * kJitterFrom + (size * kJitterOver * random15 >> 15)) / kJitterOf;
  }

  // The cells of a wider octave, or of the guide, in units from the first one of the tables.
  struct Lattice {
    std::int64_t first_x = 0, first_z = 0, size = 1;
    std::int32_t stride = 0;  // of the table
    double inverse = 1;
    float share = 1;

    void set_size(std::int64_t units) {
      size = units;
      inverse = 1 / static_cast<double>(units);
      share = 1 / static_cast<float>(units);
    }
    // Divides exactly. `units` are not negative and below 2^53.
    std::int32_t place(std::int64_t units, float& fraction) const {
      auto cell = static_cast<std::int64_t>(static_cast<double>(units) * inverse);
      std::int64_t rest = units - cell * size;
      if (rest < 0) {
        --cell;
        rest += size;
      } else if (rest >= size) {
        ++cell;
        rest -= size;
      }
      fraction = static_cast<float>(rest) * share;
      return static_cast<std::int32_t>(cell);
    }
  };

  const ErosionCall& call_;
  const ErosionKernel& k_;
  std::size_t o_;
  Memory& memory_;
  float per_place_;
  Lattice lattices_[kMaxErosionOctaves];  // of wider octaves; [o_] is the guide
  // Of a vector of pivots, on the lattices.
  HWY_ALIGN std::int32_t cells_[kMaxErosionOctaves][kMaxLanes];
  HWY_ALIGN float share_x_[kMaxErosionOctaves][kMaxLanes], share_z_[kMaxErosionOctaves][kMaxLanes];
  HWY_ALIGN float x_[kMaxLanes], z_[kMaxLanes], sign_[kMaxLanes];
  HWY_ALIGN float along_x_[kMaxLanes], along_z_[kMaxLanes], weight_[kMaxLanes];
};

// Interpolates all lines of the guide at the columns of the samples.
void spread_lines(const ErosionCall& call, Memory& m) {
  const FloatTag d;
  for (std::size_t i = 0; i < call.x->count; i += hn::Lanes(d)) {
    const Taps taps(hn::LoadU(d, call.x->share.data() + i), 1 / call.spacing_m);
    const Int first = hn::LoadU(IntTag(), call.x->line.data() + i);
    for (std::size_t l = 0; l < call.z->lines; ++l) {
      const std::size_t line = l * kMaxErosionAxis;
      const LinePoint p =
          point_on(call.guide + line, call.passes == 0 ? nullptr : m.hollows.line(l), first, taps);
      hn::Store(p.value, d, m.value[l] + i);
      hn::Store(p.slope, d, m.slope[l] + i);
      hn::Store(p.bend, d, m.bend[l] + i);
      hn::Store(p.hollow, d, m.hollow[l] + i);
    }
  }
}

// Erodes rows of samples.
class RowEroder {
 public:
  RowEroder(const ErosionCall& call, const Memory& memory)
      : call_(call), k_(*call.kernel), memory_(memory) {}

  void run(std::size_t row, float* values) const {
    const FloatTag d;
    const std::size_t lanes = hn::Lanes(d), count = call_.x->count;
    const Taps along_z(set(call_.z->share[row]), 1 / call_.spacing_m);
    const auto line = static_cast<std::size_t>(call_.z->line[row]);
    for (std::size_t i = 0; i < count; i += lanes) {
      const std::size_t some = std::min(lanes, count - i);
      const Float before = load_few(values + i, some);
      const Float worn =
          call_.worn == nullptr ? before : load_few(call_.worn + row * call_.worn_stride + i, some);
      hn::BlendedStore(eroded(before, worn, guide(line, i, along_z), row, i), hn::FirstN(d, some),
                       d, values + i);
    }
  }

 private:
  HWY_INLINE Guide guide(std::size_t line, std::size_t i, const Taps& along_z) const {
    const FloatTag d;
    Guide g;
    for (std::size_t b = 0; b < 4; ++b)
      g.add({hn::Load(d, memory_.value[line + b] + i), hn::Load(d, memory_.slope[line + b] + i),
             hn::Load(d, memory_.bend[line + b] + i), hn::Load(d, memory_.hollow[line + b] + i)},
            along_z, b);
    return g;
  }

  HWY_INLINE Stripes stripes(std::size_t octave, std::size_t row, std::size_t i) const {
    const FloatTag d;
    const IntTag di;
    const std::int32_t from = call_.z->cell[octave][row] * static_cast<std::int32_t>(kPivotStride);
    return stripes_in(memory_.pivots[octave], k_.turns,
                      hn::LoadU(d, call_.x->fraction[octave].data() + i),
                      set(call_.z->fraction[octave][row]),
                      hn::Add(hn::LoadU(di, call_.x->cell[octave].data() + i), hn::Set(di, from)));
  }

  HWY_INLINE Float eroded(Float before, Float worn, const Guide& g, std::size_t row,
                          std::size_t i) const {
    const Site site = site_of(k_, g);
    Gullies gullies(g);
    for (std::size_t o = 0; o < k_.octave_count; ++o)
      gullies.add(k_, o, site, stripes(o, row, i));
    Float change = mad(hn::Sub(gullies.height, set(k_.carve_m)), site.deep, site.fill);
    const Float wide = call_.wears_to_guide ? hn::Mul(g.height, set(1 / k_.unit_m)) : worn;
    const Float base = mad(hn::Mul(site.band, set(k_.wear)), hn::Sub(wide, before), before);
    if (k_.strata > 0) {
      const Float slope = hn::Sqrt(mad(gullies.x, gullies.x, square(gullies.z)));
      const Float turns = hn::Mul(mad(base, set(k_.unit_m), change), set(k_.strata_turns));
      const Float thin = wave(turns).sine, thick = wave(hn::Mul(turns, set(0.27F))).sine;
      const Float bands = mad(thick, set(0.9259F), hn::Mul(thin, set(0.75F)));
      const Float shown = hn::Mul(hn::Mul(ramp(k_.cliff, slope), site.band), set(k_.strata));
      change = hn::Sub(change, hn::Mul(bands, shown));
    }
    const Float after = mad(change, set(1 / k_.unit_m), base);
    return hn::Min(at_least(after, 0), set(k_.highest_value));
  }

  const ErosionCall& call_;
  const ErosionKernel& k_;
  const Memory& memory_;
};

void erode(const ErosionCall& call, float* values, std::size_t stride) {
  const Scratch<Memory> scratch;
  if (call.passes > 0) fill_hollows(call, scratch->hollows, scratch->blurred);
  for (std::size_t o = 0; o < call.kernel->octave_count; ++o)
    PivotFinder(call, o, *scratch).run();
  spread_lines(call, *scratch);
  const RowEroder rows(call, *scratch);
  for (std::size_t r = 0; r < call.z->count; ++r)
    rows.run(r, values + r * stride);
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {

HWY_EXPORT(erode);

void erode_rows(const ErosionCall& call, float* values, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(erode)(call, values, stride);
}

}  // namespace psygen::models
#endif
