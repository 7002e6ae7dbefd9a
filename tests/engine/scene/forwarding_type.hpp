// A model type that is like another in all but its name and how it is synthesised.
#pragma once

#include <string>

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

}  // namespace psygen::scene
