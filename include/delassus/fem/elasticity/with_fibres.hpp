/// An isotropic material with fibres in one direction, as muscle and tendon have them.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/fem/elasticity/material.hpp>

#include <string>

namespace delassus {

/// Ψ + k/8 (I₄ − 1)₊², I₄ = |F a|²: a the fibres' direction at rest, k = `fibres` times Young's modulus of M.
/// Pulled fibres resist, pressed ones do not:
///
///   P += k/2 (I₄ − 1)₊ F a aᵀ,   ∂P/∂F += a aᵀ ⊗ (k F a aᵀFᵀ + k/2 (I₄ − 1)₊ 1),
///
/// which is positive as it is. M's `pull` must be a turn. Source: docs/references.md, [Holzapfel2000] for I₄.
template <ElasticMaterial M>
struct WithFibres {
  double young = M{}.young;  ///< of M, Pa
  double poisson = M{}.poisson;  ///< ν of M
  Vec3 direction = unit_axis(0);  ///< unit, in the mesh's axes where it was put
  double fibres = 5;              ///< k/E

  void check(const std::string& who) const {
    DELASSUS_EXPECT(std::abs(direction.norm() - 1) < 1e-6,
                    who + ": the direction of its fibres is not a unit vector");
    DELASSUS_EXPECT(std::isfinite(fibres) && fibres >= 0,
                    who + ": the stiffness of its fibres, " + inner::text(fibres) +
                        " times Young's modulus, must be finite and >= 0");
  }

  /// M's answer at one F, and the fibres' share of it.
  template <class Matrix>
  struct Point {
    Matrix matrix;  ///< M's alone
    Vec3 direction;  ///< a as `pull` shows it
    Vec3 along;      ///< F a
    /// Of the fibres, Pa.
    double k, excess;  ///< (I₄ − 1)₊
    Mat3 total;  ///< P with the fibres, Pa

    /// Ψ with the fibres, J/m³.
    double energy() const { return matrix.energy() + 0.125 * k * excess * excess; }
    const Mat3& stress() const { return total; }  ///< P with the fibres, Pa
    Vec3 pull(const Vec3& gradient) const { return matrix.pull(gradient); }
    /// ∂P/∂F with the fibres, contracted with two gradients that `pull` has shown.
    Mat3 block(const Vec3& a, const Vec3& b) const {
      Mat3 B = matrix.block(a, b);
      if (!(excess > 0)) return B;
      const double share = k * direction.dot(a) * direction.dot(b);
      for (int i = 0; i < 3; ++i) {
        B(i, i) += 0.5 * share * excess;
        for (int j = 0; j < 3; ++j) B(i, j) += share * along[i] * along[j];
      }
      return B;
    }
  };
  auto at(const Mat3& F) const -> Point<decltype(M{}.at(F))> {
    const auto matrix = M{.young = young, .poisson = poisson}.at(F);
    const Vec3 along = F * direction;
    const double k = fibres * young, excess = std::fmax(along.squaredNorm() - 1, 0.0);
    Mat3 total = matrix.stress();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) total(i, j) += 0.5 * k * excess * along[i] * direction[j];
    return {matrix, matrix.pull(direction), along, k, excess, total};
  }
};

}  // namespace delassus
