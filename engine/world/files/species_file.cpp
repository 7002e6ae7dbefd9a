#include "engine/world/files/species_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxTextBytes = 256;

// Reads numbers and colours.
struct SpeciesReader {
  TableReader& reader;
  // Accepts any number. find_fault() checks the range later, and reports the cost where it matters.
  void operator()(std::string_view key, double& value, const models::NumberSpec&) const {
    const Member* member = reader.find(key);
    if (member == nullptr) return;
    const Node::Kind kind = member->value.kind;
    if (kind == Node::Kind::kInteger || kind == Node::Kind::kReal)
      value = member->value.real;
    else
      reader.problem(key, fmt::format("it must be a number, not {}", kind_name(kind)));
  }
  void operator()(std::string_view key, std::int64_t& value, const models::NumberSpec&) const {
    reader.read(key, value, {-0x1.0p63, 0x1.0p63});
  }
  void operator()(std::string_view key, std::array<double, 3>& value,
                  const models::NumberSpec&) const {
    glm::vec3 colour;
    if (reader.read(key, colour, {0, 1}))
      std::ranges::transform(reader.find(key)->value.items, value.begin(), &Node::real);
  }
};

void read_kind(TableReader& reader, models::SpeciesKind& kind) {
  reader.read("symbol", kind.symbol, kMaxTextBytes, Presence::kRequired);
  reader.read("leaves", kind.leaves, kMaxTextBytes);
  reader.read("leader", kind.leader);
  models::visit_kind_numbers(kind, SpeciesReader{reader});
}

void read_rule(TableReader& reader, models::SpeciesRule& rule) {
  reader.read("from", rule.from, kMaxTextBytes, Presence::kRequired);
  reader.read("to", rule.to, kMaxTextBytes, Presence::kRequired);
  models::visit_rule_numbers(rule, SpeciesReader{reader});
}

void read_foliage(TableReader& reader, models::SpeciesFoliage& foliage) {
  reader.read("form", foliage.form, kMaxTextBytes);
  models::visit_foliage_numbers(foliage, SpeciesReader{reader});
}

void read_colours(TableReader& reader, models::SpeciesColours& colours) {
  models::visit_colours(colours, SpeciesReader{reader});
}

// The tables of all parts that find_fault() can report.
class Parts {
 public:
  void add(const std::string& part, std::size_t number, const TableReader& reader) {
    entries_.push_back({part, number, reader});
  }
  // Adds a fault to the problems, with the line and the full name of its field.
  void report(const models::SpeciesFault& fault) const {
    for (const auto& [part, number, reader] : entries_) {
      if (part == fault.part && number == fault.number)
        return reader.problems().add(reader.node().line_of(fault.field), reader.field(fault.field),
                                     fault.sentence, fault.code);
    }
    const TableReader& species = entries_.front().reader;
    species.problems().add(species.node().line, species.field(fault.part), fault.sentence,
                           fault.code);
  }

 private:
  struct Entry {
    std::string part;
    std::size_t number;
    TableReader reader;
  };
  std::vector<Entry> entries_;
};

template <class Item, class Read>
void read_list(TableReader& reader, std::string_view key, std::size_t most, Parts& parts,
               std::vector<Item>& items, const Read& read) {
  for (TableReader& part : reader.tables(key, most)) {
    parts.add(std::string(key), items.size(), part);
    read(part, items.emplace_back());
    part.finish();
  }
}

template <class Item, class Read>
void read_part(TableReader& reader, std::string_view key, Parts& parts, Item& item,
               const Read& read) {
  std::optional<TableReader> part = reader.table(key);
  if (!part) return;
  parts.add(std::string(key), 0, *part);
  read(*part, item);
  part->finish();
}

models::Species read_one(TableReader& reader) {
  models::Species species;
  Parts parts;
  parts.add("", 0, reader);
  reader.read("name", species.name, 64, Presence::kRequired);
  reader.read("doc", species.doc, kMaxTextBytes);
  reader.read("axiom", species.axiom, kMaxTextBytes, Presence::kRequired);
  models::visit_counts(species, SpeciesReader{reader});
  models::visit_numbers(species, SpeciesReader{reader});
  read_list(reader, "kind", models::kMaxKinds, parts, species.kinds, read_kind);
  read_list(reader, "rule", models::kMaxRules, parts, species.rules, read_rule);
  read_part(reader, "foliage", parts, species.foliage, read_foliage);
  read_part(reader, "colours", parts, species.colours, read_colours);
  reader.finish();
  if (species.doc.empty()) species.doc = "a species of this world";
  if (reader.problems().any()) return species;
  if (const auto fault = models::find_fault(species)) parts.report(*fault);
  return species;
}

}  // namespace

std::vector<models::Species> read_species(TableReader& root) {
  std::vector<models::Species> species;
  for (TableReader& reader : root.tables("species", kMaxSpecies))
    species.push_back(read_one(reader));
  return species;
}

void write_species(const std::vector<models::Species>& species, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const models::Species& s : species) {
    fmt::format_to(out,
                   "\n[[species]]\nname = {}\ndoc = {}\naxiom = {}\niterations = {}\nbranches = "
                   "{}\nspread = {}\n",
                   toml_string(s.name), toml_string(s.doc), toml_string(s.axiom), s.iterations,
                   s.branches, s.spread);
    models::visit_numbers(s, FieldWriter{text});
    for (const models::SpeciesKind& kind : s.kinds) {
      fmt::format_to(out, "\n[[species.kind]]\nsymbol = {}\nleader = {}\nleaves = {}\n",
                     toml_string(kind.symbol), kind.leader, toml_string(kind.leaves));
      models::visit_kind_numbers(kind, FieldWriter{text});
    }
    for (const models::SpeciesRule& rule : s.rules)
      fmt::format_to(out, "\n[[species.rule]]\nfrom = {}\nto = {}\nprobability = {}\n",
                     toml_string(rule.from), toml_string(rule.to), rule.probability);
    fmt::format_to(out, "\n[species.foliage]\nform = {}\n", toml_string(s.foliage.form));
    models::visit_foliage_numbers(s.foliage, FieldWriter{text});
    fmt::format_to(out, "\n[species.colours]\n");
    models::visit_colours(s.colours, FieldWriter{text});
  }
}

}  // namespace psygen::world
