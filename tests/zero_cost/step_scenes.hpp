/// What the programs that step_cost.py counts have together: the numbers of their scenes.
#pragma once

#include <delassus/math/linear.hpp>

#include <cstdio>
#include <random>

namespace step_scenes {

using namespace delassus;

constexpr double h = 1e-3;
constexpr int count = 100;

struct Draw {
  std::minstd_rand random{5};
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec3 vector() {
    const double x = (*this)(-1, 1), y = (*this)(-1, 1), z = (*this)(-1, 1);
    return {x, y, z};
  }
};

inline Mat3 moments(double m) { return m * Vec3(0.2, 0.3, 0.4).asDiagonal().toDenseMatrix(); }

/// Steps and prints one coordinate, so that the two ways can be compared and nothing is optimised away.
template <class Scene>
[[gnu::noinline]] void run(Scene&& scene, int steps) {
  for (int i = 0; i < steps; ++i) scene.step();
  std::printf("%.17g\n", scene.answer());
}

}  // namespace step_scenes
