/// What the tests of the direct path share.
#pragma once

#include <delassus/delassus.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "../loop/chains.hpp"
#include "catch.hpp"
#include "cold_problems.hpp"

namespace direct_tests {

using namespace delassus;
using namespace cold_problems;
using chains::end_of;

/// Rods on ball joints, 20° from the vertical; the last has `ratio` kg more.
template <class... Policies>
auto chain(int links, double ratio, Policies... policies) {
  return chains::rods(links, ratio, EIGEN_PI / 9, policies...);
}

}  // namespace direct_tests
