/// A clock that work in pieces looks at.
#pragma once

#include <delassus/core/clock.hpp>
#include <delassus/core/index.hpp>

#include <cstddef>
#include <iterator>
#include <utility>

namespace delassus::inner {

/// Whether the time is up, and whether work may be let go for it: only where there is something to go back
/// to.
template <Clock C>
class Watch {
 public:
  Watch(const C& clock, double deadline) : clock_(clock), deadline_(deadline) {}

  /// Units of work between two looks, one the visit of a constraint or a product of two blocks of bodies:
  /// some 5 µs. A look takes 25 ns.
  static constexpr int stride = 64;

  /// The time, s; when it is up nobody need look again.
  double look() {
    if (is_late_) return now_;
    now_ = clock_.now();
    is_late_ = now_ >= end();
    return now_;
  }
  bool is_late() const { return is_late_; }
  /// When work has to end, s: before the deadline, by what comes after it.
  double end() const { return deadline_ - kept_; }
  /// Keeps so much time, s, for what comes after the end.
  void keep(double time) { kept_ = time; }

  void let_go(bool may) { may_let_go_ = may; }
  /// What is begun now, or half done, is let go.
  bool lets_go() {
    if (is_late_ && may_let_go_) has_let_go_ = true;
    return is_late_ && may_let_go_;
  }
  bool has_let_go() const { return has_let_go_; }
  /// The same after a look.
  bool cuts_off() {
    if (may_let_go_) look();
    return lets_go();
  }
  /// The same after so much work, and a look where that makes a stride with what came before.
  bool cuts_off_after(int work) {
    if (!may_let_go_) return false;
    if (lets_go()) return true;
    since_ += work;
    if (since_ < stride) return false;
    since_ = 0;
    return cuts_off();
  }

 private:
  const C& clock_;
  double deadline_, kept_ = 0, now_ = 0;
  int since_ = 0;  ///< work
  bool is_late_ = false, may_let_go_ = false, has_let_go_ = false;
};

/// The items of a pool; those after the deadline are left out.
template <class Items, class Watch>
class WatchedItems {
 public:
  WatchedItems(const Items& items, Watch& watch) : items_(items), watch_(watch) {}

  class Iterator {
   public:
    using Place = decltype(std::declval<const Items&>().begin());
    Iterator(Place at, Place last, Watch& watch) : at_(at), last_(last), watch_(watch) {}
    Index operator*() const { return *at_; }
    Iterator& operator++() {
      ++at_;
      if (--left_ > 0 || at_ == last_) return *this;
      left_ = Watch::stride;
      if (watch_.cuts_off()) at_ = last_;
      return *this;
    }
    bool operator==(std::default_sentinel_t) const { return at_ == last_; }

   private:
    Place at_, last_;
    Watch& watch_;
    int left_ = Watch::stride;
  };

  Iterator begin() const { return {watch_.lets_go() ? items_.end() : items_.begin(), items_.end(), watch_}; }
  std::default_sentinel_t end() const { return {}; }
  std::size_t size() const { return items_.size(); }

 private:
  Items items_;
  Watch& watch_;
};

/// The items of an island, so watched.
template <class Groups, class Watch>
class WatchedGroups {
 public:
  WatchedGroups(const Groups& groups, Watch& watch) : groups_(groups), watch_(watch) {}
  auto items(int pool, Index island) const { return WatchedItems(groups_.items(pool, island), watch_); }

 private:
  const Groups& groups_;
  Watch& watch_;
};

}  // namespace delassus::inner
