/// Friction, restitution and stiffness by material and by pair of materials.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/known_materials.hpp>

#include <algorithm>

namespace delassus {

/// What a surface is made of. Friction μ ≥ 0, restitution e in [0, 1]. Stiffness k ≥ 0 and damping c ≥ 0 are of each contact point,
/// under a law `Penalty{…}`; where k is 0 the law's own k and c hold.
struct Material {
  double friction = 0.5;  ///< μ
  double restitution = 0;  ///< e
  double stiffness = 0;  ///< k, N/m
  double damping = 0;    ///< c, N·s/m
};

/// Numbers of materials, 0 being "none said". The combination rule of two materials is
///
///   μ = √(μ_a μ_b),   e = max(e_a, e_b),   1/k = 1/k_a + 1/k_b,   1/c = 1/c_a + 1/c_b,
///
/// springs and dampers one behind the other; of a material without a spring the other's holds alone.
/// An entry for the pair comes before it, and a pair with a 0 in it keeps the law's own parameters.
class Materials {
 public:
  /// Returns its number, from 1. Throws for μ, k or c < 0, for e outside [0, 1], and for a damper without a spring.
  Index add(const Material& material) {
    check(material, "material");
    materials_.push_back(material);
    inner::note_materials(count());
    return count();
  }

  /// What holds between two in place of the rule. Throws for a number that was not given out.
  void set_pair(Index a, Index b, const Material& material) {
    check(material, "material pair");
    DELASSUS_EXPECT(std::min(a, b) >= 0 && std::max(a, b) <= count(),
                    "material pair: no material has this number; add it first");
    const Index low = std::min(a, b), high = std::max(a, b);
    for (Pair& p : pairs_)
      if (p.a == low && p.b == high) {
        p.material = material;
        return;
      }
    pairs_.push_back({low, high, material});
  }

  /// What holds between two materials; false, and nothing is written, where the law's own parameters do.
  bool between(Index a, Index b, Material& both) const {
    const Index low = std::min(a, b), high = std::max(a, b);
    for (const Pair& p : pairs_)
      if (p.a == low && p.b == high) {
        both = p.material;
        return true;
      }
    if (low <= 0 || high > count()) return false;
    const Material &x = materials_[low - 1], &y = materials_[high - 1];
    both = {std::sqrt(x.friction * y.friction), std::max(x.restitution, y.restitution), x.stiffness, x.damping};
    if (x.stiffness > 0 && y.stiffness > 0) {
      both.stiffness = in_series(x.stiffness, y.stiffness);
      both.damping = in_series(x.damping, y.damping);
    } else if (y.stiffness > 0) {
      both.stiffness = y.stiffness, both.damping = y.damping;
    }
    return true;
  }

  /// Without materials and pairs the laws' own numbers hold.
  bool empty() const { return materials_.empty() && pairs_.empty(); }
  /// Whether it may be said of a body: 0 may.
  bool contains(Index material) const { return material >= 0 && material <= count(); }
  /// Their numbers go from 1 to this.
  Index count() const { return Index(materials_.size()); }

  void memory(auto& archive) {
    archive(materials_, pairs_);
    inner::note_materials(count());
  }

 private:
  struct Pair {
    Index a, b;
    Material material;
  };

  static void check(const Material& m, const char* what) {
    inner::expect_not_negative(std::string(what) + ": friction", m.friction);
    inner::expect_zero_to_one(std::string(what) + ": restitution", m.restitution);
    inner::expect_not_negative(std::string(what) + ": stiffness", m.stiffness);
    inner::expect_not_negative(std::string(what) + ": damping", m.damping);
    inner::expect_number(m.stiffness > 0 || m.damping == 0, std::string(what) + ": damping", m.damping, "needs a stiffness > 0 beside it");
  }
  static double in_series(double a, double b) { return a > 0 && b > 0 ? 1 / (1 / a + 1 / b) : 0; }

  Array<Material> materials_;
  Array<Pair> pairs_;
};

}  // namespace delassus
