/// What outlives the flights of a step: for `LocatedImpacts`.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/loop/stages/detect.hpp>
#include <delassus/loop/stages/part_sums.hpp>
#include <delassus/loop/step_report.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace delassus {

/// The bodies and constraints where the present flight began, to fly from there again, and the contacts that
/// the step has met. `h` is 0 between steps.
template <class World, class Laws>
class Flights;

template <class... Sets, class... L>
class Flights<World<Sets...>, Constraints<L...>> : public PartSums<World<Sets...>, Constraints<L...>> {
  using Sums = PartSums<delassus::World<Sets...>, Constraints<L...>>;

 public:
  using World = delassus::World<Sets...>;
  using Laws = Constraints<L...>;
  bool are_joints_closed = true;  ///< where the step began

  void begin(World& world, Laws& laws, const ContactBook& book, const StepReport& report) {
    this->keep_loads(world);
    met_.clear();
    book_ = book;
    is_before_impacts_ = true;
    keep(world, laws, report);
  }
  /// What is now in the loop is done: the next flight begins here.
  void go_on(World& world, Laws& laws, const StepReport& report) {
    is_before_impacts_ = false;
    look_ahead();
    this->give_loads(world);
    forget_impulses(laws);  // no start for a flight of another length
    keep(world, laws, report);
  }
  void forget_impulses(Laws& laws) const {
    for_each_index<Laws::pool_count>([&](auto p) {
      auto& pool = laws.template pool<p>();
      if constexpr (requires { pool.impulse; })
        for (auto& x : pool.impulse) x.setZero();
    });
  }
  void go_back(World& world, Laws& laws, StepReport& report) const {
    world = *world_;
    laws = *laws_;
    report = report_;
    report.quarantined = 0;  // whom the flight will hold again
  }
  /// The least gap (m), and whether it is of a contact that was there when the flight began, or of a pair
  /// that stays in touch from the step before.
  struct Landing {
    double gap = std::numeric_limits<double>::infinity();
    bool is_old = false, stays = false;
  };
  Landing landing(const ContactBook& book) const {
    const ContactPoint* least = nullptr;
    for (const ContactPoint& p : book.points)
      if (!least || p.gap < least->gap) least = &p;
    if (!least) return {};
    const bool is_old = std::find(touching_.begin(), touching_.end(), name(*least)) != touching_.end();
    return {least->gap, is_old, stays_ahead(least->pair)};
  }
  /// Whether the pair pushed in the last step.
  bool stays(std::uint64_t pair) const { return book_.pushed(pair); }
  bool stays_ahead(std::uint64_t pair) const { return is_before_impacts_ && stays(pair); }
  /// The contacts that touch where the next flight begins.
  void note_touching(const ContactBook& book, double reach) {
    touching_.clear();
    for (const ContactPoint& p : book.points)
      if (p.gap <= reach) touching_.push_back(name(p));
  }

  /// What is in sight where a flight ends, and ahead of one that begins there.
  void see(const ContactBook& book) { seen_ = book.points; }
  void look_ahead() { ahead_ = seen_; }
  const std::vector<ContactPoint>& ahead() const { return ahead_; }

  /// The contacts of the last step, whose impulses are the start of those that stay.
  const ContactBook& contacts_before() const { return book_; }

  void add_contacts(const ContactBook& book) {
    met_.insert(met_.end(), book.results.begin(), book.results.end());
  }
  void give_impulses(Laws& laws, ContactBook& book) {
    Sums::give_impulses(laws);
    book.results.swap(met_);
  }

 private:
  using Name = std::pair<std::uint64_t, std::uint32_t>;
  static Name name(const ContactPoint& p) { return {p.pair, p.feature}; }
  void keep(const World& world, const Laws& laws, const StepReport& report) {
    world_ = world;
    laws_ = laws;
    report_ = report;
  }

  std::optional<World> world_;
  std::optional<Laws> laws_;
  StepReport report_;
  ContactBook book_;
  std::vector<ContactResult> met_;
  std::vector<ContactPoint> seen_, ahead_;
  std::vector<Name> touching_;
  bool is_before_impacts_ = true;
};

}  // namespace delassus
