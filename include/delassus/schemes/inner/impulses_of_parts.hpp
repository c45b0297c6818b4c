/// The contacts and impulses of all parts of a step that is done in several.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/schemes/inner/contacts_of_parts.hpp>

#include <cstddef>
#include <tuple>

namespace delassus::inner {

/// Sums of the parts that were added, by constraint and by contact.
template <class Laws>
class ImpulsesOfParts;

template <class... L>
class ImpulsesOfParts<Constraints<L...>> {
 public:
  using Laws = Constraints<L...>;

  void clear() {
    is_first_ = true;
    contacts_.clear();
  }
  /// Those of the part that was solved last.
  void add(auto& step) {
    if constexpr (Laws::has_contacts) contacts_.add(step.contact_cache);
    each_kept_pool(step.laws(), [&](auto p, const auto& pool) {
      auto& sum = std::get<p>(sums_);
      sum.resize(pool.impulse.size());
      for (std::size_t i = 0; i < sum.size(); ++i) {
        if (is_first_) set_zero(sum[i]);
        sum[i] += pool.impulse[i];
      }
    });
    is_first_ = false;
  }
  /// They become those of the step, from which the next one starts.
  void give_to(auto& step) {
    if constexpr (Laws::has_contacts) contacts_.give_to(step.laws(), step.contact_cache, step.summary);
    each_kept_pool(step.laws(), [&](auto p, auto& pool) { pool.impulse = std::get<p>(sums_); });
  }

 private:
  std::tuple<Array<Vec<L::rows>>...> sums_;
  ContactsOfParts contacts_;
  bool is_first_ = true;  ///< no part's impulses are in the sums
};

}  // namespace delassus::inner
