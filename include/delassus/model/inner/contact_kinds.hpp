/// Who meets whom by the types and affinities of shapes and by contact pairs, as groups and masks of bodies.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/model/model.hpp>

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace delassus::inner {

/// What of a shape decides whom it meets.
struct MeetingShape {
  unsigned type = 1, affinity = 1;
  Index geometry = -1;  ///< where a contact pair names it that types and affinities would part
  friend auto operator<=>(const MeetingShape&, const MeetingShape&) = default;
};
/// Those of a body, ascending, each once.
using ContactKind = std::vector<MeetingShape>;

/// Whether a contact pair names a geometry.
inline bool is_paired(const Model& model, Index geometry) {
  return std::any_of(model.pairs.begin(), model.pairs.end(),
                     [&](const model::Pair& p) { return p.geometry == geometry || p.other == geometry; });
}
inline bool do_meet(const model::Geometry& a, const model::Geometry& b) {
  return (a.type & b.affinity) != 0 || (b.type & a.affinity) != 0;
}
/// Whether one names it with a geometry that it would pass.
inline bool is_paired_against_type(const Model& model, Index geometry) {
  const auto at = [&](Index g) -> const model::Geometry& { return model.geometries[std::size_t(g)]; };
  return std::any_of(model.pairs.begin(), model.pairs.end(), [&](const model::Pair& p) {
    return (p.geometry == geometry || p.other == geometry) && !do_meet(at(p.geometry), at(p.other));
  });
}
/// The contact pair of two geometries; null where there is none.
inline const model::Pair* pair_of(const Model& model, Index a, Index b) {
  for (const model::Pair& p : model.pairs)
    if ((p.geometry == a && p.other == b) || (p.geometry == b && p.other == a)) return &p;
  return nullptr;
}

inline ContactKind contact_kind(const Model& model, const std::vector<Index>& geometries) {
  ContactKind kind;
  for (const Index g : geometries) {
    const model::Geometry& geometry = model.geometries[std::size_t(g)];
    kind.push_back({geometry.type, geometry.affinity, is_paired_against_type(model, g) ? g : -1});
  }
  std::sort(kind.begin(), kind.end());
  kind.erase(std::unique(kind.begin(), kind.end()), kind.end());
  return kind;
}

/// One bit for each kind, and a mask of those that it meets. Bodies that are not of the model count as type 1
/// and affinity 1, which is the first kind, and theirs is the first bit.
class ContactKinds {
 public:
  explicit ContactKinds(const Model& model) : model_(model) {}

  /// Counts it, before `number`.
  void note(const ContactKind& kind) {
    if (std::find(kinds_.begin(), kinds_.end(), kind) == kinds_.end()) kinds_.push_back(kind);
  }
  /// Gives each kind a bit that no body of the set has, from the last one down.
  void number(const RigidBodies& set) {
    std::uint32_t taken = 7;  // of bodies by default, soft ones and rods
    for (Index b = 0; b < set.blocks(); ++b)
      if (set.is_alive(b)) taken |= set.group(b);
    bits_.assign(1, 1);
    std::uint32_t next = 1u << 31;
    for (std::size_t k = 1; k < kinds_.size(); ++k) {
      while (next != 0 && (next & taken) != 0) next >>= 1;
      bits_.push_back(next);
      next >>= 1;
    }
  }
  /// Gives a body of that kind its group and its mask; one without a shape keeps its own.
  void mark(RigidBody& body, const ContactKind& kind) const {
    const std::size_t k = std::size_t(std::find(kinds_.begin(), kinds_.end(), kind) - kinds_.begin());
    if (kind.empty() || k == kinds_.size() || bits_[k] == 0) return;
    body.group = bits_[k];
    body.collides_with = do_meet(kind, kinds_[0]) ? ~0u : 0;
    for (std::size_t j = 0; j < kinds_.size(); ++j) {
      if (bits_[j] == 0) continue;
      body.collides_with &= ~bits_[j];
      if (do_meet(kind, kinds_[j])) body.collides_with |= bits_[j];
    }
  }
  /// How many kinds have no bit: they meet as bodies do by default.
  std::size_t left_over() const { return std::size_t(std::count(bits_.begin(), bits_.end(), 0u)); }
  /// Whether some shape of a body meets what another of it does not.
  bool are_mixed() const {
    for (const ContactKind& a : kinds_)
      for (const ContactKind& b : kinds_)
        if (do_meet(a, b) && !do_all_meet(a, b)) return true;
    return false;
  }

 private:
  bool do_meet(const MeetingShape& a, const MeetingShape& b) const {
    return (a.type & b.affinity) != 0 || (b.type & a.affinity) != 0 ||
           (a.geometry >= 0 && b.geometry >= 0 && pair_of(model_, a.geometry, b.geometry));
  }
  bool do_meet(const ContactKind& a, const ContactKind& b) const {
    return std::any_of(a.begin(), a.end(), [&](const MeetingShape& x) {
      return std::any_of(b.begin(), b.end(), [&](const MeetingShape& y) { return do_meet(x, y); });
    });
  }
  bool do_all_meet(const ContactKind& a, const ContactKind& b) const {
    return std::all_of(a.begin(), a.end(), [&](const MeetingShape& x) {
      return std::all_of(b.begin(), b.end(), [&](const MeetingShape& y) { return do_meet(x, y); });
    });
  }

  const Model& model_;
  std::vector<ContactKind> kinds_{ContactKind{MeetingShape{}}};
  std::vector<std::uint32_t> bits_{1};
};

}  // namespace delassus::inner
