// State shared by the parts of the reader: the parsed file, the limits, and access to numbers in
// its buffers. Nothing in the file is trusted. Private to engine/gltf.
#pragma once

#include <cstring>
#include <glm/mat3x2.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gltf/document.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/gltf/source.hpp"

namespace psygen::gltf {

inline constexpr std::size_t kMaxMessage = 300;  // characters of the file's text in a message

// The texture coordinates of a material: their set, and KHR_texture_transform. `repeats` is false
// if the file wants no repetition beyond 0 to 1.
struct Coordinates {
  int set = 0;
  glm::mat3x2 transform{1.0F};
  bool repeats = true;
};

struct Reading {
  const Document& file;
  const Limits& limits;
  Model& out;
  image::ImageCache& shared;
  Source& source;
  std::vector<Coordinates> coordinates = {};     // for each material
  std::vector<std::uint32_t> node_numbers = {};  // for each node of the file: in Model::nodes
  std::uint64_t vertices = 0, indices = 0, keys = 0, pixel_bytes = 0;  // sums so far

  // Adds, once, a warning about a feature that the engine does not support.
  void note(std::string sentence);
};

// An error with kParse; the message does not name the file.
tl::unexpected<core::Error> wrong(std::string sentence);
// Fails unless 0 <= index < count. `what`: "meshes[3].primitives[0].material".
core::Result<std::uint32_t> index_in(int index, std::size_t count, std::string_view what);
// Adds `more` to `sum`. Fails with kOverBudget if the result exceeds `most`.
core::Result<void> add_within_limit(std::uint64_t& sum, std::uint64_t more, std::uint64_t most,
                                    std::string_view what);

// The elements of an accessor, all within its buffer.
struct Elements {
  const std::uint8_t* first = nullptr;  // null: all are zero
  std::size_t stride_bytes = 0, count = 0;
  int component = 0, width = 0;  // type and number of the components of an element
  bool normalised = false;
  // The elements that have other values (a sparse accessor), ascending, and these values.
  std::vector<std::uint32_t> replaced = {};
  const std::uint8_t* replacements = nullptr;

  // The value of component `c` of element `i`, after normalisation.
  float real(std::size_t i, int c) const;
  std::uint32_t whole(std::size_t i) const;  // for unsigned integers

 private:
  const std::uint8_t* at(std::size_t i) const;  // null: it is zero
};
// `what` names the accessor in messages: "POSITION of meshes[0].primitives[0]".
core::Result<Elements> elements_of(Reading& reading, int accessor, std::string_view what);

// Element `i` as a vector; missing components are 0.
template <class Vector>
Vector vector_of(const Elements& elements, std::size_t i) {
  Vector v(0.0F);
  for (int c = 0; c < std::min(Vector::length(), elements.width); ++c)
    v[c] = elements.real(i, c);
  return v;
}

// The parts of the reader, in this order. Messages do not name the file.
core::Result<void> read_materials(Reading& reading);  // and images
core::Result<void> read_meshes(Reading& reading);
core::Result<void> read_nodes(Reading& reading);
core::Result<void> read_animations(Reading& reading);

}  // namespace psygen::gltf
