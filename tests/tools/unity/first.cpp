#include <array>
#include <cstddef>

int first();

namespace {

using Numbers = std::array<int, 2>;

constexpr std::array<int, 2> kValues{1000, 0};

struct Corner final {
  int x = 0;
};

int sum_of(const Numbers& numbers, std::size_t count = 2) {
  int sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += numbers[i];
  return sum;
}

}  // namespace

int first() {
  return sum_of(kValues) + Corner{}.x;
}
