/// The broad phase of FCL: its dynamic tree of boxes, fed with our tight boxes.
#pragma once

#include <delassus/collision/broad_phase.hpp>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace delassus {

/// FCL takes the cube around a turned shape for its box, up to six times too many pairs; so each box of ours
/// goes in as an unturned proxy with that very box. The tree is refitted once a step. It allocates nodes when
/// the number of boxes changes, and not otherwise. A copy starts with an empty tree.
class FclTree {
 public:
  FclTree() = default;
  FclTree(const FclTree&) {}
  FclTree& operator=(const FclTree&) { return *this; }
  FclTree(FclTree&&) = default;
  FclTree& operator=(FclTree&&) = default;

  void find(std::span<const Aabb> boxes, std::vector<CandidatePair>& pairs) {
    if (proxies_.size() != boxes.size()) resize(boxes.size());
    present_.clear();
    for (Index i = 0; i < Index(boxes.size()); ++i) {
      if (boxes[i].is_empty()) continue;
      present_.push_back(i);
      place(*proxies_[i], boxes[i]);
    }
    if (!tree_ || present_ != listed_) restart();
    if (listed_.size() < 2) return;
    Query query{boxes, pairs};
    tree_->update();
    tree_->collide(&query, &FclTree::report);
  }

 private:
  using Tree = fcl::DynamicAABBTreeCollisionManagerd;
  struct Query {
    std::span<const Aabb> boxes;
    std::vector<CandidatePair>& pairs;
  };

  static bool report(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    const Query& query = *static_cast<Query*>(data);
    const Index i = index(*a), j = index(*b);
    if (query.boxes[i].intersects(query.boxes[j])) query.pairs.push_back({std::min(i, j), std::max(i, j)});
    return false;
  }

  static Index index(const fcl::CollisionObjectd& proxy) {
    return Index(reinterpret_cast<std::intptr_t>(proxy.getUserData()));
  }

  /// The proxy's box holds ours: centre ± half may round a few units of the last place inwards.
  static void place(fcl::CollisionObjectd& proxy, const Aabb& box) {
    const Vec3 centre = box.center();
    const double rounding = 4 * std::numeric_limits<double>::epsilon();
    const Vec3 half = 0.5 * box.sizes() + rounding * (box.min().cwiseAbs() + box.max().cwiseAbs());
    auto& local = const_cast<fcl::CollisionGeometryd&>(*proxy.collisionGeometry()).aabb_local;
    local.min_ = -half;
    local.max_ = half;
    proxy.setTranslation(centre);
    proxy.computeAABB();
  }

  /// The tree goes before the proxies in it.
  void resize(std::size_t count) {
    tree_.reset();
    while (proxies_.size() < count) {
      proxies_.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(1.0, 1.0, 1.0)));
      proxies_.back()->setUserData(reinterpret_cast<void*>(std::intptr_t(proxies_.size() - 1)));
    }
    proxies_.resize(count);
  }
  /// A tree of the boxes that are there now; an empty one is not.
  void restart() {
    tree_ = std::make_unique<Tree>();
    listed_ = present_;
    std::vector<fcl::CollisionObjectd*> objects;
    for (const Index i : listed_) objects.push_back(proxies_[i].get());
    if (objects.empty()) return;
    tree_->registerObjects(objects);
    tree_->setup();
  }

  std::vector<std::unique_ptr<fcl::CollisionObjectd>> proxies_;
  std::vector<Index> listed_, present_;  ///< in the tree, and in this call
  std::unique_ptr<Tree> tree_;
};
}  // namespace delassus
