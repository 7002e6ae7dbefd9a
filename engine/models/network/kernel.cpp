// One call: the sums of spots (guide-inl.hpp), then vectors of samples that channels cut
// (channels-inl.hpp).
#include "engine/models/network/kernel.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "engine/models/kit/scratch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/network/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/network/channels-inl.hpp"
#include "engine/models/network/guide-inl.hpp"

#ifndef PSYGEN_MODELS_NETWORK_KERNEL_ONCE
#define PSYGEN_MODELS_NETWORK_KERNEL_ONCE
namespace psygen::models::network {

// The spots and curves that reach a call's samples.
struct Chosen {
  std::vector<const Spot*> spots;
  std::vector<const Curve*> curves;
  std::vector<std::int32_t> lakes;  // ascending
};

}  // namespace psygen::models::network
#endif

HWY_BEFORE_NAMESPACE();
namespace psygen::models::network::HWY_NAMESPACE {

// The lake with the largest share at each sample.
struct LakeRows {
  HWY_ALIGN float share[kMaxSamples * kRow], level[kMaxSamples * kRow], depth[kMaxSamples * kRow];
  HWY_ALIGN std::int32_t body[kMaxSamples * kRow];
};

// One call: the chosen spots and curves at its samples.
class Call {
 public:
  Call(const Patch& patch, const Samples& samples, const Chosen& chosen)
      : patch_(patch), chosen_(chosen), guided_(samples.guided) {
    Axes& s = samples_;
    s.columns = samples.x.size();
    s.rows = samples.z.size();
    std::copy(samples.x.begin(), samples.x.end(), s.x);
    std::copy(samples.z.begin(), samples.z.end(), s.z);
    s.pad();
    if (guided_) reader_.emplace(s, guide_);
  }

  void base(const BaseRows& out) {
    sum_all(out.slope_x != nullptr);
    if (!chosen_.lakes.empty()) find_lakes();
    for (std::size_t r = 0; r < samples_.rows; ++r)
      base_row(r, out);
  }
  void carve(const CarvedRows& out) {
    if (!chosen_.lakes.empty()) {
      sum_all(false);
      find_lakes();
    }
    carve_all(out);
  }
  void ground(CarvedRows out) {
    HWY_ALIGN float base[kMaxSamples * kRow];
    this->base({.height_m = base, .stride = kRow});
    for (std::size_t r = 0; r < samples_.rows; ++r)
      std::copy_n(base + r * kRow, samples_.columns, out.height_m + r * out.stride);
    out.base_m = base;
    out.base_stride = kRow;
    carve_all(out);
  }

 private:
  void carve_all(const CarvedRows& out) {
    for (std::size_t r = 0; r < samples_.rows; ++r) {
      for (std::size_t i = 0; i < samples_.columns; i += lanes())
        carve_vector(r, i, out);
    }
  }
  const Axes& axes() const { return guided_ ? guide_ : samples_; }

  // Sums over all spots; then heights are divided by weights.
  void sum_all(bool gradient) {
    const Axes& a = axes();
    Sums& sums = *sums_;
    const std::size_t size = a.rows * kRow;
    std::fill_n(sums.weight, size, 0.0F);
    std::fill_n(sums.height, size, 0.0F);
    if (gradient && !guided_) {
      for (float* sum : {sums.wx, sums.wz, sums.hx, sums.hz})
        std::fill_n(sum, size, 0.0F);
      for (const Spot* s : chosen_.spots)
        add_spot<Wanted::kGradient>(*s, a, sums);
    } else {
      for (const Spot* s : chosen_.spots)
        add_spot<Wanted::kHeight>(*s, a, sums);
    }
    const Float least = set(1e-20F);
    for (std::size_t r = 0; r < a.rows; ++r) {
      for (std::size_t i = r * kRow; i < r * kRow + a.columns; i += lanes()) {
        const Float w = hn::Max(load(sums.weight + i), least);
        const Float h = hn::Div(load(sums.height + i), w);
        store(w, sums.weight + i);
        store(h, sums.height + i);
        if (!gradient || guided_) continue;
        const auto slope = [&](float* height, const float* weight) HWY_ATTR {
          store(hn::Div(hn::Sub(load(height + i), hn::Mul(h, load(weight + i))), w), height + i);
        };
        slope(sums.hx, sums.wx);
        slope(sums.hz, sums.wz);
      }
    }
  }

  // Finds the lake with the largest share at every sample.
  void find_lakes() {
    const Axes& a = axes();
    Sums& sums = *sums_;
    LakeRows& lakes = *lakes_;
    for (float* row : {lakes.share, lakes.level, lakes.depth})
      std::fill_n(row, samples_.rows * kRow, 0.0F);
    std::fill_n(lakes.body, samples_.rows * kRow, 0);
    for (const std::int32_t index : chosen_.lakes) {
      const Lake& lake = patch_.lakes[static_cast<std::size_t>(index)];
      std::fill_n(sums.lake, a.rows * kRow, 0.0F);
      std::fill_n(sums.depth, a.rows * kRow, 0.0F);
      for (const Spot* s : chosen_.spots) {
        if (s->lake == index) add_spot<Wanted::kLake>(*s, a, sums);
      }
      for (std::size_t r = 0; r < a.rows; ++r) {
        for (std::size_t i = r * kRow; i < r * kRow + a.columns; i += lanes()) {
          store(hn::Div(load(sums.lake + i), load(sums.weight + i)), sums.lake + i);
          store(hn::Div(load(sums.depth + i), load(sums.weight + i)), sums.depth + i);
        }
      }
      for (std::size_t r = 0; r < samples_.rows; ++r)
        compare_lake(r, lake);
    }
  }
  void compare_lake(std::size_t r, const Lake& lake) {
    const IntTag di;
    HWY_ALIGN float share[kRow], depth[kRow];
    const float *shares = sums_->lake + r * kRow, *depths = sums_->depth + r * kRow;
    if (guided_) {
      reader_->read(sums_->lake, r, share, nullptr, nullptr);
      reader_->read(sums_->depth, r, depth, nullptr, nullptr);
      shares = share;
      depths = depth;
    }
    LakeRows& best = *lakes_;
    for (std::size_t i = 0; i < samples_.columns; i += lanes()) {
      const std::size_t at = r * kRow + i;
      const Float s = hn::Min(load(shares + i), set(1)), old = load(best.share + at);
      const auto more = hn::Gt(s, old);
      // The depth of the lake's own spots.
      const Float deep = hn::Div(load(depths + i), hn::Max(s, set(1e-3F)));
      store(hn::IfThenElse(more, s, old), best.share + at);
      store(hn::IfThenElse(more, set(lake.level_m), load(best.level + at)), best.level + at);
      store(hn::IfThenElse(more, deep, load(best.depth + at)), best.depth + at);
      const Int body = hn::Set(di, static_cast<std::int32_t>(lake.body));
      hn::StoreU(hn::IfThenElse(hn::RebindMask(di, more), body, hn::LoadU(di, best.body + at)), di,
                 best.body + at);
    }
  }

  // The share, the level and the depth of the lake at a vector.
  struct LakeAt {
    Float share, level, depth;
  };
  LakeAt lake_at(std::size_t at) const {
    const FloatTag d;
    if (chosen_.lakes.empty()) return {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    return {load(lakes_->share + at), load(lakes_->level + at), load(lakes_->depth + at)};
  }
  // Closes the shore: no ground beside a lake lies lower than its water.
  Float closed(Float ground, const LakeAt& lake) const {
    const Float open = hn::Max(hn::Sub(set(0.5F), lake.share), hn::Zero(FloatTag()));
    const Float shore = hn::Sub(lake.level, hn::Mul(open, set(patch_.shore_m)));
    return hn::IfThenElse(hn::Gt(lake.share, set(0.1F)), hn::Max(ground, shore), ground);
  }

  void base_row(std::size_t r, const BaseRows& out) {
    HWY_ALIGN float height[kRow], along[kRow], across[kRow];
    const float *heights = sums_->height + r * kRow, *slopes_x = sums_->hx + r * kRow,
                *slopes_z = sums_->hz + r * kRow;
    float per_metre = 1.0F / patch_.unit_m;
    if (guided_) {
      const bool slopes = out.slope_x != nullptr;
      reader_->read(sums_->height, r, height, slopes ? along : nullptr, slopes ? across : nullptr);
      heights = height;
      slopes_x = along;
      slopes_z = across;
      per_metre = per_metre / static_cast<float>(kGuideUnits);
    }
    for (std::size_t i = 0; i < samples_.columns; i += lanes()) {
      const std::size_t n = std::min(lanes(), samples_.columns - i);
      const LakeAt lake = lake_at(r * kRow + i);
      const Float base = closed(load(heights + i), lake);
      const auto write = [&](Float value, float* rows) HWY_ATTR {
        if (rows != nullptr) store_few(value, FloatTag(), rows + r * out.stride + i, n);
      };
      write(base, out.height_m);
      if (out.slope_x != nullptr) {
        write(hn::Mul(load(slopes_x + i), set(per_metre)), out.slope_x);
        write(hn::Mul(load(slopes_z + i), set(per_metre)), out.slope_z);
      }
      if (out.clear != nullptr) write(clear_at(r, i, base, lake), out.clear);
    }
  }

  // True if a curve may reach the vector at column i of row r, and its place from the curve's node.
  bool reaches(const Curve& c, std::size_t r, std::size_t i, Float& px, Float& pz) const {
    const float dz = static_cast<float>(samples_.z[r] - c.z) * patch_.unit_m;
    if (dz > c.reach_m || -dz > c.reach_m) return false;
    const float first = static_cast<float>(samples_.x[i] - c.x) * patch_.unit_m;
    const float last = static_cast<float>(samples_.x[i + lanes() - 1] - c.x) * patch_.unit_m;
    if (first > c.reach_m || -last > c.reach_m) return false;
    const FloatTag d;
    const IntTag di;
    const Int dx = hn::Sub(hn::Load(di, samples_.x + i), hn::Set(di, c.x));
    px = hn::Mul(hn::ConvertTo(d, dx), set(patch_.unit_m));
    pz = set(dz);
    return true;
  }

  Float clear_at(std::size_t r, std::size_t i, Float base, const LakeAt& lake) const {
    const FloatTag d;
    Float clear = set(1), px, pz;
    for (const Curve* c : chosen_.curves) {
      if (!reaches(*c, r, i, px, pz)) continue;
      const Beside b = beside(*c, px, pz);
      const Float bank = hn::Add(set(kLeveeM), hn::Mul(b.width, set(kBankWidths)));
      const Float s = hn::Min(hn::Max(hn::Div(b.edge, bank), hn::Zero(d)), set(1));
      const Float here = hn::Sub(set(1), hn::Mul(hn::Sub(set(1), s), b.taper));
      clear = hn::IfThenElse(b.near, hn::Min(clear, here), clear);
    }
    const Float dry = hn::Sub(set(1), hn::Min(hn::Add(lake.share, lake.share), set(1)));
    const Float above = hn::Mul(hn::Sub(base, set(patch_.sea_level_m)), set(1.0F / 6));
    const Float land = hn::Min(hn::Max(above, hn::Zero(d)), set(1));
    return hn::Mul(hn::Mul(smooth(clear), dry), land);
  }

  // One vector of samples. Valleys are lowered first, then banks and the ground under water are
  // raised to the water, so that no valley drains another channel; then all beds are cut, so that
  // no bank dams another bed.
  void carve_vector(std::size_t r, std::size_t i, const CarvedRows& out) {
    const FloatTag d;
    const IntTag di;
    const std::size_t n = std::min(lanes(), samples_.columns - i), at = r * out.stride + i;
    const LakeAt lake = lake_at(r * kRow + i);
    const Float zero = hn::Zero(d), sea_level = set(patch_.sea_level_m);
    const Float base = load_few(out.base_m + r * out.base_stride + i, n);
    Float ground = closed(load_few(out.height_m + at, n), lake);
    const auto inside = hn::Gt(lake.share, set(0.5F));
    const auto sea = hn::AndNot(inside, hn::Lt(base, sea_level));
    const Float basin = smooth(hn::Max(hn::Sub(hn::Add(lake.share, lake.share), set(1)), zero));
    ground = hn::IfThenElse(inside, hn::Sub(ground, hn::Mul(lake.depth, basin)), ground);
    const auto lake_water = hn::And(inside, hn::Lt(ground, lake.level));
    const auto open = hn::Or(sea, lake_water);  // has no banks

    Water w{zero, zero, zero, zero, zero, hn::Zero(di)};
    Float low = ground, bed = set(1e30F), px, pz;
    bool any = false;
    for (const Curve* c : chosen_.curves) {
      if (!reaches(*c, r, i, px, pz)) continue;
      const Beside b = beside(*c, px, pz);
      if (hn::AllFalse(d, b.near)) continue;
      any = true;
      const Bank bank = bank_of(b);
      const Float lowered =
          hn::Add(ground, hn::Mul(hn::Sub(hn::Add(bank.height, bank.rise), ground), bank.force));
      low = hn::IfThenElse(bank.dry, hn::Min(low, lowered), low);
      bed = hn::Min(bed, bed_of(b, ground));
      if (out.water_m != nullptr) add_channel(*c, b, out.flow_x != nullptr, w);
    }
    Float high = low;
    if (any) {
      for (const Curve* c : chosen_.curves) {
        if (!reaches(*c, r, i, px, pz)) continue;
        const Beside b = beside(*c, px, pz);
        const Bank bank = bank_of(b);
        const Float raised =
            hn::Add(low, hn::Mul(hn::Sub(bank.height, low), hn::Mul(bank.levee, bank.levee)));
        high = hn::IfThenElse(b.near, hn::Max(high, raised), high);
      }
      high = hn::IfThenElse(open, ground, high);
    }
    ground = hn::Min(high, bed);
    store_few(ground, d, out.height_m + at, n);
    if (out.water_m == nullptr) return;
    const Int lake_body =
        chosen_.lakes.empty() ? hn::Zero(di) : hn::LoadU(di, lakes_->body + r * kRow + i);
    add_still(lake_water, lake.level, lake_body, w);
    const auto alone = hn::Eq(w.weight, zero);
    const auto flooded = hn::And(alone, hn::Lt(ground, sea_level));
    add_still(hn::Or(sea, flooded), sea_level, hn::Set(di, std::int32_t{kSeaBody}), w);
    write_water(w, ground, at, n, out);
  }

  const Patch& patch_;
  const Chosen& chosen_;
  bool guided_;
  Axes samples_, guide_;
  std::optional<GuideReader> reader_;
  Scratch<Sums> sums_;
  Scratch<LakeRows> lakes_;
};

void base_on_target(const Patch& patch, const Samples& samples, const Chosen& chosen,
                    const BaseRows& rows) {
  Call(patch, samples, chosen).base(rows);
}
void carve_on_target(const Patch& patch, const Samples& samples, const Chosen& chosen,
                     const CarvedRows& rows) {
  Call(patch, samples, chosen).carve(rows);
}
void ground_on_target(const Patch& patch, const Samples& samples, const Chosen& chosen,
                      const CarvedRows& rows) {
  Call(patch, samples, chosen).ground(rows);
}

}  // namespace psygen::models::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models::network {
namespace {

HWY_EXPORT(base_on_target);
HWY_EXPORT(carve_on_target);
HWY_EXPORT(ground_on_target);

// The box that spots and curves must reach to change samples in a box.
Box read_for(const Box& box, bool guided) {
  return box.grown(guided ? kGuideReach : 0);
}

// Chooses what reaches the samples, in the patch's order. More than that would change no bit.
Chosen choose(const Patch& patch, const Samples& samples) {
  Chosen chosen;
  const Box box = read_for(
      {samples.x.front(), samples.z.front(), samples.x.back(), samples.z.back()}, samples.guided);
  patch.each_spot(box, [&](const Spot& s) {
    chosen.spots.push_back(&s);
    if (s.lake >= 0) chosen.lakes.push_back(s.lake);
  });
  std::sort(chosen.lakes.begin(), chosen.lakes.end());
  chosen.lakes.erase(std::unique(chosen.lakes.begin(), chosen.lakes.end()), chosen.lakes.end());
  patch.each_curve(box, [&](const Curve& c) { chosen.curves.push_back(&c); });
  return chosen;
}

}  // namespace

void base_rows(const Patch& patch, const Samples& samples, const BaseRows& rows) {
  HWY_DYNAMIC_DISPATCH(base_on_target)(patch, samples, choose(patch, samples), rows);
}
HeightRange range_of(const Patch& patch, const Box& box, bool guided) {
  HeightRange range{1e30F, -1e30F};
  const Box read = read_for(box, guided);
  patch.each_spot(read, [&](const Spot& s) {
    range.lowest_m = std::min(range.lowest_m, s.height_m - s.depth_m);
    range.highest_m = std::max(range.highest_m, s.height_m);
  });
  patch.each_curve(read, [&](const Curve& c) {
    const float deep = channel_depth_m(std::max(c.width0_m, c.width1_m));
    range.lowest_m = std::min(range.lowest_m, c.height_m[2] - deep);
    range.highest_m = std::max(range.highest_m, c.height_m[0] + 0.3F);
  });
  // Cubic interpolation leaves the range of its points by up to a quarter.
  const float more = guided ? 0.25F * (range.highest_m - range.lowest_m) : 0;
  return {range.lowest_m - more, range.highest_m + more};
}
void carve_rows(const Patch& patch, const Samples& samples, const CarvedRows& rows) {
  HWY_DYNAMIC_DISPATCH(carve_on_target)(patch, samples, choose(patch, samples), rows);
}
void ground_rows(const Patch& patch, const Samples& samples, CarvedRows rows) {
  HWY_DYNAMIC_DISPATCH(ground_on_target)(patch, samples, choose(patch, samples), rows);
}

}  // namespace psygen::models::network
#endif
