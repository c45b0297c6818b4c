/// The contacts of all parts of a step as one list.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/step/contact_cache.hpp>
#include <delassus/step/detect.hpp>
#include <delassus/step/step_report.hpp>

#include <cstddef>

namespace delassus::inner {

/// Each is where its last part had it, with the sum of its impulses. Lists are sorted by pair and feature, as that of a step is.
class ContactsOfParts {
 public:
  void clear() { met_.clear(); }

  /// Those of one more part.
  void add(const ContactCache& cache) {
    const auto& now = cache.results;
    merged_.clear();
    place_.resize(now.size());
    std::size_t i = 0, k = 0;
    while (i < met_.size() || k < now.size()) {
      const bool is_old = i < met_.size() && (k == now.size() || !is_before(now[k], met_[i]));
      const bool is_new = k < now.size() && (i == met_.size() || !is_before(met_[i], now[k]));
      merged_.push_back(is_new ? now[k] : met_[i]);
      if (is_old && is_new) merged_[merged_.size() - 1].impulse += met_[i].impulse;
      if (is_new) place_[k++] = Index(merged_.size()) - 1;
      if (is_old) ++i;
    }
    met_.swap(merged_);
  }

  /// After the last part: the list becomes the step's, and the next step starts from its sums.
  template <class Laws>
  void give_to(Laws& laws, ContactCache& cache, StepReport& summary) {
    cache.results.swap(met_);
    each_contact_pool(laws, [&](auto, auto& pool) {
      for (auto& item : pool.items) item.result = place_[item.result];
    });
    attach_contacts(laws, cache);
    summary.contacts = Index(cache.results.size());
    cache.remember();
  }

 private:
  static bool is_before(const ContactResult& a, const ContactResult& b) {
    return a.record.pair != b.record.pair ? a.record.pair < b.record.pair : a.record.feature < b.record.feature;
  }

  Array<ContactResult> met_, merged_;
  Array<Index> place_;  ///< in `met_`, of the contacts of the last part
};

}  // namespace delassus::inner
