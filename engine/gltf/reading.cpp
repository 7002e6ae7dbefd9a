#include "engine/gltf/reading.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace psygen::gltf {

using core::ErrorCode;

namespace {

template <class T>
T number_at(const std::uint8_t* at) {
  T value{};
  std::memcpy(&value, at, sizeof value);
  return value;
}

// Bytes of a component; 0 for types that glTF does not have.
std::size_t component_bytes(int component) {
  switch (component) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

void Reading::note(std::string sentence) {
  constexpr std::size_t kMaxNotes = 64;
  if (std::ranges::find(out.notes, sentence) != out.notes.end()) return;
  if (out.notes.size() == kMaxNotes - 1) sentence = "has more such features, which are not listed";
  if (out.notes.size() < kMaxNotes) out.notes.push_back(std::move(sentence));
}

tl::unexpected<core::Error> wrong(std::string sentence) {
  return core::fail(ErrorCode::kParse, std::move(sentence));
}

core::Result<std::uint32_t> index_in(int index, std::size_t count, std::string_view what) {
  if (index >= 0 && static_cast<std::size_t>(index) < count)
    return static_cast<std::uint32_t>(index);
  return wrong(fmt::format("{} is {}, but there are {}", what, index, count));
}

core::Result<void> add_within_limit(std::uint64_t& sum, std::uint64_t more, std::uint64_t most,
                                    std::string_view what) {
  if (more > most || sum > most - more) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("has more than {} {}, the limit", most, what));
  }
  sum += more;
  return {};
}

namespace {

// The first of `count` elements from `offset` on. Fails if they are not all within the view.
core::Result<const std::uint8_t*> first_of(Source::View bytes, std::uint64_t offset,
                                           std::size_t count, std::size_t stride,
                                           std::size_t element_bytes, const std::string& name) {
  const std::size_t room = bytes.size() - std::min<std::uint64_t>(offset, bytes.size());
  const std::size_t most = room < element_bytes || offset > bytes.size()
                               ? 0
                               : (room - element_bytes) / std::max<std::size_t>(stride, 1) + 1;
  if (stride < element_bytes || count > most)
    return wrong(
        fmt::format("{} has {} elements of {} bytes every {} from byte {} on, but its "
                    "bufferView has {} bytes",
                    name, count, element_bytes, stride, offset, bytes.size()));
  return bytes.data() + std::min<std::uint64_t>(offset, bytes.size());
}

// Reads the replaced elements of a sparse accessor.
core::Result<void> replace(Reading& reading, const SparseJson& sparse, std::size_t element_bytes,
                           const std::string& name, Elements& out) {
  const std::string indices = "sparse indices of " + name, values = "sparse values of " + name;
  Elements from;
  from.component = sparse.index_component, from.width = 1, from.count = sparse.count;
  if (from.component != kUnsignedByte && from.component != kUnsignedShort &&
      from.component != kUnsignedInt)
    return wrong(indices + " are not unsigned integers");
  from.stride_bytes = component_bytes(from.component);
  const auto first = reading.source.of_view(sparse.index_view, indices).and_then([&](auto bytes) {
    return first_of(bytes, sparse.index_offset, sparse.count, from.stride_bytes, from.stride_bytes,
                    indices);
  });
  if (!first) return tl::unexpected(first.error());
  const auto replacements =
      reading.source.of_view(sparse.value_view, values).and_then([&](auto bytes) {
        return first_of(bytes, sparse.value_offset, sparse.count, element_bytes, element_bytes,
                        values);
      });
  if (!replacements) return tl::unexpected(replacements.error());
  from.first = *first;
  for (std::size_t i = 0; i < from.count; ++i) {
    const std::uint32_t index = from.whole(i);
    const bool ascends = out.replaced.empty() || index > out.replaced.back();
    if (!ascends || index >= out.count)
      return wrong(fmt::format("{}: index {} is {}; they must ascend and be below {}", indices, i,
                               index, out.count));
    out.replaced.push_back(index);
  }
  out.replacements = *replacements;
  return {};
}

}  // namespace

core::Result<Elements> elements_of(Reading& reading, int accessor, std::string_view what) {
  const auto index = index_in(accessor, reading.file.accessors.size(), what);
  if (!index) return tl::unexpected(index.error());
  const AccessorJson& described = reading.file.accessors[*index];
  const std::string name = fmt::format("accessors[{}] ({})", accessor, what);
  const std::size_t part_bytes = component_bytes(described.component);
  if (part_bytes == 0)
    return wrong(fmt::format("{} has the component type {}", name, described.component));
  if (described.width == 0) return wrong(name + " has an unknown type");
  Elements elements;
  elements.component = described.component;
  elements.width = described.width;
  elements.count = described.count;
  elements.normalised = described.normalised;
  const std::size_t element_bytes = part_bytes * static_cast<std::size_t>(elements.width);
  if (described.view != kAbsent) {
    const auto bytes = reading.source.of_view(described.view, name);
    if (!bytes) return tl::unexpected(bytes.error());
    const ViewJson& view = reading.file.views[static_cast<std::size_t>(described.view)];
    const std::uint64_t packed = view.packed ? view.packed->stride : element_bytes;
    elements.stride_bytes = view.stride == 0 ? packed : view.stride;
    const auto first = first_of(*bytes, described.offset, elements.count, elements.stride_bytes,
                                element_bytes, name);
    if (!first) return tl::unexpected(first.error());
    elements.first = *first;
  }
  if (described.sparse) {
    if (auto ok = replace(reading, *described.sparse, element_bytes, name, elements); !ok)
      return tl::unexpected(ok.error());
  }
  return elements;
}

const std::uint8_t* Elements::at(std::size_t i) const {
  const auto found = std::ranges::lower_bound(replaced, i);
  if (found != replaced.end() && *found == i)
    return replacements + static_cast<std::size_t>(found - replaced.begin()) *
                              component_bytes(component) * static_cast<std::size_t>(width);
  return first != nullptr ? first + i * stride_bytes : nullptr;
}

float Elements::real(std::size_t i, int c) const {
  const std::uint8_t* at = this->at(i);
  if (at == nullptr) return 0;
  at += static_cast<std::size_t>(c) * component_bytes(component);
  const auto share = [this](float value, float most) {
    return normalised ? std::max(value / most, -1.0F) : value;
  };
  switch (component) {
    case kByte:
      return share(number_at<std::int8_t>(at), 127);
    case kUnsignedByte:
      return share(*at, 255);
    case kShort:
      return share(number_at<std::int16_t>(at), 32767);
    case kUnsignedShort:
      return share(number_at<std::uint16_t>(at), 65535);
    case kUnsignedInt:
      return static_cast<float>(number_at<std::uint32_t>(at));
    default:
      return number_at<float>(at);
  }
}

std::uint32_t Elements::whole(std::size_t i) const {
  const std::uint8_t* at = this->at(i);
  if (at == nullptr) return 0;
  switch (component) {
    case kUnsignedByte:
      return *at;
    case kUnsignedShort:
      return number_at<std::uint16_t>(at);
    default:
      return number_at<std::uint32_t>(at);
  }
}

}  // namespace psygen::gltf
