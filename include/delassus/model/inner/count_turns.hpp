/// Angles that the laws of a machine count over whole turns, told anew.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/joints/any_axis.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/model/machine.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

/// The same place of the same body.
inline bool is_same_end(const Anchor& a, const Anchor& b) {
  return a.block == b.block && a.set == b.set && a.generation == b.generation && a.owner == b.owner && a.local == b.local &&
         a.frame.coeffs() == b.frame.coeffs();
}

/// The coordinate of each axis of a machine, by joint, in turns that somebody knows.
class KnownTurns {
 public:
  KnownTurns(const Machine& machine, std::vector<double> coordinates)
      : machine_(machine), coordinates_(std::move(coordinates)) {}

  /// Of the axis with these ends and this kind, if it is one of the machine.
  void tell(AxisKind kind, const Anchor& a, const Anchor& b, double& position) const {
    if (a.is_world() && b.is_world()) return;
    for (std::size_t j = 0; j < machine_.axes.size(); ++j) {
      const model::Axis& axis = machine_.axes[j];
      if (axis.kind == kind && is_same_end(axis.b, b) && is_same_end(axis.a, a)) position = coordinates_[j];
    }
  }

 private:
  const Machine& machine_;
  const std::vector<double> coordinates_;
};

template <class C>
C coordinate_of(const OnAxis<C>&);
template <class A, class B>
A first_of(const Coupling<A, B>&);
template <class A, class B>
B second_of(const Coupling<A, B>&);

/// The kind of a coordinate that is known up to whole turns.
template <class C, class F>
void with_kind(F&& f) {
  if constexpr (std::is_same_v<C, Turn>) f(AxisKind::turn);
  if constexpr (std::is_same_v<C, Precession>) f(AxisKind::precession);
  if constexpr (std::is_same_v<C, Spin>) f(AxisKind::spin);
}

/// What a law counts of the axes of the machine.
template <class Law>
void tell_item(const KnownTurns& turns, const Law& law, typename Law::Item& item) {
  if constexpr (requires { coordinate_of(law), item.position; })
    with_kind<decltype(coordinate_of(law))>(
        [&](AxisKind kind) { turns.tell(kind, item.a, item.b, item.position); });
  if constexpr (requires { first_of(law); }) {
    with_kind<decltype(first_of(law))>(
        [&](AxisKind kind) { turns.tell(kind, item.c, item.a, item.position_a); });
    with_kind<decltype(second_of(law))>(
        [&](AxisKind kind) { turns.tell(kind, item.d, item.b, item.position_b); });
  }
  if constexpr (requires { item.parts[0].position, item.parts[0].kind; })
    for (TendonPart& part : item.parts) turns.tell(part.kind, part.a, part.b, part.position);
}

/// Of all constraints of a loop, those asleep too; nothing of what has a world alone.
template <class Loop>
void tell_laws([[maybe_unused]] Loop& loop, [[maybe_unused]] const KnownTurns& turns) {
  if constexpr (requires { loop.data().laws(); })
    each_kept_pool(loop.data().laws(), [&](auto, auto& pool) {
      for (Index k = 0; k < Index(pool.items.size()); ++k)
        if (pool.slots.is_alive(k)) tell_item(turns, pool.law, pool.items[std::size_t(k)]);
    });
}

}  // namespace delassus::inner
