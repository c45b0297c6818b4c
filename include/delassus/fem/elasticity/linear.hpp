/// Hooke's law without rotations: for small turns, and to check others against.
#pragma once

#include <delassus/fem/elasticity/material.hpp>

namespace delassus {

/// Ψ = μ ε:ε + λ/2 tr²ε,  ε = sym(F) − 1. A turn of θ reads as a compression of 1 − cos θ: bodies that turn
/// swell. Its stiffness is the same everywhere, so A is factored once and again only when the step or the
/// fixed nodes change.
struct Linear {
  static constexpr bool has_constant_stiffness = true;  ///< read by soft bodies: K is made once
  double young = 1e5;  ///< Pa
  double poisson = 0.3;  ///< ν in (−1, ½)

  /// Hooke's law at one F.
  class Point {
   public:
    /// Keeps ε of F.
    Point(const Lame& lame, const Mat3& F)
        : lame_(lame), strain_(0.5 * (F + F.transpose().eval()) - Mat3::Identity().eval()) {}
    /// Ψ, J/m³.
    double energy() const {
      const double t = strain_.trace();
      double sum = 0;
      for (int k = 0; k < 9; ++k) sum += strain_.data()[k] * strain_.data()[k];
      return lame_.mu * sum + 0.5 * lame_.lambda * t * t;
    }
    /// P = 2μ ε + λ tr ε 1, Pa.
    Mat3 stress() const {
      Mat3 P = 2 * lame_.mu * strain_;
      for (int k = 0; k < 3; ++k) P(k, k) += lame_.lambda * strain_.trace();
      return P;
    }
    const Vec3& pull(const Vec3& gradient) const { return gradient; }
    /// λ a bᵀ + μ b aᵀ + μ (a·b) 1.
    Mat3 block(const Vec3& a, const Vec3& b) const {
      Mat3 B;
      const double along = lame_.mu * a.dot(b);
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          B(i, k) = lame_.lambda * a[i] * b[k] + lame_.mu * b[i] * a[k] + (i == k ? along : 0);
      return B;
    }

   private:
    Lame lame_;
    Mat3 strain_;
  };
  Point at(const Mat3& F) const { return {Lame(young, poisson), F}; }
};
static_assert(ElasticMaterial<Linear>);

}  // namespace delassus
