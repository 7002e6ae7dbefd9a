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
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

void Reading::note(std::string sentence) {
  if (std::ranges::find(out.notes, sentence) == out.notes.end())
    out.notes.push_back(std::move(sentence));
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

core::Result<std::span<const std::uint8_t>> bytes_of_view(const tinygltf::Model& file, int view,
                                                          std::string_view what) {
  const auto index = index_in(view, file.bufferViews.size(), fmt::format("bufferView of {}", what));
  if (!index) return tl::unexpected(index.error());
  const tinygltf::BufferView& described = file.bufferViews[*index];
  const auto buffer = index_in(described.buffer, file.buffers.size(),
                               fmt::format("buffer of bufferViews[{}]", view));
  if (!buffer) return tl::unexpected(buffer.error());
  const std::vector<unsigned char>& bytes = file.buffers[*buffer].data;
  if (described.byteOffset > bytes.size() ||
      described.byteLength > bytes.size() - described.byteOffset) {
    return wrong(fmt::format("bufferViews[{}] has {} bytes from {} on, but its buffer has {}", view,
                             described.byteLength, described.byteOffset, bytes.size()));
  }
  return std::span(bytes).subspan(described.byteOffset, described.byteLength);
}

core::Result<Elements> elements_of(const tinygltf::Model& file, int accessor,
                                   std::string_view what) {
  const auto index = index_in(accessor, file.accessors.size(), what);
  if (!index) return tl::unexpected(index.error());
  const tinygltf::Accessor& described = file.accessors[*index];
  const std::string name = fmt::format("accessors[{}] ({})", accessor, what);
  if (described.sparse.isSparse) {
    return core::invalid_argument(name + " is sparse; sparse accessors are not supported");
  }
  const auto bytes = bytes_of_view(file, described.bufferView, name);
  if (!bytes) return tl::unexpected(bytes.error());
  const std::size_t part_bytes = component_bytes(described.componentType);
  if (part_bytes == 0)
    return wrong(fmt::format("{} has the component type {}", name, described.componentType));
  Elements elements;
  elements.component = described.componentType;
  elements.width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(described.type));
  elements.count = described.count;
  elements.normalised = described.normalized;
  const std::size_t element_bytes = part_bytes * static_cast<std::size_t>(elements.width);
  const std::size_t stride =
      file.bufferViews[static_cast<std::size_t>(described.bufferView)].byteStride;
  elements.stride_bytes = stride == 0 ? element_bytes : stride;
  const std::size_t room = bytes->size() - std::min(described.byteOffset, bytes->size());
  const std::size_t most =
      room < element_bytes || described.byteOffset > bytes->size()
          ? 0
          : (room - element_bytes) / std::max<std::size_t>(elements.stride_bytes, 1) + 1;
  if (elements.stride_bytes < element_bytes || elements.count > most) {
    return wrong(
        fmt::format("{} has {} elements of {} bytes every {} from byte {} on, but its "
                    "bufferView has {} bytes",
                    name, elements.count, element_bytes, elements.stride_bytes,
                    described.byteOffset, bytes->size()));
  }
  elements.first = bytes->data() + std::min(described.byteOffset, bytes->size());
  return elements;
}

float Elements::real(std::size_t i, int c) const {
  const std::uint8_t* at =
      first + i * stride_bytes + static_cast<std::size_t>(c) * component_bytes(component);
  const auto share = [this](float value, float most) {
    return normalised ? std::max(value / most, -1.0F) : value;
  };
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return share(number_at<std::int8_t>(at), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return share(*at, 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return share(number_at<std::int16_t>(at), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return share(number_at<std::uint16_t>(at), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(number_at<std::uint32_t>(at));
    default:
      return number_at<float>(at);
  }
}

std::uint32_t Elements::whole(std::size_t i) const {
  const std::uint8_t* at = first + i * stride_bytes;
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *at;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return number_at<std::uint16_t>(at);
    default:
      return number_at<std::uint32_t>(at);
  }
}

}  // namespace psygen::gltf
