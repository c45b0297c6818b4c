// One row of blocks times a vector, in the ways that it is done.
#include <delassus/rows/block_row.hpp>

#include "catch.hpp"

#include <cmath>
#include <random>
#include <vector>

namespace block_row_tests {

using namespace delassus;

// Sums of at most 3 · 13 + 1 products, each of them and each sum rounded once: 80 ε of the sum of their sizes.
TEST_CASE("a row of 3 x 3 blocks is the sum of its products, and its first entry that of the first rows") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (Index count = 0; count <= 13; ++count) {
    std::vector<Mat3> W(count);
    std::vector<Vec3> x(20);
    std::vector<Index> column(count);
    for (auto& block : W)
      for (int k = 0; k < 9; ++k) block.data()[k] = draw(random);
    for (auto& v : x)
      for (int k = 0; k < 3; ++k) v[k] = draw(random);
    for (Index e = 0; e < count; ++e) column[e] = (7 * e + 3) % 20;
    Vec3 start, size;
    for (int k = 0; k < 3; ++k) start[k] = draw(random);
    Vec3 expected = start;
    size = start.cwiseAbs();
    for (Index e = 0; e < count; ++e)
      for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 3; ++k) {
          expected[row] += W[e](row, k) * x[column[e]][k];
          size[row] += std::abs(W[e](row, k) * x[column[e]][k]);
        }
    Vec3 r = start;
    inner::add_row<3>(r.data(), 0, count, W.empty() ? nullptr : W[0].data(), column.data(), x[0].data());
    for (int row = 0; row < 3; ++row) REQUIRE(std::abs(r[row] - expected[row]) <= 80 * 2.3e-16 * size[row]);
    const double first = start[0] + inner::first_of_row(0, count, W.empty() ? nullptr : W[0].data(), column.data(), x[0].data());
    REQUIRE(std::abs(first - expected[0]) <= 80 * 2.3e-16 * size[0]);
  }
}

}  // namespace block_row_tests
