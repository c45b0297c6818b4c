// A soft bar of a metre is clamped at one end and left to its weight: the modes of a slender beam say where
// its tip is.
#include "scene_study.hpp"

#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/hexahedral_fem.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/steppers/generalized_alpha.hpp>

#include <cmath>

namespace study_program {

namespace {

constexpr double thick = 0.05, young = 1e6, density = 1000, gravity = 0.01;

/// What the bar is made of, an axis of the study: `along` × `across` × `across` cells.
struct Tetrahedra {
  using Set = TetrahedralFem<Corotational>;
  Index along, across;
  auto mesh() const { return box_mesh({1, thick, thick}, {along, across, across}); }
  std::string code() const {
    return "Tetrahedra{" + std::to_string(along) + ", " + std::to_string(across) + "}";
  }
};
struct Hexahedra {
  using Set = HexahedralFem<Corotational>;
  Index along, across;
  auto mesh() const { return hexahedral_box({1, thick, thick}, {along, across, across}); }
  std::string code() const {
    return "Hexahedra{" + std::to_string(along) + ", " + std::to_string(across) + "}";
  }
};

/// Where the tip is t seconds after the bar was let go level, m:
///
///   w = −Σ g φ_n(1) ∫φ_n/ω_n² (1 − cos ω_n t),   φ_n(1) = ±2,  ∫φ_n = 2 σ_n/β_n,  ω_n = β_n² √(E I/ρ A).
///
/// Shear and the section's turning, left out, are 0.2 % of it at a twentieth of thickness.
double tip_height(double t) {
  const double rate = std::sqrt(young / density) * thick / std::sqrt(12.);
  double w = 0, sign = 2;
  for (const double b : {1.87510406871196, 4.69409113297417, 7.85475743823761, 10.9955407348755}) {
    const double omega = b * b * rate;
    const double sigma = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
    w -= gravity * sign * 2 * sigma / b / (omega * omega) * (1 - std::cos(omega * t));
    sign = -sign;
  }
  return w;
}

/// The mean height of the nodes at the free end against the middle of the clamped one, m.
double height_of_tip(const auto& loop) {
  const auto& soft = loop.world().template set<0>();
  double sum = 0;
  int count = 0;
  for (const Index b : alive(soft)) {
    const Vec3 x = soft.pose(b).position;
    if (x.x() > 0.99) sum += x.z() - thick / 2, ++count;
  }
  return sum / count;
}

}  // namespace

bool soft_bar(const Options& options) {
  const auto scene = [](auto elements, auto... policies) {
    using Set = typename decltype(elements)::Set;
    AnimationLoop loop{World{Set{}}, policies...};
    auto& soft = bodies<Set>(loop.world());
    soft.gravity = {0, 0, -gravity};
    const auto bar = soft.add(
        {.mesh = elements.mesh(), .elasticity = {.young = young, .poisson = 0.3}, .density = density});
    soft.fix(bar, [](const Vec3& x) { return x.x() < 1e-9; });
    return loop;
  };
  return run_study(
      options, "soft_bar", 1e-3, scene,
      Combinations{Choices{Tetrahedra{10, 1}, Tetrahedra{20, 2}, Hexahedra{10, 1}, Hexahedra{20, 2}},
                   Choices{ImplicitEuler{}, ImplicitMidpoint{}, GeneralizedAlpha{}}},
      {.name = "Soft bar", .duration = 4, .steps = {0.2, 0.1, 0.05, 0.02, 0.01}, .outputs = 10, .repeats = 3},
      Measures{
          Compared{"height of the tip", "m", [](const auto& loop) { return height_of_tip(loop); }, tip_height}});
}

}  // namespace study_program
