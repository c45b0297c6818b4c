/// Detect: what collision detection found goes into the pools of the contact laws.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/materials.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/step/contact_cache.hpp>
#include <delassus/step/step_report.hpp>

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>

namespace delassus {

namespace inner {

/// Whether some contact law has rows across the normal.
template <class Laws>
inline constexpr bool some_have_friction = false;
template <class... L>
inline constexpr bool some_have_friction<Constraints<L...>> = ((ContactLaw<L> && L::rows > 1) || ...);

}  // namespace inner

namespace inner {

/// The item of a law that takes a record, the r-th.
template <class Law>
[[gnu::always_inline]] inline void put_item(const Law& law, const ContactRecord& record, Index r, const Materials& materials,
                                            typename Law::Item& to) {
  auto parameters = law.law.parameters();
  if (!materials.empty())
    if (Material pair; materials.between(record.material_a, record.material_b, pair)) law.set_pair(parameters, pair);
  to = {&record, record.point(), record.gap, contact_frame(record.normal), parameters, r};
}

}  // namespace inner

/// Refuses a body whose material nobody added. Materials may come after the bodies: a step is the first to know.
template <class World>
void check_materials(const World& world, const Materials& materials) {
  const Index count = materials.count();
  world.each([&](const auto& set, auto) {
    if (set.keeps_to_materials(count)) return;
    for (Index b = 0; b < set.blocks(); ++b)
      DELASSUS_EXPECT(!set.is_alive(b) || materials.contains(set.material(b)),
                      set.who(b) + ": material " + std::to_string(set.material(b)) + " is not among the " +
                          std::to_string(count) + " of the loop; give it what loop.materials().add({...}) returns, or none");
  });
}

/// Gives each record to the first contact law that takes its materials; returns how many nobody took.
template <class Laws>
Index route_contacts(Laws& laws, const ContactCache& book, const Materials& materials) {
  each_contact_pool(laws, [](auto, auto& pool) { pool.items.clear(); });
  Index unclaimed = 0;
  for (Index r = 0; r < Index(book.results.size()); ++r) {
    const ContactRecord& record = book.results[r].record;
    bool is_taken = false;
    each_contact_pool(laws, [&](auto, auto& pool) {
      if (is_taken || !pool.law.takes(record.material_a, record.material_b)) return;
      is_taken = true;
      auto parameters = pool.law.law.parameters();
      if (!materials.empty())
        if (Material pair; materials.between(record.material_a, record.material_b, pair)) pool.law.set_pair(parameters, pair);
      pool.items.push_back({&record, record.point(), record.gap, contact_frame(record.normal), parameters, r});
    });
    unclaimed += is_taken ? 0 : 1;
  }
  return unclaimed;
}

/// The same where `ranges` says who does which records: of a loop with one contact law that takes them all; else one by one.
template <class Laws>
Index route_contacts(Laws& laws, const ContactCache& book, const Materials& materials, const auto& ranges) {
  int pools = 0;
  each_contact_pool(laws, [&](auto, auto&) { ++pools; });
  if (pools != 1) return route_contacts(laws, book, materials);
  std::atomic<bool> are_all_taken{true};
  each_contact_pool(laws, [&](auto, auto& pool) {
    const Index count = Index(book.results.size());
    pool.items.resize(std::size_t(count));
    ranges(count, 128, [&](inner::Range range) {
      for (Index r = range.first; r < range.last; ++r) {
        const ContactRecord& record = book.results[r].record;
        if (!pool.law.takes(record.material_a, record.material_b)) return are_all_taken.store(false, std::memory_order_relaxed);
        inner::put_item(pool.law, book.results[r].record, r, materials, pool.items[std::size_t(r)]);
      }
    });
  });
  return are_all_taken ? 0 : route_contacts(laws, book, materials);
}

/// The contacts may have moved or been copied with their loop.
template <class Laws>
void attach_contacts(Laws& laws, const ContactCache& book) {
  each_contact_pool(laws, [&](auto, auto& pool) {
    for (auto& item : pool.items) item.record = &book.results[item.result].record;
  });
}

/// What a step says of its contacts.
inline void report_contacts(const CollisionReport& found, inner::Slice<const ContactPoint> points, Index unclaimed, StepReport& step) {
  if (unclaimed > 0) step.status = worse(step.status, Status::unclaimed_contact);
  step.contacts = Index(points.size());
  step.pairs = found.pairs;
  step.queries = found.queries;
  step.rejects = found.rejects;
  for (const ContactPoint& p : points) step.max_penetration = std::max(step.max_penetration, -p.gap);
}

}  // namespace delassus
