/// Impacts that go from contact to contact before the step: for `SequentialRestitution`.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/newton_impact.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/contact_place.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/world_view.hpp>

#include <algorithm>
#include <type_traits>
#include <vector>

namespace delassus {

struct SequentialImpacts;

namespace inner {

template <class Law, class Item>
double restitution_of(const Law& law, const Item& item) {
  if constexpr (refines<Law>(refine::restitution)) return law.restitution(item);
  else return 0;
}

/// Contacts of this law are hit one after the other.
template <class L>
inline constexpr bool hits_in_turn = []<class... O>(Overrides<O...>) {
  return (std::is_same_v<O, SequentialImpacts> || ...);
}(typename overrides_of<L>::type{});

/// What part s of the bounce λ_N − λ_c the bodies get: the largest in [0, 1] with which their energy does not grow, seen from the
/// surfaces that meet. λ_c meets the law without restitution from u and adds none; λ_N and λ_c lie in a convex cone.
template <int R, class T>
T share_without_gain(const Mat<R, R, T>& W, const Vec<R, T>& u, const Vec<R, T>& plain, const Vec<R, T>& newton) {
  // E(λ) = λ·u + ½ λ·W λ along λ_c + s δ: c + b s + a s².
  const Vec<R, T> delta = newton - plain, after = u + W * plain, moved = W * delta;
  double a = 0, b = 0, c = 0;
  for (int k = 0; k < R; ++k) {
    a += 0.5 * double(delta[k]) * double(moved[k]);
    b += double(delta[k]) * double(after[k]);
    c += 0.5 * double(plain[k]) * double(u[k] + after[k]);
  }
  c = std::min(c, 0.0);
  if (!(a + b + c > 0)) return T(1);
  return a > 0 ? T(std::clamp((std::sqrt(std::max(0.0, b * b - 4 * a * c)) - b) / (2 * a), 0.0, 1.0)) : T(0);
}

/// One contact, hit by itself: its own W from the masses, u⁺ = −e u⁻ by the law it has.
template <int p, class World, class Laws, class Rows>
class ImpactRows {
 public:
  using T = typename Rows::Scalar;
  static constexpr int R = Rows::template rows_of<p>;

  ImpactRows(World& world, const WorldView<T>& view, const Laws& laws, Rows& rows, Index i)
      : world_(world), view_(view), laws_(laws), rows_(rows), i_(i) {}

  /// Of the surfaces that meet.
  Vec<R, T> velocity() const {
    Vec<R, T> u = rate(
        rows_.template pool<p>(), i_, world_, [](const auto& set) -> const auto& { return set.velocity(); });
    const auto& item = laws_.template pool<p>().item(i_);
    const ContactPlace place{item.record, &item.point, &item.frame};
    for (int k = 1; k < rows_along<R>; ++k) u[k] += T(dot(place.axis(k), place.running(view_)));
    return u;
  }
  /// v ← v + M⁻¹ Hᵀ λ; returns λ. With friction Newton's law alone can add energy.
  Vec<R, T> hit(const Vec<R, T>& u, double h) {
    const auto& pool = laws_.template pool<p>();
    const auto& item = pool.item(i_);
    using Law = std::remove_cvref_t<decltype(pool.law)>;
    auto W = zero<Mat<R, R, T>>();
    Vec<R, T> free = u;
    free[0] += T(restitution_of(pool.law, item)) * u[0];
    each([&](const auto& set, Index b, const auto& H) { W.noalias() += H * answer(set, b, H); });
    memory_of_t<innermost_t<Law>, T> memory{};
    prepare(pool.law, item, W, h, memory);
    Vec<R, T> lambda = solve_local(pool.law, item, W, free, memory);
    if constexpr (R > 1) {
      const Vec<R, T> plain = solve_local(pool.law, item, W, u, memory);
      const T s = share_without_gain<R, T>(W, u, plain, lambda);
      if (s < T(1)) lambda = plain + s * (lambda - plain);
    }
    each([&](auto& set, Index b, const auto& H) {
      set.velocity()[b].noalias() += answer(set, b, H) * lambda;
    });
    return lambda;
  }

 private:
  template <class F>
  void each(F&& f) {
    world_.each([&](auto& set, auto s) {
      const auto& blocks = inner::part<s>(rows_.template pool<p>().sets);
      for (Index e = blocks.offset[i_]; e < blocks.offset[i_ + 1]; ++e)
        if (set.moves(blocks.block[e])) f(set, blocks.block[e], blocks.H[e]);
    });
  }
  template <class Set, class H>
  static auto answer(const Set& set, Index b, const H& h) {
    if constexpr (requires { set.template solve_mass<R>(b, h.transpose()); })
      return set.template solve_mass<R>(b, h.transpose());
    else
      return set.template solve_block<R>(b, h.transpose());
  }

  World& world_;
  const WorldView<T>& view_;
  const Laws& laws_;
  Rows& rows_;
  Index i_;
};

}  // namespace inner

/// Contacts that close within the step, of laws that pass impacts on, are hit one after the other until none
/// closes. v is changed at the start of the step; `impulses` gets what each contact got, N·s in the world.
template <class World, class Laws, class Rows>
void pass_on_impacts(World& world, const Laws& laws, Rows& rows, std::vector<Vec3>& impulses,
                     std::size_t contacts, double h) {
  impulses.assign(contacts, zero<Vec3>());
  const ViewOf<World> view(world);
  double fastest = 0;  // what closes below its rounding does not: a stack at rest has no impacts
  world.each([&](auto& set, auto) {
    set.factor({.mass = 1});
    fastest = std::max(fastest, h * norm(inner::gravity_of(set)));
    for (const Index b : set.active())
      fastest = std::max(fastest, double(linear_part(set.velocity()[b]).norm()));
  });
  const auto round = [&] {
    bool any = false;
    each_pool(laws, [&](auto p, const auto& pool) {
      using Law = std::remove_cvref_t<decltype(pool.law)>;
      if constexpr (inner::hits_in_turn<Law>)
        for (Index i = 0; i < pool.count(); ++i) {
          if (!(inner::restitution_of(pool.law, pool.item(i)) > 0)) continue;
          inner::ImpactRows<p, World, Laws, Rows> impact(world, view, laws, rows, i);
          const auto u = impact.velocity();
          const double closing = -double(u[0]), gap = double(rows.template pool<p>().phi[i][0]);
          if (!(closing > 1e-12 * fastest) || !(gap < h * closing)) continue;
          const auto lambda = impact.hit(u, h);
          constexpr int R = Rows::template rows_of<p>;
          impulses[std::size_t(pool.item(i).result)] += inner::world_impulse<R>(pool.item(i).frame, lambda);
          any = true;
        }
    });
    return any;
  };
  int most = 0;
  for_each_index<Laws::pool_count>([&](auto p) {
    if constexpr (inner::hits_in_turn<std::remove_cvref_t<decltype(laws.template pool<p>().law)>>)
      most = std::max(most, laws.template pool<p>().law.law.most_rounds);
  });
  for (int k = 0; k < most && round(); ++k) {
  }
}

/// What `SequentialRestitution` changes: impacts come before the free motion, and their impulses into the list of contacts.
struct SequentialImpacts {
  /// Kept from the free motion to the end of the step.
  template <class P>
  struct State {
    std::vector<Vec3> impulses;  ///< of the contacts, N·s
  };

  /// What a step does besides.
  template <class Base>
  struct stages : Base {
    static constexpr bool looks_ahead = false;  ///< impacts have changed v before a second solve
    static void free_motion(auto& step) {
      pass_on_impacts(step.world(), step.laws(), step.rows, step.template state<SequentialImpacts>().impulses,
                      step.contact_cache.results.size(), step.h);
      Base::free_motion(step);
    }
    /// Adds the impacts to the list of contacts, not to the next warm start.
    static void keep_impulses(auto& step) {
      Base::keep_impulses(step);  // impacts are no start for the next step
      const auto& impulses = step.template state<SequentialImpacts>().impulses;
      for (std::size_t i = 0; i < impulses.size(); ++i) step.contact_cache.results[i].impulse += impulses[i];
    }
  };
};

}  // namespace delassus
