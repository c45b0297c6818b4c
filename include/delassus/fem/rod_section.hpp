/// Cross-sections of rods.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>

#include <string>

namespace delassus {

/// What of a section a rod needs. y and z are the section's principal axes.
struct RodSection {
  double area = 0;      ///< A, m²
  double second_y = 0;  ///< I_y = ∫ z² dA, m⁴: bending about y
  double second_z = 0;  ///< I_z = ∫ y² dA, m⁴
  double torsion = 0;   ///< J, m⁴: moment = G J twist per length
  double shear = 1;     ///< κ: shear force = κ G A γ
};

/// A full circle, radius in m. κ here and below is Cowper's at ν = 0. Source: docs/references.md,
/// [Cowper1966].
inline RodSection round_section(double radius) {
  inner::expect_not_negative("round_section: radius", radius, "m");  // it would vanish in the even powers
  const double square = radius * radius, second = M_PI / 4 * square * square;
  return {M_PI * square, second, second, 2 * second, 6.0 / 7};
}

/// A tube, radii in m.
inline RodSection tube_section(double outer, double inside) {
  inner::expect_not_negative("tube_section: outer radius", outer, "m");
  inner::expect_not_negative("tube_section: inner radius", inside, "m");
  const double o = outer * outer, i = inside * inside, second = M_PI / 4 * (o * o - i * i);
  const double m = i / o, sum = (1 + m) * (1 + m);
  return {M_PI * (o - i), second, second, 2 * second, 6 * sum / (7 * sum + 20 * m)};
}

/// A full rectangle, its sides along y and z in m. With a ≥ b the sides,
///
///   J = a b³ (1/3 − (64/π⁵)(b/a) Σ tanh(n π a/2b)/n⁵),  n = 1, 3, 5, …
///
/// where Σ 1/n⁵ = (31/32) ζ(5) is taken whole. Source: docs/references.md, [TimoshenkoGoodier].
inline RodSection rectangular_section(double y, double z) {
  inner::expect_not_negative("rectangular_section: side along y", y, "m");
  inner::expect_not_negative("rectangular_section: side along z", z, "m");
  const double a = std::fmax(y, z), b = std::fmin(y, z);
  double sum = 31.0 / 32 * 1.0369277551433699263;
  for (int n = 1; n < 16; n += 2) sum -= (1 - std::tanh(n * M_PI * a / (2 * b))) / std::pow(n, 5);
  const double pi4 = M_PI * M_PI * M_PI * M_PI;
  return {y * z, y * z * z * z / 12, z * y * y * y / 12,
          a * b * b * b * (1.0 / 3 - 64 / (pi4 * M_PI) * (b / a) * sum), 5.0 / 6};
}

/// Refuses numbers that no section has.
inline void check_section(const RodSection& s, const std::string& who) {
  const auto is_positive = [](double x) { return std::isfinite(x) && x > 0; };
  DELASSUS_EXPECT(is_positive(s.area) && is_positive(s.second_y) && is_positive(s.second_z) &&
                      is_positive(s.torsion) && is_positive(s.shear),
                  who + ": area " + inner::text(s.area) + " m², second moments " + inner::text(s.second_y) +
                      " and " + inner::text(s.second_z) + " m⁴, torsion constant " + inner::text(s.torsion) +
                      " m⁴ and shear coefficient " + inner::text(s.shear) +
                      " of its section must be finite and > 0");
}

}  // namespace delassus
