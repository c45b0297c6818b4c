/// Friction and restitution by material and by pair of materials.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/known_materials.hpp>

#include <algorithm>
#include <optional>

namespace delassus {

/// What a surface is made of. Friction μ ≥ 0, restitution e in [0, 1].
struct Material {
  double friction = 0.5;  ///< μ
  double restitution = 0;  ///< e
};

/// Numbers of materials, 0 being "none said". The combination rule of two materials is
///
///   μ = √(μ_a μ_b),   e = max(e_a, e_b).
///
/// An entry for the pair comes before it, and a pair with a 0 in it keeps the law's own parameters.
class Materials {
 public:
  /// Returns its number, from 1. Throws for μ < 0 and for e outside [0, 1].
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
    const auto [low, high] = std::minmax(a, b);
    for (Pair& p : pairs_)
      if (p.a == low && p.b == high) {
        p.material = material;
        return;
      }
    pairs_.push_back({low, high, material});
  }

  /// What holds between two materials, or nothing when the law's own parameters do.
  std::optional<Material> between(Index a, Index b) const {
    const auto [low, high] = std::minmax(a, b);
    for (const Pair& p : pairs_)
      if (p.a == low && p.b == high) return p.material;
    if (low <= 0 || high > count()) return {};
    const Material &x = materials_[low - 1], &y = materials_[high - 1];
    return Material{std::sqrt(x.friction * y.friction), std::max(x.restitution, y.restitution)};
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
  }

  Array<Material> materials_;
  Array<Pair> pairs_;
};

}  // namespace delassus
