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

// The checksum of kept edits also covers their world.
std::int64_t checksum_of(const KeptEdits& kept, std::span<const std::byte> parts) {
  const auto edits = checksum_of(kept.block, kept.edits.version, kept.edits.bytes);
  const std::uint64_t world = core::combine(kept.world.hash, core::hash_bytes(parts));
  return static_cast<std::int64_t>(core::combine(static_cast<std::uint64_t>(edits), world));
}

void bind_block(Statement& statement, core::BlockCoord block) {
  statement.bind(1, std::int64_t{block.x});
  statement.bind(2, std::int64_t{block.z});
}

}  // namespace

SaveTables::~SaveTables() {
  for (Statement* s :
       {&put_edits_, &erase_edits_, &get_edits_, &each_edits_, &put_value_, &erase_value_,
        &get_value_, &put_fact_, &get_fact_, &put_surface_, &erase_surface_, &erase_surfaces_,
        &get_surface_, &put_kept_, &erase_kept_, &each_kept_})
    *s = Statement();
  close_file(database_);
}

core::Result<void> SaveTables::prepare(std::initializer_list<Prepared> all) {
  for (const auto& [statement, sql] : all) {
    auto prepared = database_.prepare(sql, "cannot be read");
    if (!prepared) return tl::unexpected(prepared.error());
    statement = std::move(*prepared);
  }
  return {};
}

core::Result<void> SaveTables::prepare() {
  auto ok = prepare(
      {{put_edits_, "INSERT OR REPLACE INTO psygen_edits VALUES(?, ?, ?, ?, ?)"},
       {erase_edits_, "DELETE FROM psygen_edits WHERE x = ? AND z = ?"},
       {get_edits_, "SELECT version, checksum, bytes FROM psygen_edits WHERE x = ? AND z = ?"},
       {each_edits_, "SELECT version, checksum, bytes, x, z FROM psygen_edits"},
       {put_value_, "INSERT OR REPLACE INTO psygen_values VALUES(?, ?, ?)"},
       {erase_value_, "DELETE FROM psygen_values WHERE name = ?"},
       {get_value_, "SELECT checksum, value FROM psygen_values WHERE name = ?"},
       {put_fact_, "INSERT OR REPLACE INTO psygen_facts VALUES(?, ?)"},
       {get_fact_, "SELECT value FROM psygen_facts WHERE name = ?"}});
  return ok && format_of(database_) > 1 ? prepare_newest() : ok;
}

core::Result<void> SaveTables::prepare_newest() {
  return prepare(
      {{put_surface_, "INSERT OR REPLACE INTO psygen_surfaces VALUES(?, ?, ?)"},
       {erase_surface_, "DELETE FROM psygen_surfaces WHERE x = ? AND z = ?"},
       {erase_surfaces_, "DELETE FROM psygen_surfaces"},
       {get_surface_, "SELECT hash FROM psygen_surfaces WHERE x = ? AND z = ?"},
       {put_kept_, "INSERT INTO psygen_kept VALUES(?, ?, ?, ?, ?, ?, ?)"},
       {erase_kept_, "DELETE FROM psygen_kept"},
       {each_kept_, "SELECT x, z, world, parts, version, checksum, bytes FROM psygen_kept"}});
}

core::Result<void> SaveTables::upgrade() {
  if (format_of(database_) == kSaveFormat) return {};
  return upgrade_format(database_).and_then([&] { return prepare_newest(); });
}

core::Result<std::optional<BlockEdits>> SaveTables::edits(core::BlockCoord block) {
  const Reset reset(get_edits_);
  bind_block(get_edits_, block);
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
    const auto block = block_of(each_edits_.integer(3), each_edits_.integer(4));
    if (!block) return tl::unexpected(block.error());
    if (auto ok = check_row(each_edits_, *block); !ok) return ok;
    visit(*block, static_cast<std::uint32_t>(each_edits_.integer(0)), each_edits_.bytes(2));
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
  Value found = value_of(get_value_, 1);
  if (checksum_of(name, found) != get_value_.integer(0))
    return damaged(fmt::format("the value '{}' does not match its checksum", core::shown(name)));
  return found;
}

core::Result<Value> SaveTables::fact(std::string_view name) {
  const Reset reset(get_fact_);
  get_fact_.bind(1, name);
  const int code = get_fact_.step();
  if (code == SQLITE_DONE) return Value();
  if (code != SQLITE_ROW) return database_.error("cannot be read");
  return value_of(get_fact_, 0);
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

core::Result<std::optional<std::uint64_t>> SaveTables::surface(core::BlockCoord block) {
  using Hash = std::optional<std::uint64_t>;
  if (format_of(database_) < 2) return Hash();
  const Reset reset(get_surface_);
  bind_block(get_surface_, block);
  const int code = get_surface_.step();
  if (code == SQLITE_DONE) return Hash();
  if (code != SQLITE_ROW) return database_.error("cannot be read");
  return Hash(static_cast<std::uint64_t>(get_surface_.integer(0)));
}

core::Result<std::vector<KeptEdits>> SaveTables::kept() {
  std::vector<KeptEdits> all;
  if (format_of(database_) < 2) return all;
  const Reset reset(each_kept_);
  int code = each_kept_.step();
  for (; code == SQLITE_ROW; code = each_kept_.step()) {
    const auto block = block_of(each_kept_.integer(0), each_kept_.integer(1));
    if (!block) return tl::unexpected(block.error());
    const std::int64_t version = each_kept_.integer(4);
    const auto bytes = each_kept_.bytes(6);
    KeptEdits kept{*block,
                   {{}, static_cast<std::uint64_t>(each_kept_.integer(2)), {}},
                   {static_cast<std::uint32_t>(version), Bytes(bytes.begin(), bytes.end())}};
    const auto parts = each_kept_.bytes(3);
    auto decoded = decode_parts(parts);
    const bool sound = version >= 0 && version <= UINT32_MAX && bytes.size() <= kMaxEditBytes &&
                       checksum_of(kept, parts) == each_kept_.integer(5);
    if (!decoded || !sound)
      return damaged(fmt::format("the kept edits of block ({}, {}) do not match their checksum",
                                 block->x, block->z));
    kept.world.parts = std::move(*decoded);
    all.push_back(std::move(kept));
  }
  if (code != SQLITE_DONE) return database_.error("cannot be read");
  return all;
}

core::Result<void> SaveTables::put_edits(core::BlockCoord block,
                                         const std::optional<BlockEdits>& edits) {
  Statement& statement = edits ? put_edits_ : erase_edits_;
  bind_block(statement, block);
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
    bind_value(statement, 3, value);
  }
  return finish(statement);
}

core::Result<void> SaveTables::put_fact(std::string_view name, const Value& value) {
  put_fact_.bind(1, name);
  bind_value(put_fact_, 2, value);
  return finish(put_fact_);
}

core::Result<void> SaveTables::put_blob(std::string_view name, std::span<const std::byte> bytes) {
  put_fact_.bind(1, name);
  put_fact_.bind(2, bytes);
  return finish(put_fact_);
}

core::Result<void> SaveTables::put_surface(core::BlockCoord block,
                                           std::optional<std::uint64_t> hash) {
  Statement& statement = hash ? put_surface_ : erase_surface_;
  bind_block(statement, block);
  if (hash) statement.bind(3, static_cast<std::int64_t>(*hash));
  return finish(statement);
}

core::Result<void> SaveTables::forget_surfaces() {
  return finish(erase_surfaces_);
}

core::Result<void> SaveTables::replace_kept(const std::vector<KeptEdits>& all) {
  if (auto ok = finish(erase_kept_); !ok) return ok;
  for (const KeptEdits& kept : all) {
    const Bytes parts = encode_parts(kept.world.parts);
    bind_block(put_kept_, kept.block);
    put_kept_.bind(3, static_cast<std::int64_t>(kept.world.hash));
    put_kept_.bind(4, std::span<const std::byte>(parts));
    put_kept_.bind(5, std::int64_t{kept.edits.version});
    put_kept_.bind(6, checksum_of(kept, parts));
    put_kept_.bind(7, std::span<const std::byte>(kept.edits.bytes));
    if (auto ok = finish(put_kept_); !ok) return ok;
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

core::Result<core::BlockCoord> SaveTables::block_of(std::int64_t x, std::int64_t z) const {
  const core::BlockCoord block{static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
  if (x != block.x || z != block.z) return damaged("has edits outside of any block");
  return block;
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

}  // namespace psygen::save
