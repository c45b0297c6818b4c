/// A tree of the bodies of a world, for hosts that ask many questions between two steps.
#pragma once

#include <delassus/collision/inner/dynamic_tree.hpp>
#include <delassus/collision/queries.hpp>
#include <delassus/core/array.hpp>

#include <cstdint>
#include <vector>

namespace delassus {

/// `tree.refresh(world)` after a step, then `ray_cast(world, tree, …)`, `closest_point(world, tree, …)` and
/// `overlaps(world, tree, …)`, as often as wanted: the answers of queries.hpp to the bit, in time that grows
/// with the logarithm of the number of bodies. A body that moved, came or changed its shape since is found
/// where it was, or not at all; one that was removed is not found. Half-spaces, and shapes that a backend
/// keeps, are asked one by one.
class BodyTree : public inner::AskedBodies {
 public:
  /// Puts every body where it is now. What rests costs a look; a call without news allocates nothing.
  template <class World>
  void refresh(const World& world) {
    others_.clear();
    Index next = 0;
    world.each([&](const auto& set, auto s) {
      for (Index b = 0; b < set.blocks(); ++b, ++next) {
        if (next == Index(leaf_.size())) leaf_.emplace_back();
        place(set, Index(s), b, leaf_[next], next);
      }
    });
    for (Index l = next; l < Index(leaf_.size()); ++l) leave(leaf_[l]);
    leaf_.resize(std::size_t(next));
    tree_.balance();
  }

  /// As `EveryBody::visit`.
  template <class World, class Kept, class Meets, class F>
  void visit(const World& world, std::uint32_t groups, const Kept& kept, const Meets& meets,
             const F& f) const {
    const auto ask = [&](const Place& at) {
      world.each([&](const auto& set, auto s) {
        if (Index(s) == at.set && at.body < set.blocks()) inner::ask(set, Index(s), at.body, groups, kept, f);
      });
    };
    for (const Place& at : others_) ask(at);
    tree_.visit(meets, [&](Index l) { ask(leaf_[l].at); });
  }

 private:
  struct Place {
    Index set = 0, body = 0;
  };
  struct Leaf {
    Place at;
    Index node = -1;  ///< −1 while the body has no box
    Aabb box;
  };

  void leave(Leaf& leaf) {
    if (leaf.node >= 0) tree_.erase(leaf.node);
    leaf.node = -1;
  }

  template <class Set>
  void place(const Set& set, Index s, Index b, Leaf& leaf, Index number) {
    leaf.at = {s, b};
    if (!set.has_collider(b)) return leave(leaf);
    const Shape shape = set.shape(b);
    if (shape.is_kept() || shape.kind == ShapeKind::half_space) {
      others_.push_back(leaf.at);
      return leave(leaf);
    }
    const Pose pose = set.pose(b);
    const Aabb box = tight_box(shape, pose);
    if (!is_finite(pose.rotation) || !is_finite(Vec3(box.max() - box.min())) || box.is_empty())
      return leave(leaf);
    if (leaf.node < 0)
      leaf.node = tree_.insert(box, number);
    else if (!inner::is_same(box, leaf.box))
      tree_.move(leaf.node, box);
    leaf.box = box;
  }

  std::vector<Leaf> leaf_;
  Array<Place> others_;
  inner::DynamicTree tree_;
};

}  // namespace delassus
