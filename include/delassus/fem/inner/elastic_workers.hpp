/// What several workers keep of a set of deformable bodies, and which bodies they share.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/owning_array.hpp>
#include <delassus/core/ranges.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace delassus::inner {

/// Of bodies `Elastic`. A large body is shared by all workers; of small ones each is one worker's.
template <class Elastic>
struct ElasticWorkers {
  using Factor = typename Elastic::Matrix::Factor;

  /// Of one body, known by its number.
  struct Body {
    std::uint32_t number = 0;
    Index workers = 0;
    typename Factor::Workers factor;

    void clear() {}  // what it holds is told by its number
  };

  typename Factor::Dense dense;
  typename Elastic::Made made;
  OwningArray<Body> of;       ///< by the body's place in its set
  Array<Index> small, large;  ///< places of the bodies of the set
  Array<Index> nodes;         ///< of compliances that are asked for, by their number in the body

  /// Sorts the bodies, of which `size(k)` is how many nodes the one at place k has.
  void sort(std::span<const Index> places, Index workers, const auto& size) {
    double all = 0;
    const auto work = [&](Index k) { return double(size(k)) * double(size(k)); };
    for (const Index k : places) all += work(k);
    small.clear(), large.clear();
    for (const Index k : places)
      (is_large(size(k)) && work(k) * 2 * workers >= all ? large : small).push_back(k);
  }
  static bool is_large(Index nodes) { return nodes >= 300; }

  /// f(k) for all small bodies.
  template <class E>
  void each_small(const E& execution, const auto& f) const {
    const Index count = Index(small.size());
    execution.run(count, [&](Index task, Index) { f(small[task]); });
  }
  /// Its own of the body at place k.
  Body& at(Index k) {
    if (of.size() <= std::size_t(k)) of.resize(std::size_t(k) + 1);
    return of[std::size_t(k)];
  }
};

}  // namespace delassus::inner
