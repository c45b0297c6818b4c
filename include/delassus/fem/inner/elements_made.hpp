/// Forces and stiffness of elements that several workers make before one adds them.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/math/lanes.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// An element that takes as many at a time as there are lanes, with a material that does.
template <class E, class M>
concept LaneElement = requires(const M& material, const double* numbers, const double* places) {
  E::lanes_at(material, numbers, places);
};

/// Forces on the nodes of one element, N, and K of its pairs of nodes, N/m.
template <class E>
struct ElementMade {
  Vec3 force[E::nodes];
  Mat3 K[E::nodes * (E::nodes - 1) / 2];
};
/// Of one element a lane.
template <class E>
struct LanesMade {
  LaneVector force[E::nodes];
  LaneMatrix K[E::nodes * (E::nodes - 1) / 2];
};

/// Room for some of them.
template <class One>
class MadeInTurns {
 public:
  /// make(k, one) of all numbers k < count, at once; then add(k, one) in their order.
  template <class Ex>
  void run(Index count, const Ex& execution, const auto& make, const auto& add) {
    for (Index done = 0; done < count; done += most) {
      const Index now = std::min(most, count - done), tasks = tasks_of(now, least, execution.workers());
      if (made_.size() < std::size_t(now)) made_.resize(std::size_t(now));
      execution.run(tasks, [&](Index task, Index) {
        const Range range = range_of(now, task, tasks);
        for (Index k = range.first; k < range.last; ++k) make(done + k, made_[std::size_t(k)]);
      });
      for (Index k = 0; k < now; ++k) add(done + k, made_[std::size_t(k)]);
    }
  }

 private:
  static constexpr Index most = Index((4u << 20) / sizeof(One));  ///< at a time: four megabytes
  static constexpr Index least = 64;                              ///< that are worth a task

  Array<One> made_;
};

template <class E, class M>
struct ElementsMade {
  MadeInTurns<ElementMade<E>> alone;
};
template <class E, class M>
requires LaneElement<E, M>
struct ElementsMade<E, M> {
  MadeInTurns<LanesMade<E>> by_lanes;
  MadeInTurns<ElementMade<E>> alone;
};

}  // namespace delassus::inner
