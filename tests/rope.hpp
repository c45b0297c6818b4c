/// A law that the library does not know.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>
#include <array>

/// A rope pulls and never pushes: φ = |x_a − x_b| − L ≤ 0, λ ≤ 0.
struct Rope {
  static constexpr int rows = 1;
  static constexpr std::array kinds{delassus::RowKind::upper};
  struct Item {
    delassus::Anchor a, b;
    double length;
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    const delassus::Vec3 a = world.point(item.a), b = world.point(item.b), e = (a - b).normalized();
    row.end(item.a, a).along(0, e);
    row.end(item.b, b).along(0, -e);
    row.phi(0, (a - b).norm() - item.length);
  }
  delassus::Vec<1> solve_local(const Item&, const delassus::Mat<1, 1>& W, const delassus::Vec<1>& b) const {
    return delassus::Vec<1>(std::min(0.0, -b[0] / W(0, 0)));
  }
};
