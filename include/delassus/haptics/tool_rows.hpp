/// The rows of the coupling in a published problem: how they are eliminated, and how the others follow the device.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/joints/virtual_coupling.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/haptics/device_state.hpp>
#include <delassus/math/positive.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/rows/row_system.hpp>

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <vector>

namespace delassus::inner {

/// The number of the pool of couplings in a problem; −1 where there is none.
template <class Problem>
inline constexpr int coupling_pool = []<class... L>(std::type_identity<Constraints<L...>>) {
  constexpr bool is_it[] = {std::is_same_v<L, VirtualCoupling>..., false};
  for (int p = 0; p < int(sizeof...(L)); ++p)
    if (is_it[p]) return p;
  return -1;
}(std::type_identity<std::remove_cvref_t<decltype(Problem::laws)>>{});

/// What one constraint that shares the tool with the coupling c has of it.
template <int R, class T>
struct CoupledRow {
  Index item;
  Mat<R, 6, T> Z;  ///< W_ic W_cc⁻¹
  Vec<R, T> d;     ///< of the step
};
template <class Rows>
struct CoupledRows;
template <class T, class Widths, int... R>
struct CoupledRows<RowSystem<T, Widths, R...>> {
  using type = std::tuple<std::vector<CoupledRow<R, T>>...>;
};

/// The step solved λ_c = −h (K (φ + h u) + C u) with u = u_tool − v_b. At its end the device was to be at x_b + h v_b with
/// velocity v_b. With the device at x and v instead, its end of the spring lies further on by
///
///   Δ = x − (x_b + h v_b),  Δv = v − v_b,   so that   λ_c = −h (K (φ + h u − Δ) + C (u − Δv)).
///
/// That is the same soft row, of the same W and compliance, with   d_c ← d_c − (K Δ + C Δv)/(h K + C).
/// Orientation likewise, with Δ = log(q q_b⁻¹) − h ω_b. The rows act at the middle of the two ends, half a stretch r off the
/// device's. A turn moves it there by Δ × r, and the force has the moment r × F.
///
/// Against a light tool the coupling is slow to sweep, and it has no bounds. So it is eliminated, once a snapshot.
///
///   λ_c = −W_cc⁻¹ (d_c + Σ_j W_cj λ_j),   W_ij ← W_ij − Z_i W_cj,   d_i ← d_i − Z_i d_c,   Z_i = W_ic W_cc⁻¹.
///
/// No block is added: Constraints that meet the coupling do so on the tool, and meet each other there. What is left of row c
/// is λ_c = 0 by itself.
template <class Problem>
class ToolRows {
  using Rows = typename Problem::Rows;
  using T = typename Rows::Scalar;
  using Vec3 = Vec<3, DoubleIn<T>>;
  using Twist = Vec<6, DoubleIn<T>>;
  static constexpr int p = coupling_pool<Problem>;
  static constexpr int pools = Rows::pool_count;

 public:
  /// Room for `items` of each law.
  void reserve(std::size_t items) {
    std::apply([&](auto&... rows) { (rows.reserve(items), ...); }, coupled_);
    for (auto& place : place_) place.reserve(items);
  }

  bool is_there() const { return island_ >= 0; }
  Index island() const { return island_; }

  /// Finds and eliminates the coupling in the copy of a problem that a step has just solved, before the bodies move. False
  /// when the coupling is asleep: then nothing moves, and the snapshot before still holds.
  template <class World>
  bool take(const World& world, Problem& problem, ConstraintHandle<VirtualCoupling> coupling) {
    island_ = -1;
    const auto& pool = problem.laws.template pool<p>();
    if (coupling.index < 0 || !pool.contains(coupling)) return true;
    const auto& active = pool.slots.active();
    const auto place = inner::lower_bound(active.data(), active.data() + active.size(), coupling.index);
    if (place == active.end() || *place != coupling.index) return false;
    item_ = Index(place - active.begin());
    for (Index k = 0; k < problem.islands.count() && island_ < 0; ++k) {
      const auto items = problem.islands.items(p, k);
      if (inner::is_listed(items, item_)) island_ = k;
    }
    if (!is_there()) return true;
    remember_device(world, pool.item(item_), problem.h);
    eliminate(problem);
    return true;
  }

  /// d of every row that feels the coupling, with the device where it is now.
  void move_device(Rows& rows, const DeviceState& device) {
    const Quat now = device.orientation.normalized();
    const Vec3 arm = now * arm_;
    const Vec3 turned = logarithm<double>(now * frame_ * turn_.conjugate()) - ahead_;
    const Vec3 turns_faster = device.angular_velocity - rate_;
    Twist moved, faster;
    moved << device.position + arm - point_ + cross(turned, half_stretch_), turned;
    faster << device.velocity + cross(device.angular_velocity, arm) - velocity_ + cross(turns_faster, half_stretch_),
        turns_faster;
    d_now_ = d_ - (by_place_.cwiseProduct(moved) + by_speed_.cwiseProduct(faster)).template cast<T>();
    each_pool(rows, [&](auto q, auto& pool) {
      for (const auto& row : std::get<q>(coupled_)) pool.d[row.item] = row.d - row.Z * d_now_;
    });
  }

  /// The impulse on the device's end at the present impulses of the others, N·s and N·m·s.
  Twist impulse_on_device(const Rows& rows) const {
    Vec<6, T> lambda = -(inverse_ * d_now_);
    each_pool(rows, [&](auto q, const auto& pool) {
      for (const auto& row : std::get<q>(coupled_)) lambda -= row.Z.transpose() * pool.lambda[row.item];
    });
    Twist out = -lambda.template cast<double>();
    out.template tail<3>() += cross(half_stretch_, out.template head<3>());
    return out;
  }

 private:
  /// Where the step took the device's end to be when it is over, and how fast; and the shares of Δ and Δv in d.
  template <class World>
  void remember_device(const World& world, const VirtualCoupling::Item& item, double h) {
    arm_ = item.b.is_world() ? Vec3(zero<Vec3>()) : item.b.local;
    frame_ = item.b.frame;
    turn_ = world.frame(item.b);
    set_zero(velocity_);
    set_zero(rate_);
    world.visit(item.b.set, [&](const auto& set, auto) {
      if constexpr (std::remove_cvref_t<decltype(set)>::width == 6) {
        const Twist v = set.velocity()[item.b.block].template cast<double>();
        rate_ = v.template tail<3>();
        velocity_ = v.template head<3>() + cross(rate_, turn_ * frame_.conjugate() * arm_);
      }
    });
    const Vec3 end = world.point(item.b);
    half_stretch_ = 0.5 * (world.point(item.a) - end);
    point_ = end + h * velocity_;
    ahead_ = h * rate_;
    const double line = h * item.stiffness + item.damping, turn = h * item.angular_stiffness + item.angular_damping;
    by_place_ << Vec3::Constant(item.stiffness / line), Vec3::Constant(item.angular_stiffness / turn);
    by_speed_ << Vec3::Constant(item.damping / line), Vec3::Constant(item.angular_damping / turn);
  }

  void eliminate(Problem& problem) {
    auto& own = problem.rows.template pool<p>();
    own_block_ = problem.W.template diagonal<p>(item_);
    inverse_ = inverse_of_positive(own_block_);
    d_ = own.d[item_];
    set_zero(own.d[item_]);
    set_zero(own.lambda[item_]);
    for_each_index<pools>([&](auto q) {
      const auto W = problem.W.template blocks<p, q>();  // row c: W_cj
      auto& rows = std::get<q>(coupled_);
      rows.clear();
      place_[q].assign(problem.rows.template pool<q>().items(), -1);
      for (Index e = W.start[item_]; e < W.start[item_ + 1]; ++e) {
        const Index j = W.column[e];
        place_[q][j] = Index(rows.size());
        rows.push_back({j, W.block[e].template cast<T>().transpose() * inverse_, problem.rows.template pool<q>().d[j]});
        set_zero(W.block[e]);
      }
    });
    for_each_index<pools>([&](auto a) {
      for (const auto& row : std::get<a>(coupled_)) reduce<a>(problem.W, row);
    });
  }

  /// W_ij ← W_ij − Z_i W_cj, W_cj = W_cc Z_jᵀ, for all j; and W_ic ← 0.
  template <int a, class Operator, class Row>
  void reduce(Operator& W, const Row& row) {
    const auto ZW = (row.Z * own_block_).eval();
    W.template diagonal<a>(row.item) -= ZW * row.Z.transpose();
    for_each_index<pools>([&](auto b) {
      const auto blocks = W.template blocks<a, b>();
      using S = typename std::remove_cvref_t<decltype(blocks.block[0])>::Scalar;
      for (Index e = blocks.start[row.item]; e < blocks.start[row.item + 1]; ++e) {
        const Index j = blocks.column[e];
        if (b == p && j == item_) set_zero(blocks.block[e]);
        else if (place_[b][j] >= 0)
          blocks.block[e] -= (ZW * std::get<b>(coupled_)[place_[b][j]].Z.transpose()).template cast<S>();
      }
    });
  }

  Index item_ = -1, island_ = -1;
  Vec3 arm_ = zero<Vec3>(), half_stretch_ = zero<Vec3>();
  Vec3 point_ = zero<Vec3>(), velocity_ = zero<Vec3>(), rate_ = zero<Vec3>(), ahead_ = zero<Vec3>();
  Quat frame_ = Quat::Identity(), turn_ = Quat::Identity();
  Vec<6, T> d_ = zero<Vec<6, T>>(), d_now_ = zero<Vec<6, T>>();
  Twist by_place_ = zero<Twist>(), by_speed_ = zero<Twist>();
  Mat<6, 6, T> own_block_ = zero<Mat<6, 6, T>>(), inverse_ = zero<Mat<6, 6, T>>();  ///< W_cc and W_cc⁻¹
  typename CoupledRows<Rows>::type coupled_;
  std::array<std::vector<Index>, std::size_t(pools)> place_;
};

}  // namespace delassus::inner
