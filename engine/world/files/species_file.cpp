#include "engine/world/files/species_file.hpp"

#include <fmt/format.h>

#include <iterator>

#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxTextBytes = 256;
constexpr Limits kAnyInteger{-0x1.0p63, 0x1.0p63};

// Accepts any number. find_fault() checks the range later, and reports the cost where it matters.
void read_number(TableReader& reader, std::string_view key, double& value) {
  const Member* member = reader.find(key);
  if (member == nullptr) return;
  if (member->value.kind == Node::Kind::kInteger || member->value.kind == Node::Kind::kReal)
    value = member->value.real;
  else
    reader.problem(member->value.line, key,
                   fmt::format("it must be a number, not {}", kind_name(member->value.kind)));
}

void read_colour(TableReader& reader, std::string_view key, std::array<double, 3>& value) {
  glm::vec3 colour;
  if (!reader.read(key, colour, {0, 1})) return;
  const Member* member = reader.find(key);
  for (std::size_t c = 0; c < 3; ++c)
    value[c] = member->value.items[c].real;
}

void read_kind(TableReader& reader, models::SpeciesKind& kind) {
  reader.read("symbol", kind.symbol, kMaxTextBytes, Presence::kRequired);
  reader.read("leaves", kind.leaves, kMaxTextBytes);
  reader.read("leader", kind.leader);
  models::visit_kind_numbers(kind,
                             [&](std::string_view key, double& value, const models::NumberSpec&) {
                               read_number(reader, key, value);
                             });
}

void read_rule(TableReader& reader, models::SpeciesRule& rule) {
  reader.read("from", rule.from, kMaxTextBytes, Presence::kRequired);
  reader.read("to", rule.to, kMaxTextBytes, Presence::kRequired);
  models::visit_rule_numbers(rule,
                             [&](std::string_view key, double& value, const models::NumberSpec&) {
                               read_number(reader, key, value);
                             });
}

void read_foliage(TableReader& reader, models::SpeciesFoliage& foliage) {
  reader.read("form", foliage.form, kMaxTextBytes);
  models::visit_foliage_numbers(
      foliage, [&](std::string_view key, double& value, const models::NumberSpec&) {
        read_number(reader, key, value);
      });
}

void read_colours(TableReader& reader, models::SpeciesColours& colours) {
  struct Read {
    TableReader& reader;
    void operator()(std::string_view key, std::array<double, 3>& value,
                    const models::NumberSpec&) const {
      read_colour(reader, key, value);
    }
    void operator()(std::string_view key, double& value, const models::NumberSpec&) const {
      read_number(reader, key, value);
    }
  };
  models::visit_colours(colours, Read{reader});
}

// The lines of all parts that find_fault() can report.
class Lines {
 public:
  void add(const std::string& part, std::size_t number, const Node& node) {
    entries_.push_back({part, number, &node});
  }
  // Adds a fault to the problems, with the line and the full name of its field. `path` names the
  // species.
  void report(const models::SpeciesFault& fault, const std::string& path,
              Problems& problems) const {
    for (const Entry& entry : entries_) {
      if (entry.part != fault.part || entry.number != fault.number) continue;
      int line = entry.node->line;
      for (const Member& member : entry.node->members)
        if (member.key == fault.field) line = member.value.line;
      const bool listed = fault.part == "kind" || fault.part == "rule";
      const std::string within = fault.part.empty() ? ""
                                 : listed ? fmt::format("{}[{}].", fault.part, fault.number)
                                          : fault.part + ".";
      problems.add(line, fmt::format("{}.{}{}", path, within, fault.field), fault.sentence,
                   fault.code);
      return;
    }
    problems.add(entries_.front().node->line, fmt::format("{}.{}", path, fault.part),
                 fault.sentence, fault.code);
  }

 private:
  struct Entry {
    std::string part;
    std::size_t number;
    const Node* node;
  };
  std::vector<Entry> entries_;
};

template <class Item, class Read>
void read_list(TableReader& reader, std::string_view key, std::size_t most, Problems& problems,
               Lines& lines, std::vector<Item>& items, const Read& read) {
  for (const Node* node : reader.tables(key, most)) {
    TableReader part(*node, fmt::format("{}[{}]", reader.field(key), items.size()), node->line,
                     problems);
    lines.add(std::string(key), items.size(), *node);
    read(part, items.emplace_back());
    part.finish();
  }
}

template <class Item, class Read>
void read_part(TableReader& reader, std::string_view key, Problems& problems, Lines& lines,
               Item& item, const Read& read) {
  const Member* member = reader.table(key);
  if (member == nullptr) return;
  TableReader part(member->value, reader.field(key), member->line, problems);
  lines.add(std::string(key), 0, member->value);
  read(part, item);
  part.finish();
}

models::Species read_one(const Node& node, const std::string& path, Problems& problems) {
  models::Species species;
  Lines lines;
  lines.add("", 0, node);
  TableReader reader(node, path, node.line, problems);
  reader.read("name", species.name, 64, Presence::kRequired);
  reader.read("doc", species.doc, kMaxTextBytes);
  reader.read("axiom", species.axiom, kMaxTextBytes, Presence::kRequired);
  models::visit_counts(species,
                       [&](std::string_view key, std::int64_t& value, const models::NumberSpec&) {
                         reader.read(key, value, kAnyInteger);
                       });
  models::visit_numbers(species,
                        [&](std::string_view key, double& value, const models::NumberSpec&) {
                          read_number(reader, key, value);
                        });
  read_list(reader, "kind", models::kMaxKinds, problems, lines, species.kinds, read_kind);
  read_list(reader, "rule", models::kMaxRules, problems, lines, species.rules, read_rule);
  read_part(reader, "foliage", problems, lines, species.foliage, read_foliage);
  read_part(reader, "colours", problems, lines, species.colours, read_colours);
  reader.finish();
  if (species.doc.empty()) species.doc = "a species of this world";
  if (problems.any()) return species;
  if (const auto fault = models::find_fault(species)) lines.report(*fault, path, problems);
  return species;
}

}  // namespace

std::vector<models::Species> read_species(TableReader& root, Problems& problems) {
  std::vector<models::Species> species;
  for (const Node* node : root.tables("species", kMaxSpecies))
    species.push_back(read_one(*node, fmt::format("species[{}]", species.size()), problems));
  return species;
}

namespace {

using Text = std::back_insert_iterator<std::string>;

// A TOML string. Names and letters of valid species need no escapes, but user texts may.
struct NumberWriter {
  Text out;
  void operator()(std::string_view key, double value, const models::NumberSpec&) const {
    fmt::format_to(out, "{} = {}\n", key, value);
  }
  void operator()(std::string_view key, const std::array<double, 3>& colour,
                  const models::NumberSpec&) const {
    fmt::format_to(out, "{} = {}\n", key, toml_vector(colour));
  }
};

}  // namespace

void write_species(const std::vector<models::Species>& species, std::string& text) {
  const Text out(text);
  for (const models::Species& s : species) {
    fmt::format_to(out,
                   "\n[[species]]\nname = {}\ndoc = {}\naxiom = {}\niterations = {}\nbranches = "
                   "{}\nspread = {}\n",
                   toml_string(s.name), toml_string(s.doc), toml_string(s.axiom), s.iterations,
                   s.branches, s.spread);
    models::visit_numbers(s, NumberWriter{out});
    for (const models::SpeciesKind& kind : s.kinds) {
      fmt::format_to(out, "\n[[species.kind]]\nsymbol = {}\nleader = {}\nleaves = {}\n",
                     toml_string(kind.symbol), kind.leader, toml_string(kind.leaves));
      models::visit_kind_numbers(kind, NumberWriter{out});
    }
    for (const models::SpeciesRule& rule : s.rules)
      fmt::format_to(out, "\n[[species.rule]]\nfrom = {}\nto = {}\nprobability = {}\n",
                     toml_string(rule.from), toml_string(rule.to), rule.probability);
    fmt::format_to(out, "\n[species.foliage]\nform = {}\n", toml_string(s.foliage.form));
    models::visit_foliage_numbers(s.foliage, NumberWriter{out});
    fmt::format_to(out, "\n[species.colours]\n");
    models::visit_colours(s.colours, NumberWriter{out});
  }
}

}  // namespace psygen::world
