#include "engine/gltf/document.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace psygen::gltf {
namespace {

using Value = nlohmann::json;

// An object of the file and its place in it. The first value of a wrong kind is kept in `error`,
// and its default returned.
class Object {
 public:
  Object(const Value& value, std::string place, std::optional<std::string>& error)
      : value_(value), place_(std::move(place)), error_(error) {
    if (!value.is_object()) refuse("", "an object");
  }

  int index(const char* key, int missing = kAbsent) const {
    const Value* found = find(key);
    return found != nullptr ? whole<int>(*found, key, INT32_MIN, INT32_MAX) : missing;
  }
  std::uint64_t size(const char* key) const {
    const Value* found = find(key);
    return found != nullptr ? whole<std::uint64_t>(*found, key, 0, UINT64_MAX) : 0;
  }
  double number(const char* key, double missing) const {
    const Value* found = find(key);
    if (found == nullptr) return missing;
    if (found->is_number()) return found->get<double>();
    refuse(key, "a number");
    return missing;
  }
  bool flag(const char* key) const {
    const Value* found = find(key);
    if (found == nullptr) return false;
    if (found->is_boolean()) return found->get<bool>();
    refuse(key, "true or false");
    return false;
  }
  std::string text(const char* key, const char* missing = "") const {
    const Value* found = find(key);
    if (found == nullptr) return missing;
    if (found->is_string()) return found->get<std::string>();
    refuse(key, "a string");
    return missing;
  }
  std::vector<double> numbers(const char* key) const {
    std::vector<double> out;
    for (const Value& item : list(key)) {
      if (!item.is_number()) refuse(key, "a list of numbers");
      out.push_back(item.is_number() ? item.get<double>() : 0);
    }
    return out;
  }
  std::vector<int> indices(const char* key) const {
    std::vector<int> out;
    for (const Value& item : list(key))
      out.push_back(whole<int>(item, key, INT32_MIN, INT32_MAX));
    return out;
  }
  std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> out;
    for (const Value& item : list(key)) {
      if (!item.is_string()) refuse(key, "a list of strings");
      out.push_back(item.is_string() ? item.get<std::string>() : "");
    }
    return out;
  }
  AttributesJson named_indices(const char* key) const {
    AttributesJson out;
    if (const auto named = object(key)) {
      for (const auto& [name, value] : named->value_.items())
        out[name] = whole<int>(value, key, INT32_MIN, INT32_MAX);
    }
    return out;
  }
  std::optional<Object> object(const char* key) const {
    const Value* found = find(key);
    if (found == nullptr) return std::nullopt;
    Object inner(*found, place_of(key), error_);
    return found->is_object() ? std::optional(std::move(inner)) : std::nullopt;
  }
  std::optional<Object> extension(const char* name) const {
    const auto all = object("extensions");
    return all ? all->object(name) : std::nullopt;
  }
  // Calls `each` with every object of a list.
  template <class Each>
  void objects(const char* key, const Each& each) const {
    std::size_t i = 0;
    for (const Value& item : list(key)) {
      const Object one(item, fmt::format("{}[{}]", place_of(key), i++), error_);
      if (item.is_object()) each(one);
    }
  }
  bool has_items(const char* key) const { return !list(key).empty(); }
  const Value& value() const { return value_; }

 private:
  const Value* find(const char* key) const {
    if (!value_.is_object()) return nullptr;
    const auto found = value_.find(key);
    return found != value_.end() ? &*found : nullptr;
  }
  const Value& list(const char* key) const {
    static const Value kEmpty = Value::array();
    const Value* found = find(key);
    if (found == nullptr) return kEmpty;
    if (found->is_array()) return *found;
    refuse(key, "a list");
    return kEmpty;
  }
  template <class T>
  T whole(const Value& value, const char* key, T least, T most) const {
    if (value.is_number_unsigned() && std::cmp_less_equal(value.get<std::uint64_t>(), most))
      return static_cast<T>(value.get<std::uint64_t>());
    if (value.is_number_integer() && !value.is_number_unsigned() &&
        std::cmp_greater_equal(value.get<std::int64_t>(), least) &&
        std::cmp_less_equal(value.get<std::int64_t>(), most))
      return static_cast<T>(value.get<std::int64_t>());
    constexpr double kExact = 1LL << 53;
    if (value.is_number_float()) {
      const double v = value.get<double>();
      if (v == std::trunc(v) && v >= std::max(static_cast<double>(least), -kExact) &&
          v <= std::min(static_cast<double>(most), kExact))
        return static_cast<T>(v);
    }
    constexpr bool kSigned = std::is_signed_v<T>;
    refuse(key, kSigned ? "an integer" : "an integer from 0 on");
    return kSigned ? static_cast<T>(kAbsent) : T{0};
  }
  std::string place_of(const char* key) const {
    return place_.empty() ? key : fmt::format("{}.{}", place_, key);
  }
  void refuse(const char* key, const char* kind) const {
    if (error_) return;
    const std::string place = *key != '\0' ? place_of(key) : place_;
    error_ = fmt::format("is not glTF that can be read: {} must be {}",
                         place.empty() ? "its JSON" : place, kind);
  }

  const Value& value_;
  std::string place_;
  std::optional<std::string>& error_;
};

ViewJson read_view(const Object& from) {
  ViewJson view{from.index("buffer"), from.size("byteOffset"), from.size("byteLength"),
                from.size("byteStride"), std::nullopt};
  if (const auto packed = from.extension("EXT_meshopt_compression"))
    view.packed = {.buffer = packed->index("buffer"),
                   .offset = packed->size("byteOffset"),
                   .bytes = packed->size("byteLength"),
                   .stride = packed->size("byteStride"),
                   .count = packed->size("count"),
                   .mode = packed->text("mode"),
                   .filter = packed->text("filter", "NONE")};
  return view;
}

AccessorJson read_accessor(const Object& from) {
  static const std::map<std::string, int, std::less<>> kWidths{
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  const auto width = kWidths.find(from.text("type"));
  AccessorJson accessor{.view = from.index("bufferView"),
                        .component = from.index("componentType"),
                        .width = width != kWidths.end() ? width->second : 0,
                        .offset = from.size("byteOffset"),
                        .count = from.size("count"),
                        .normalised = from.flag("normalized"),
                        .sparse = std::nullopt};
  if (const auto sparse = from.object("sparse")) {
    accessor.sparse.emplace().count = sparse->size("count");
    if (const auto indices = sparse->object("indices")) {
      accessor.sparse->index_view = indices->index("bufferView");
      accessor.sparse->index_offset = indices->size("byteOffset");
      accessor.sparse->index_component = indices->index("componentType");
    }
    if (const auto values = sparse->object("values")) {
      accessor.sparse->value_view = values->index("bufferView");
      accessor.sparse->value_offset = values->size("byteOffset");
    }
  }
  return accessor;
}

TextureJson read_texture(const Object& from) {
  TextureJson texture{from.index("source"), kAbsent, from.index("sampler"), ""};
  if (const auto all = from.object("extensions")) {
    for (const auto& [name, value] : all->value().items())
      if (name != "EXT_texture_webp") texture.other_extension = name;
  }
  if (const auto webp = from.extension("EXT_texture_webp")) texture.webp = webp->index("source");
  return texture;
}

TextureUseJson read_use(const std::optional<Object>& from) {
  TextureUseJson use;
  if (!from) return use;
  use.texture = from->index("index");
  use.set = from->index("texCoord", 0);
  use.strength = from->number("scale", 1);
  if (const auto transform = from->extension("KHR_texture_transform")) {
    use.set = transform->index("texCoord", use.set);
    use.offset = transform->numbers("offset");
    use.scale = transform->numbers("scale");
    use.rotation = transform->number("rotation", 0);
  }
  return use;
}

MaterialJson read_material(const Object& from) {
  MaterialJson material;
  material.name = from.text("name");
  material.alpha_mode = from.text("alphaMode", "OPAQUE");
  material.alpha_cutoff = from.number("alphaCutoff", 0.5);
  material.emissive = from.numbers("emissiveFactor");
  material.two_sided = from.flag("doubleSided");
  material.normal = read_use(from.object("normalTexture"));
  material.light = read_use(from.object("emissiveTexture"));
  if (const auto glow = from.extension("KHR_materials_emissive_strength"))
    material.emissive_strength = glow->number("emissiveStrength", 1);
  // It stands for the core's values, which are for programs without it.
  if (const auto gloss = from.extension("KHR_materials_pbrSpecularGlossiness")) {
    material.base_colour = gloss->numbers("diffuseFactor");
    material.base = read_use(gloss->object("diffuseTexture"));
  } else if (const auto metal = from.object("pbrMetallicRoughness")) {
    material.base_colour = metal->numbers("baseColorFactor");
    material.base = read_use(metal->object("baseColorTexture"));
  }
  return material;
}

PrimitiveJson read_primitive(const Object& from) {
  PrimitiveJson primitive{.attributes = from.named_indices("attributes"),
                          .indices = from.index("indices"),
                          .material = from.index("material"),
                          .mode = from.index("mode", kTriangles),
                          .morphs = from.has_items("targets"),
                          .draco = std::nullopt};
  if (const auto draco = from.extension("KHR_draco_mesh_compression"))
    primitive.draco = {draco->index("bufferView"), draco->named_indices("attributes")};
  return primitive;
}

NodeJson read_node(const Object& from) {
  return {.name = from.text("name"),
          .mesh = from.index("mesh"),
          .skin = from.index("skin"),
          .children = from.indices("children"),
          .matrix = from.numbers("matrix"),
          .translation = from.numbers("translation"),
          .rotation = from.numbers("rotation"),
          .scale = from.numbers("scale")};
}

AnimationJson read_animation(const Object& from) {
  AnimationJson animation{from.text("name"), {}, {}};
  from.objects("channels", [&](const Object& one) {
    ChannelJson& channel = animation.channels.emplace_back();
    channel.sampler = one.index("sampler");
    const auto target = one.object("target");
    if (!target) return;
    channel.node = target->index("node");
    channel.path = target->text("path");
    channel.is_pointer = target->extension("KHR_animation_pointer").has_value();
  });
  from.objects("samplers", [&](const Object& one) {
    animation.samplers.push_back(
        {one.index("input"), one.index("output"), one.text("interpolation", "LINEAR")});
  });
  return animation;
}

template <class T, class Read>
void read_list(const Object& root, const char* key, std::vector<T>& out, const Read& read) {
  root.objects(key, [&](const Object& one) { out.push_back(read(one)); });
}

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

core::Result<Document> parse_document(std::string_view text) {
  const Value parsed = Value::parse(text);
  std::optional<std::string> error;
  const Object root(parsed, "", error);
  Document out;
  if (const auto asset = root.object("asset")) {
    out.version = asset->text("version");
    out.min_version = asset->text("minVersion");
  } else if (!error) {
    error = "is not glTF that can be read: it has no \"asset\"";
  }
  if (!error && !out.version.starts_with("2.")) return out;
  out.extensions_used = root.texts("extensionsUsed");
  out.extensions_required = root.texts("extensionsRequired");
  out.scene = root.index("scene");
  read_list(root, "buffers", out.buffers, [](const Object& one) {
    return BufferJson{one.text("uri"), one.size("byteLength")};
  });
  read_list(root, "bufferViews", out.views, read_view);
  read_list(root, "accessors", out.accessors, read_accessor);
  read_list(root, "images", out.images, [](const Object& one) {
    return ImageJson{one.text("uri"), one.index("bufferView")};
  });
  read_list(root, "textures", out.textures, read_texture);
  read_list(root, "samplers", out.samplers, [](const Object& one) {
    constexpr int kRepeat = 10497;
    return one.index("wrapS", kRepeat) == kRepeat && one.index("wrapT", kRepeat) == kRepeat;
  });
  read_list(root, "materials", out.materials, read_material);
  read_list(root, "meshes", out.meshes, [](const Object& one) {
    MeshJson mesh{one.text("name"), {}};
    read_list(one, "primitives", mesh.primitives, read_primitive);
    return mesh;
  });
  read_list(root, "nodes", out.nodes, read_node);
  read_list(root, "scenes", out.scenes, [](const Object& one) { return one.indices("nodes"); });
  read_list(root, "animations", out.animations, read_animation);
  if (error) return core::fail(core::ErrorCode::kParse, *std::move(error));
  return out;
}

std::optional<core::Result<std::vector<std::uint8_t>>> data_of(std::string_view uri) {
  if (!uri.starts_with("data:")) return std::nullopt;
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  const auto refused = [] {
    return core::fail(core::ErrorCode::kParse, "its \"data:\" URI is not base64");
  };
  if (mark == std::string_view::npos) return refused();
  std::vector<std::uint8_t> out;
  out.reserve((uri.size() - mark) / 4 * 3);
  std::uint32_t bits = 0;
  int held = 0;  // bits that no byte has yet
  std::string_view rest = uri.substr(mark + kMark.size());
  while (rest.ends_with('='))
    rest.remove_suffix(1);
  for (const char c : rest) {
    const int six = sextet(c);
    if (six < 0) return refused();
    bits = bits << 6 | static_cast<std::uint32_t>(six);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out.push_back(static_cast<std::uint8_t>(bits >> held));
  }
  return out;
}

std::string plain_uri(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex(uri[i + 2]) : -1;
    out += low >= 0 ? static_cast<char>(16 * high + low) : uri[i];
    i += low >= 0 ? 2 : 0;
  }
  return out;
}

}  // namespace psygen::gltf
