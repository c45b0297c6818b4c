/// What outlives the parts of a step that is done in several: for `Substeps`.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/loop/stages/detect.hpp>
#include <delassus/loop/stages/part_sums.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/row_system.hpp>

#include <cstddef>
#include <vector>

namespace delassus {

/// Loads act in every part, kinematic bodies arrive in the last, impulses are those of all parts together,
/// and contacts go with their bodies:
///
///   gap ← gap + h H v_next,   point ← point + h (mean of the velocities of the ends that move).
///
/// So a row that was held at u₊ + φ/h ≥ 0 stays open, and momentum is kept as within a part; a normal keeps
/// its direction until the next detection.
template <class World, class Laws, class Rows>
class StepParts : public PartSums<World, Laws> {
  using Sums = PartSums<World, Laws>;

 public:
  void begin(World& world, int count, double h_, double start_, long steps_) {
    this->h = h_, this->start = start_, this->steps = steps_;
    this->keep_loads(world);
    this->stay_on_the_way(world, count > 1);
  }
  /// Before the next part; `left` of them are to come.
  void go_on(World& world, int left) {
    this->give_loads(world);
    this->stay_on_the_way(world, left > 1);
  }

  void add_impulses(const Laws& laws, const ContactBook& book) {
    pushed_.resize(book.results.size());
    for (std::size_t i = 0; i < pushed_.size(); ++i) {
      if (this->is_first()) pushed_[i].setZero();
      pushed_[i] += book.results[i].impulse;
    }
    Sums::add_impulses(laws);
  }
  void give_impulses(Laws& laws, ContactBook& book) const {
    Sums::give_impulses(laws);
    for (std::size_t i = 0; i < pushed_.size(); ++i) book.results[i].impulse = pushed_[i];
    book.remember();
  }

  /// The contacts after a part of h seconds, before the next.
  template <class Work>
  void follow(const World& world, Laws& laws, const Work& work, double part) const {
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws.template pool<p>();
      using Law = std::remove_cvref_t<decltype(pool.law)>;
      if constexpr (ContactLaw<Law>) {
        for (Index i = 0; i < pool.count(); ++i) {
          auto& record = pool.items[i].record;
          record.gap += part * closing<p>(world, work, i);
          Vec3 way = Vec3::Zero();
          int count = 0;
          for (const Anchor* end : {&record.a, &record.b})
            world.visit(end->set, [&](const auto& set, auto) {
              if (!set.moves(end->block)) return;
              way += part * linear_part(set.v_next[end->block]).template cast<double>();
              ++count;
            });
          if (count == 0) continue;
          record.point_a += way / count;
          record.point_b += way / count;
        }
      }
    });
  }

 private:
  /// (H v_next) of the normal row, with what the stabilisation displaced.
  template <int p, class Work>
  static double closing(const World& world, const Work& work, Index i) {
    double u = 0;
    world.each([&](const auto& set, auto s) {
      const auto& blocks = std::get<s>(work.rows.template pool<p>().sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e) {
        const Index b = blocks.block[e];
        auto v = set.v_next[b];
        if constexpr (Work::projects_position) v += std::get<s>(work.displacement)[b];
        u += double(blocks.H[e].row(0).dot(v.transpose()));
      }
    });
    return u;
  }
  std::vector<Vec3> pushed_;  ///< impulses of the contacts, N·s
};

}  // namespace delassus
