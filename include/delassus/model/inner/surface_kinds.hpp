/// Friction and restitution of single shapes, as materials of their bodies.
#pragma once

#include <delassus/constraints/contact/materials.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/model/inner/contact_kinds.hpp>
#include <delassus/model/model.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace delassus::inner {

/// What of a shape decides about the friction of its contacts.
struct SurfaceKind {
  double friction = 1, restitution = 0;
  bool slides = true;  ///< its contacts have friction
  int priority = 0;
  Index geometry = -1;  ///< where a contact pair names it

  SurfaceKind(const Model& model, Index number) : geometry(is_paired(model, number) ? number : -1) {
    const model::Geometry& g = model.geometries[std::size_t(number)];
    friction = g.friction, restitution = g.restitution, slides = g.contact_freedoms > 1,
    priority = g.priority;
  }
  friend bool operator==(const SurfaceKind&, const SurfaceKind&) = default;
};

/// The friction of their contact pair; else the numbers of the higher priority, and of equal ones the larger,
/// with friction where one of them has it. Source: the documentation of MuJoCo, on the parameters of
/// contacts.
inline Material between(const Model& model, const SurfaceKind& a, const SurfaceKind& b) {
  if (a.geometry >= 0 && b.geometry >= 0)
    if (const model::Pair* pair = pair_of(model, a.geometry, b.geometry))
      return {.friction = pair->contact_freedoms > 1 ? pair->friction : 0,
              .restitution = std::max(a.restitution, b.restitution)};
  if (a.priority != b.priority) {
    const SurfaceKind& one = a.priority > b.priority ? a : b;
    return {.friction = one.slides ? one.friction : 0, .restitution = one.restitution};
  }
  return {.friction = a.slides || b.slides ? std::max(a.friction, b.friction) : 0,
          .restitution = std::max(a.restitution, b.restitution)};
}

/// The surfaces of one model, each a material of a loop, and each pair with what holds between them.
class SurfaceKinds {
 public:
  explicit SurfaceKinds(const Model& model) : model_(model) {}

  /// Its number among the materials.
  Index number_of(Materials& materials, const SurfaceKind& kind) {
    for (std::size_t k = 0; k < kinds_.size(); ++k)
      if (kinds_[k] == kind) return numbers_[k];
    const Material own = between(model_, kind, kind);
    kinds_.push_back(kind), numbers_.push_back(materials.add(own));
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      const Material pair = between(model_, kind, kinds_[k]), other = between(model_, kinds_[k], kinds_[k]);
      const bool is_rule = pair.friction == std::sqrt(own.friction * other.friction) &&
                           pair.restitution == std::max(own.restitution, other.restitution);
      if (!is_rule) materials.set_pair(numbers_.back(), numbers_[k], pair);
    }
    return numbers_.back();
  }

 private:
  const Model& model_;
  std::vector<SurfaceKind> kinds_;
  std::vector<Index> numbers_;
};

}  // namespace delassus::inner
