#include "ecs/table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace psygen::ecs::detail {
namespace {

constexpr std::size_t kMaxRows = 100000;

// A table with one column of integers, in which row r holds r.
class Numbers {
 public:
  explicit Numbers(std::uint32_t rows) {
    Signature signature;
    signature.insert(3);
    std::vector<Column> columns;
    columns.push_back({&kComponentInfo<int>, 3, ReservedMemory(kMaxRows * sizeof(int))});
    table_ = std::make_unique<Table>(1, signature, std::move(columns), kMaxRows);
    table_->reserve_more(rows);
    table_->name_rows(rows, directory_);
    table_->construct_new_rows(rows, {});
    table_->add_rows(rows);
    std::iota(values().begin(), values().end(), 0);
  }
  Table& table() { return *table_; }
  std::span<int> values() { return {rows_of<int>(table_->column_data(3)), table_->rows()}; }

 private:
  RowDirectory directory_;
  std::unique_ptr<Table> table_;
};

TEST(Table, ClosingHolesKeepsTheOtherRowsAndMovesOnlyRowsFromTheEnd) {
  std::mt19937 random(11);
  for (std::uint32_t rows = 1; rows < 300; rows += 7) {
    for (const std::uint32_t leaving_count : {1U, rows / 3 + 1, rows}) {
      Numbers numbers(rows);
      std::vector<std::uint32_t> order(rows);
      std::iota(order.begin(), order.end(), 0U);
      std::ranges::shuffle(order, random);
      const auto leaving = std::span(order).first(leaving_count);
      std::vector<int> expected(order.begin() + leaving_count, order.end());

      std::vector<RowMove> moves;
      numbers.table().close_holes(leaving, moves);
      std::vector<int> left(numbers.values().begin(), numbers.values().end());
      std::ranges::sort(left);
      std::ranges::sort(expected);
      ASSERT_EQ(left, expected);
      for (const RowMove& move : moves) {
        ASSERT_LT(move.to, rows - leaving_count);
        ASSERT_GE(move.from, rows - leaving_count);
      }
    }
  }
}

TEST(Table, ReusedRowsAreInitialisedAgain) {
  Numbers numbers(100);
  std::vector<std::uint32_t> all(100);
  std::iota(all.begin(), all.end(), 0U);
  std::vector<RowMove> moves;
  numbers.table().close_holes(all, moves);
  EXPECT_TRUE(moves.empty());
  numbers.table().construct_new_rows(50, {});
  numbers.table().add_rows(50);
  EXPECT_EQ(std::ranges::count(numbers.values(), 0), 50);
}

TEST(Table, AbsentComponentsHaveNoColumn) {
  Numbers numbers(1);
  EXPECT_NE(numbers.table().column_data(3), nullptr);
  EXPECT_EQ(numbers.table().column_data(2), nullptr);
}

}  // namespace
}  // namespace psygen::ecs::detail
