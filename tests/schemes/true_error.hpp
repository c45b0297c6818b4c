// The true error of runs under error control, beside the one that was asked for.
#pragma once

#include <delassus/schemes/error_controlled.hpp>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace true_error {

/// What the steps of a run took.
struct Work {
  long steps = 0, rejections = 0, at_floor = 0;
  void add(const delassus::ErrorReport& r) { steps += r.steps, rejections += r.rejections, at_floor += r.at_floor; }
};

/// Of log y over log x.
inline double slope(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const double n = double(points.size());
  for (const auto& [a, b] : points) {
    const double u = std::log(a), v = std::log(b);
    x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// error(accuracy): the true error must follow the asked one over four decades.
inline void follows(const std::function<double(double)>& error, double least_ratio, double most_ratio) {
  std::vector<std::pair<double, double>> points;
  for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const double e = error(accuracy);
    INFO("accuracy " << accuracy << ", true error " << e);
    CHECK(e >= least_ratio * accuracy);
    CHECK(e <= most_ratio * accuracy);
    points.emplace_back(accuracy, e);
  }
  const double s = slope(points);
  INFO("slope " << s);
  CHECK(s >= 0.8);
  CHECK(s <= 1.2);
}

}  // namespace true_error
