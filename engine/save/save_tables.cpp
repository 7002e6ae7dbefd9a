#include "engine/save/save_tables.hpp"

#include <fmt/format.h>

#include <type_traits>

#include "engine/core/hash.hpp"
#include "engine/core/utf8.hpp"
#include "engine/save/save_file.hpp"

namespace psygen::save {
namespace {

std::int64_t checksum_of(core::BlockCoord block, std::uint32_t version,
                         std::span<const std::byte> bytes) {
  const std::uint64_t place = core::BlockCoordHash{}(block);
  return static_cast<std::int64_t>(core::hash_bytes(bytes, core::combine(place, version)));
}

std::int64_t checksum_of(std::string_view name, const Value& value) {
  const std::uint64_t seed =
      core::combine(core::hash_bytes(std::as_bytes(std::span(name))), value.index());
  const auto hash = [&](const auto& content) -> std::uint64_t {
    using Content = std::decay_t<decltype(content)>;
    if constexpr (std::is_same_v<Content, std::string> || std::is_same_v<Content, Bytes>) {
      return core::hash_bytes(std::as_bytes(std::span(content)), seed);
    } else {
      return core::hash_bytes(std::as_bytes(std::span(&content, 1)), seed);
    }
  };
  return static_cast<std::int64_t>(std::visit(hash, value));
}

// Resets a statement at the end of a scope.
class Reset {
 public:
  explicit Reset(Statement& statement) : statement_(statement) {}
  ~Reset() { statement_.reset(); }
  Reset(const Reset&) = delete;
  Reset& operator=(const Reset&) = delete;

 private:
  Statement& statement_;
};

}  // namespace

SaveTables::~SaveTables() {
  for (Statement* s : {&put_edits_, &erase_edits_, &get_edits_, &each_edits_, &put_value_,
                       &erase_value_, &get_value_, &put_fact_, &get_fact_})
    *s = Statement();
  close_file(database_);
}

core::Result<void> SaveTables::prepare() {
  const std::pair<Statement*, const char*> all[] = {
      {&put_edits_, "INSERT OR REPLACE INTO psygen_edits VALUES(?, ?, ?, ?, ?)"},
      {&erase_edits_, "DELETE FROM psygen_edits WHERE x = ? AND z = ?"},
      {&get_edits_, "SELECT version, checksum, bytes FROM psygen_edits WHERE x = ? AND z = ?"},
      {&each_edits_, "SELECT version, checksum, bytes, x, z FROM psygen_edits"},
      {&put_value_, "INSERT OR REPLACE INTO psygen_values VALUES(?, ?, ?)"},
      {&erase_value_, "DELETE FROM psygen_values WHERE name = ?"},
      {&get_value_, "SELECT checksum, value FROM psygen_values WHERE name = ?"},
      {&put_fact_, "INSERT OR REPLACE INTO psygen_facts VALUES(?, ?)"},
      {&get_fact_, "SELECT value FROM psygen_facts WHERE name = ?"}};
  for (const auto& [statement, sql] : all) {
    auto prepared = database_.prepare(sql, "cannot be read");
    if (!prepared) return tl::unexpected(prepared.error());
    *statement = std::move(*prepared);
  }
  return {};
}

// Runs a statement without rows.
core::Result<void> SaveTables::finish(Statement& statement) {
  const int code = statement.step();
  core::Result<void> result;
  if (code != SQLITE_DONE) result = database_.error("cannot be saved");
  statement.reset();
  return result;
}

tl::unexpected<core::Error> SaveTables::damaged(std::string_view what) const {
  return core::fail(core::ErrorCode::kParse,
                    fmt::format("{}: {}; the file is damaged", database_.file().string(), what));
}

// Checks a row that begins with version, checksum and bytes.
core::Result<void> SaveTables::check_row(const Statement& row, core::BlockCoord block) const {
  const std::int64_t version = row.integer(0);
  const auto bytes = row.bytes(2);
  if (version >= 0 && version <= UINT32_MAX && bytes.size() <= kMaxEditBytes &&
      checksum_of(block, static_cast<std::uint32_t>(version), bytes) == row.integer(1))
    return {};
  return damaged(
      fmt::format("the edits of block ({}, {}) do not match their checksum", block.x, block.z));
}

core::Result<std::optional<BlockEdits>> SaveTables::edits(core::BlockCoord block) {
  const Reset reset(get_edits_);
  get_edits_.bind(1, std::int64_t{block.x});
  get_edits_.bind(2, std::int64_t{block.z});
  const int code = get_edits_.step();
  if (code == SQLITE_DONE) return std::optional<BlockEdits>();
  if (code != SQLITE_ROW) return database_.error("cannot be read");
  if (auto ok = check_row(get_edits_, block); !ok) return tl::unexpected(ok.error());
  const auto bytes = get_edits_.bytes(2);
  return BlockEdits{static_cast<std::uint32_t>(get_edits_.integer(0)),
                    Bytes(bytes.begin(), bytes.end())};
}

core::Result<void> SaveTables::for_each_edits(const EditVisitor& visit) {
  const Reset reset(each_edits_);
  int code = each_edits_.step();
  for (; code == SQLITE_ROW; code = each_edits_.step()) {
    const std::int64_t x = each_edits_.integer(3), z = each_edits_.integer(4);
    const core::BlockCoord block{static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
    if (x != block.x || z != block.z) return damaged("has edits outside of any block");
    if (auto ok = check_row(each_edits_, block); !ok) return ok;
    visit(block, static_cast<std::uint32_t>(each_edits_.integer(0)), each_edits_.bytes(2));
  }
  if (code != SQLITE_DONE) return database_.error("cannot be read");
  return {};
}

core::Result<Value> SaveTables::value(std::string_view name) {
  const Reset reset(get_value_);
  get_value_.bind(1, name);
  const int code = get_value_.step();
  if (code == SQLITE_DONE) return Value();
  if (code != SQLITE_ROW) return database_.error("cannot be read");
  Value found = get_value_.value(1);
  if (checksum_of(name, found) != get_value_.integer(0))
    return damaged(fmt::format("the value '{}' does not match its checksum", core::shown(name)));
  return found;
}

core::Result<bool> SaveTables::with_fact(
    std::string_view name,
    const std::function<core::Result<bool>(std::span<const std::byte>)>& use) {
  const Reset reset(get_fact_);
  get_fact_.bind(1, name);
  const int code = get_fact_.step();
  if (code == SQLITE_DONE) return false;
  if (code != SQLITE_ROW) return database_.error("cannot be read");
  if (!get_fact_.is(0, SQLITE_BLOB)) return damaged(fmt::format("the {} are not bytes", name));
  return use(get_fact_.bytes(0));
}

core::Result<void> SaveTables::put_edits(core::BlockCoord block,
                                         const std::optional<BlockEdits>& edits) {
  Statement& statement = edits ? put_edits_ : erase_edits_;
  statement.bind(1, std::int64_t{block.x});
  statement.bind(2, std::int64_t{block.z});
  if (edits) {
    statement.bind(3, std::int64_t{edits->version});
    statement.bind(4, checksum_of(block, edits->version, edits->bytes));
    statement.bind(5, std::span<const std::byte>(edits->bytes));
  }
  return finish(statement);
}

core::Result<void> SaveTables::put_value(std::string_view name, const Value& value) {
  const bool erased = std::holds_alternative<std::monostate>(value);
  Statement& statement = erased ? erase_value_ : put_value_;
  statement.bind(1, name);
  if (!erased) {
    statement.bind(2, checksum_of(name, value));
    statement.bind(3, value);
  }
  return finish(statement);
}

core::Result<void> SaveTables::put_fact(std::string_view name, std::span<const std::byte> bytes) {
  put_fact_.bind(1, name);
  put_fact_.bind(2, bytes);
  return finish(put_fact_);
}

}  // namespace psygen::save
