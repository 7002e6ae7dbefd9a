// Builds a small glTF file: JSON that a test may change, and one buffer.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace psygen::gltf {

inline constexpr int kBytes = 5121, kShorts = 5123, kInts = 5125, kFloats = 5126;

// With some compilers, nlohmann::json takes a list of one value for the value.
template <class... Values>
nlohmann::json list(const Values&... values) {
  return nlohmann::json::array({nlohmann::json(values)...});
}
// A shorthand for JSON with numbers in it.
inline nlohmann::json parsed(const std::string& text) {
  return nlohmann::json::parse(text);
}

struct Sample {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  int add(const char* kind, const nlohmann::json& value) {
    json[kind].push_back(value);
    return static_cast<int>(json[kind].size()) - 1;
  }
  int view(std::string_view bytes) {
    binary.resize((binary.size() + 3) / 4 * 4);
    const int index =
        add("bufferViews",
            {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
    binary += bytes;
    return index;
  }
  template <class T>
  int accessor(const std::vector<T>& values, const char* type, int component) {
    const auto bytes = std::as_bytes(std::span(values));
    const int at = view({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return add("accessors", {{"bufferView", at},
                             {"componentType", component},
                             {"count", values.size()},
                             {"type", type}});
  }

  // The JSON with its buffer's size. `uri` names the buffer's file if it is separate.
  std::string text(const std::string& uri = "") const {
    nlohmann::json whole = json;
    if (!binary.empty() && !whole.contains("buffers")) {
      whole["buffers"][0]["byteLength"] = binary.size();
      if (!uri.empty()) whole["buffers"][0]["uri"] = uri;
    }
    return whole.dump();
  }
  std::string glb() const {
    const auto padded = [](std::string bytes, char with) {
      bytes.resize((bytes.size() + 3) / 4 * 4, with);
      return bytes;
    };
    const std::string head = padded(text(), ' '), tail = padded(binary, '\0');
    const auto number = [](std::size_t value) {
      const auto narrow = static_cast<std::uint32_t>(value);
      std::string bytes(4, '\0');
      std::memcpy(bytes.data(), &narrow, 4);
      return bytes;
    };
    std::string body = number(head.size()) + "JSON" + head;
    if (!tail.empty()) body += number(tail.size()) + std::string("BIN\0", 4) + tail;
    return "glTF" + number(2) + number(12 + body.size()) + body;
  }
};

inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A square of two triangles that a node shows, one material with factors, and an animation that
// moves the node by x = 0, 1, 3 in 0, 1, 2 s.
inline Sample square() {
  Sample s;
  const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<glm::vec3> normals(4, glm::vec3(0, 0, 1));
  const std::vector<glm::vec2> uvs{{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  const std::vector<std::array<std::uint8_t, 4>> colours(4, {255, 0, 51, 255});
  const int position = s.accessor(positions, "VEC3", kFloats);
  const int normal = s.accessor(normals, "VEC3", kFloats);
  const int uv = s.accessor(uvs, "VEC2", kFloats);
  const int colour = s.accessor(colours, "VEC4", kBytes);
  s.json["accessors"][static_cast<std::size_t>(colour)]["normalized"] = true;
  const int indices = s.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", kShorts);
  const int times = s.accessor(std::vector<float>{0, 1, 2}, "SCALAR", kFloats);
  const int places =
      s.accessor(std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, "VEC3", kFloats);
  s.add("materials", parsed(R"({"name": "red", "emissiveFactor": [0.5, 0, 0],
      "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1]},
      "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true})"));
  nlohmann::json primitive = {{"indices", indices}, {"material", 0}};
  primitive["attributes"] = {
      {"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", colour}};
  s.add("meshes", {{"name", "square"}, {"primitives", list(primitive)}});
  s.add("nodes", parsed(R"({"name": "square", "mesh": 0})"));
  s.add("scenes", parsed(R"({"nodes": [0]})"));
  nlohmann::json slide = parsed(R"({"name": "slide", "channels":
      [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]})");
  slide["samplers"][0] = {{"input", times}, {"output", places}};
  s.add("animations", slide);
  return s;
}

}  // namespace psygen::gltf
