#include "engine/synthesis/synthesise.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>

#include "engine/core/out_of_memory.hpp"
#include "engine/core/rounding.hpp"

namespace psygen::synthesis {
namespace {
std::string named(const models::ModelType& type, int level, std::string_view what) {
  return fmt::format("{} level {}{}", type.name(), level, what);
}

// Without memory, even the error message may fail to allocate.
template <class Sentence>
SynthesisOutcome failed(const Sentence& sentence) noexcept {
  SynthesisOutcome outcome;
  try {
    outcome.error = sentence();
  } catch (...) {
  }
  return outcome;
}
}  // namespace

SynthesisOutcome synthesise_guarded(const models::ModelType& type, const models::Parameters& p,
                                    int level, const models::MeshView& out) {
  const core::RoundToNearest rounding;
  try {  // model types of users may throw; the engine's own do so only without memory
    const core::Bounds tight = type.synthesise(p, level, out);
    if (core::is_box(tight)) return {true, tight, {}};
    return {false, {}, named(type, level, " returned invalid bounds")};
  } catch (const std::bad_alloc&) {
    SynthesisOutcome outcome = failed([&] { return core::out_of_memory(named(type, level, "")); });
    outcome.out_of_memory = true;
    return outcome;
  } catch (const std::exception& e) {
    return failed([&] { return named(type, level, fmt::format(" threw: {}", e.what())); });
  } catch (...) {
    return failed(
        [&] { return named(type, level, " threw an object that is not a std::exception"); });
  }
}

core::Result<models::MeshSize> mesh_size_guarded(const models::ModelType& type,
                                                 const models::Parameters& p, int level,
                                                 const std::optional<models::MeshSize>& known) {
  const core::RoundToNearest rounding;
  models::MeshSize size;
  try {
    size = known ? *known : type.mesh_size(p, level);
  } catch (...) {
    return tl::unexpected(core::error_of_exception(core::ErrorCode::kSynthesisFailed,
                                                   named(type, level, ""), "threw in mesh_size()"));
  }
  constexpr std::uint32_t kMaxVertices = 65536, kMaxIndices = 1u << 26;
  if (size.vertex_count <= kMaxVertices && size.index_count <= kMaxIndices) return size;
  return core::fail(
      core::ErrorCode::kOverBudget,
      named(type, level,
            fmt::format(" needs {} vertices and {} indices; the limits are {} and {}",
                        size.vertex_count, size.index_count, kMaxVertices, kMaxIndices)));
}

core::Result<HeapDestination> HeapDestination::make(const models::ModelType& type,
                                                    const models::Parameters& p, int level) {
  const auto size = mesh_size_guarded(type, p, level);
  if (!size) return tl::unexpected(size.error());
  HeapDestination d;
  d.size_ = *size;
  d.memory_.reset(new (std::nothrow) std::byte[d.size_.bytes()]);
  if (!d.memory_) {
    return core::fail(core::ErrorCode::kOutOfMemory, core::out_of_memory(named(type, level, "")));
  }
  return d;
}

models::MeshView HeapDestination::view() const {
  return models::mesh_view(memory_.get(), size_);
}

}  // namespace psygen::synthesis
