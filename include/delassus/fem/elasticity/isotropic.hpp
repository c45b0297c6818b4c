/// An isotropic material at one F: from its derivatives by the principal stretches to its stress and tangent.
#pragma once

#include <delassus/math/singular_values.hpp>

namespace delassus {

/// Ψ(σ₀, σ₁, σ₂) with F = U diag(σ) Vᵀ, and what follows from it. With p_i = ∂Ψ/∂σ_i, `flip[k]` and `twist[k]`
/// are the eigenvalues of ∂P/∂F for the modes that mix the two other directions i, j.
struct PrincipalState {
  double energy = 0;            ///< J/m³
  Vec3 stress = Vec3::Zero();   ///< p, Pa
  Mat3 hessian = Mat3::Zero();  ///< ∂²Ψ/∂σ∂σ, Pa
  /// (p_i − p_j)/(σ_i − σ_j), Pa.
  Vec3 flip = Vec3::Zero(), twist = Vec3::Zero();  ///< (p_i + p_j)/(σ_i + σ_j), Pa
};

/// P = U diag(p) Vᵀ, and ∂P/∂F by its modes: the three stretches, which the Hessian couples, and six that are
/// eigenvectors themselves. Each is cut at zero: the result is positive semidefinite. Sources:
/// [IrvingTeranFedkiw2004], [Smith2018].
class IsotropicPoint {
 public:
  /// Ψ and its derivatives at the stretches of F, and F's U and V.
  IsotropicPoint(const PrincipalState& state, const SingularValues& F)
      : U_(F.U), V_(F.V), energy_(state.energy), hessian_(positive_part(state.hessian)) {
    Mat3 Up = U_;
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) Up(i, k) *= state.stress[k];
      const double flip = std::max(0.0, state.flip[k]), twist = std::max(0.0, state.twist[k]);
      half_sum_[k] = (flip + twist) / 2;
      half_difference_[k] = (flip - twist) / 2;
    }
    stress_ = Up * V_.transpose();
  }

  double energy() const { return energy_; }  ///< Ψ, J/m³
  const Mat3& stress() const { return stress_; }  ///< P, Pa
  /// A gradient in the axes of the principal stretches.
  Vec3 pull(const Vec3& gradient) const { return V_.transpose() * gradient; }
  /// ∂P/∂F contracted with two of them.
  Mat3 block(const Vec3& a, const Vec3& b) const {
    Mat3 B;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) B(i, k) = hessian_(i, k) * a[i] * b[k];
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      B(i, i) += half_sum_[k] * a[j] * b[j];
      B(j, j) += half_sum_[k] * a[i] * b[i];
      B(i, j) += half_difference_[k] * a[j] * b[i];
      B(j, i) += half_difference_[k] * a[i] * b[j];
    }
    return U_ * B * U_.transpose();
  }

 private:
  Mat3 U_, V_, stress_;
  double energy_;
  Mat3 hessian_;
  Vec3 half_sum_, half_difference_;
};

}  // namespace delassus
