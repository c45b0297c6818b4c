/// Penalty contacts as forces of the free motion.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/contact_place.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/step/detect.hpp>

namespace delassus {
namespace inner {

/// f(side, set, block, J) for the blocks behind both ends of a contact, side −1 of a and 1 of b, J = frame · (velocity of
/// the point) as a rows × w matrix.
template <int rows, class World, class Item, class F>
void each_block_of(World& world, const Item& item, F&& f) {
  for (const double side : {-1.0, 1.0}) {
    const Anchor& anchor = side < 0 ? item.record->a : item.record->b;
    world.each([&](auto& set, auto s) {
      if (s != anchor.set) return;
      for (int k = 0; k < set.anchor_blocks(anchor); ++k) {
        Mat<rows, std::remove_reference_t<decltype(set)>::width> J;
        for (int r = 0; r < rows; ++r)
          J.row(r) = set.along(anchor, k, r == 0 ? item.point : Vec3(item.point + item.record->friction_arm), item.frame.row(r).transpose()).template cast<double>().transpose();
        f(side, set, set.anchor_block(anchor, k), J);
      }
    });
  }
}

}  // namespace inner

/// Every contact of a `Penalty` law gives its bodies ±f for this step and leaves the pool: it has no row. The impulse h f
/// stands in the list of contacts.
template <class World, class Laws>
void push_apart(World& world, Laws& laws, ContactCache& book, double h) {
  const ViewOf<World> view(world);
  each_pool(laws, [&](auto, auto& pool) {
    if constexpr (requires { pool.law.law.stiffness; pool.items.clear(); }) {
      constexpr int rows = std::remove_cvref_t<decltype(pool.law)>::rows;
      constexpr bool is_force = rows == 1 || (rows == 3 && requires { pool.items[0].parameters.friction; });
      static_assert(is_force,
                    "delassus: CollisionsFirst makes a Penalty contact a force with the friction of Coulomb, or with none; take "
                    "Coulomb in place of RollingCoulomb or Pyramid, or the default scheme");
      if constexpr (is_force) for (const auto& item : pool.items) {
        Vec<rows> u = zero<Vec<rows>>();
        inner::each_block_of<rows>(world, item, [&](double side, auto& set, Index b, const auto& J) {
          u += side * J * set.velocity()[b].template cast<double>();
        });
        const ContactPlace place{item.record, &item.point, &item.frame};
        for (int k = 1; k < rows; ++k) u[k] += dot(place.axis(k), place.running(view));
        // w = t · J A⁻¹ Jᵀ t along the slip t.
        Vec<rows> t = u;
        t[0] = 0;
        const double slip = norm(t);
        double w = 0;
        if (slip > 0)
          inner::each_block_of<rows>(world, item, [&](double, auto& set, Index b, const auto& J) {
            using T = typename std::remove_reference_t<decltype(set)>::Scalar;
            const auto along = (J.transpose() * (t / slip)).eval();
            if (set.moves(b)) w += dot(along, set.template solve_block<1>(b, along.template cast<T>()).template cast<double>());
          });
        const Vec<rows> f = pool.law.law.force(item.parameters, item.gap, u, w, h);
        const Vec3 force = item.frame.template topRows<rows>().transpose() * f;
        inner::each_block_of<rows>(world, item, [&](double side, auto& set, Index b, const auto& J) {
          if (!set.moves(b)) return;
          if constexpr (requires { set.apply_force(set.handle(b), force, item.point); }) {
            const Vec3 normal = f[0] * item.record->normal;
            set.apply_force(set.handle(b), side * normal, item.point);
            set.apply_force(set.handle(b), side * (force - normal), item.point + item.record->friction_arm);
          } else
            set.apply_force(set.handle(b), side * Vec3(J.transpose() * f));
        });
        book.results[item.result].impulse = h * force;
      }
      pool.items.clear();
    }
  });
}

}  // namespace delassus
