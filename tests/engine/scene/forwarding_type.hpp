// A model type that differs from another only in its name and its synthesis.
#pragma once

#include <atomic>
#include <string>
#include <utility>

#include "engine/models/model_type.hpp"

namespace psygen::scene {

class ForwardingType : public models::ModelType {
 public:
  ForwardingType(std::string name, const models::ModelType& of) : name_(std::move(name)), of_(of) {}
  std::string_view name() const override { return name_; }
  std::string_view doc() const override { return "like another, but for its synthesis"; }
  std::span<const models::ParameterSpec> parameters() const override { return of_.parameters(); }
  int level_count() const override { return of_.level_count(); }
  double level_error_m(const models::Parameters& p, int level) const override {
    return of_.level_error_m(p, level);
  }
  core::Bounds bounds(const models::Parameters& p) const override { return of_.bounds(p); }
  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    return of_.mesh_size(p, level);
  }
  double complexity(const models::Parameters& p, int level) const override {
    return of_.complexity(p, level);
  }
  double step_seconds() const override { return of_.step_seconds(); }
  double log2_cost(const models::Parameters& p) const override { return of_.log2_cost(p); }
  void write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const override {
    of_.write_shared_indices(id, out);
  }

 protected:
  const models::ModelType& of() const { return of_; }

 private:
  std::string name_;
  const models::ModelType& of_;
};

// Counts the syntheses of its meshes, except the coarsest level, which merged meshes use too.
class CountingType final : public ForwardingType {
 public:
  CountingType(std::string name, const models::ModelType& of, std::atomic<int>& made)
      : ForwardingType(std::move(name), of), made_(made) {}
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    made_ += level + 1 < level_count_of(p);
    return of().synthesise(p, level, out);
  }
  int level_count_of(const models::Parameters& p) const override { return of().level_count_of(p); }
  double steps(const models::Parameters& p, int level) const override {
    return of().steps(p, level);
  }
  core::SurfaceKind surface() const override { return of().surface(); }
  models::Collider collider(const models::Parameters& p) const override { return of().collider(p); }
  bool may_run_on_main_thread() const override { return of().may_run_on_main_thread(); }

 private:
  std::atomic<int>& made_;
};

}  // namespace psygen::scene
