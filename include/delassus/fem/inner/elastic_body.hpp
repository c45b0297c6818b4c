/// One deformable body of a set: its elements, its elastic forces and its system matrix.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/fem/inner/held_nodes.hpp>
#include <delassus/fem/inner/node_matrix.hpp>
#include <delassus/math/lanes.hpp>
#include <delassus/rows/body_set.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// An element that takes as many at a time as there are lanes, with a material that does.
template <class E, class M>
concept LaneElement = requires(const M& material, const double* numbers, const double* places) {
  E::lanes_at(material, numbers, places);
};

/// Of elements E, and of the ties between nodes that E has. Node k of the body is block `blocks[k]` of the
/// set. Elements are evaluated in double, whatever T is.
template <class E, class M, class T>
class ElasticBody {
 public:
  using Mesh = typename E::Mesh;
  using Velocity = Vec<3, T>;
  static constexpr bool has_ties = requires(const Mesh& mesh, const M& material) { E::ties(mesh, material); };
  using Matrix = NodeMatrix<T, E::nodes, has_ties>;
  static constexpr bool has_constant_stiffness = requires { requires M::has_constant_stiffness; };

  ElasticBody() = default;
  /// Node k of the mesh is block blocks[k]; `mesh` is at rest.
  ElasticBody(Mesh mesh, const M& material, Array<Index> blocks)
      : mesh_(std::move(mesh)), material_(material), blocks_(std::move(blocks)) {
    prepare();
  }

  std::span<const Index> blocks() const { return blocks_; }
  /// No other body has it, whatever world it is in, and none that a checkpoint brought back: names what is
  /// kept of this mesh. A copy has it too.
  std::uint32_t number() const { return number_; }
  const Mesh& mesh() const { return mesh_; }
  /// The block of corner `corner` of element e.
  Index block_of(Index e, int corner) const { return blocks_[mesh_.cells()[e][corner]]; }

  /// The element a point of the world is in, and its place there, by which E weighs the corners; −1 where it
  /// is outside of all of them by more than 1e-6 of one.
  Index locate(const Vec3& point, std::span<const Velocity> x, Vec3& local) const {
    Index found = -1;
    double best = -1e-6;
    for (Index e = 0; e < Index(elements_.size()); ++e) {
      Vec3 at = Vec3::Zero();
      const double inside = E::locate(corners(e, x), point, at);
      if (!(inside > best)) continue;
      best = inside;
      local = at;
      found = e;
    }
    return found;
  }

  /// Makes elastic forces, A and its factor at the positions x of the set's blocks. Where A has no factor, as
  /// where x is not finite, `solve` answers with numbers that are none, and the body stays where it was.
  void factor(SystemScale scale, std::span<const Velocity> x, const Array<T>& mass,
              const Array<T>& inverse_mass) {
    assemble(scale, x, mass, inverse_mass);
    if (scale.stiffness == 0 || is_factored_) return;
    is_factored_ = matrix_.factor(T(scale.mass), T(scale.stiffness), mass_, is_held_);
  }

  /// The same without a factor; the one there is goes, unless A is what it was.
  void assemble(SystemScale scale, std::span<const Velocity> x, const Array<T>& mass,
                const Array<T>& inverse_mass) {
    const bool is_implicit = scale.stiffness != 0;
    const bool makes_stiffness = is_implicit && !(has_constant_stiffness && has_stiffness_);
    for (Velocity& f : force_) f.setZero();
    Index e = 0;
    if constexpr (LaneElement<E, M>)
      for (; e < batched(); e += lane_count) add_lanes(e, x, makes_stiffness);
    for (; e < Index(elements_.size()); ++e) add_element(e, x, makes_stiffness);
    for (const Tie& t : ties_) {
      const Velocity f = (t.k * apart(t, x)).template cast<T>();
      force_[t.i] += f, force_[t.j] -= f;
    }
    if (makes_stiffness) matrix_.add_diagonal();
    has_stiffness_ = has_stiffness_ || is_implicit;
    if (!is_implicit) return;
    const bool is_same = is_assembled_for(scale, mass, inverse_mass);
    is_factored_ = is_factored_ && is_same;
    scale_ = scale;
  }

  // --- for who factors A by itself -------------------------------------------------------------------------

  std::span<const std::pair<Index, Index>> pairs() const { return matrix_.pairs(); }
  std::span<const char> held() const { return is_held_; }
  std::span<const T> mass() const { return mass_; }
  SystemScale scale() const { return scale_; }
  const M& material() const { return material_; }
  void enter(auto& factor) const {
    matrix_.enter(factor, T(scale_.mass), T(scale_.stiffness), mass_, is_held_);
  }
  /// y = A x by nodes, x zero at held ones.
  void multiply(std::span<const Velocity> x, std::span<Velocity> y) const {
    for (std::size_t k = 0; k < x.size(); ++k) y[k] = (T(scale_.mass) * mass_[k]) * x[k];
    matrix_.add_product(T(scale_.stiffness), x, y);
    for (std::size_t k = 0; k < x.size(); ++k)
      if (is_held_[k]) y[k].setZero();
  }

  /// ∫Ψ at the positions x, J.
  double energy(std::span<const Velocity> x) const {
    double sum = 0;
    for (Index e = 0; e < Index(elements_.size()); ++e) sum += elements_[e].energy(material_, corners(e, x));
    for (const Tie& t : ties_) sum += 0.5 * t.k * apart(t, x).squaredNorm();
    return sum;
  }
  /// N by node, at the positions of the last `factor`.
  const Array<Velocity>& force() const { return force_; }

  /// p += −s K v by blocks of the set.
  void add_stiffness_times_velocity(std::span<Velocity> p, std::span<const Velocity> v, T s) const {
    if (!has_stiffness_) return;
    for (std::size_t k = 0; k < blocks_.size(); ++k) work_[k] = v[blocks_[k]], product_[k].setZero();
    matrix_.add_product(-s, work_, product_);
    for (std::size_t k = 0; k < blocks_.size(); ++k) p[blocks_[k]] += product_[k];
  }

  /// x ← A⁻¹ x on the blocks of the body.
  void solve(std::span<Velocity> x) const { held_nodes().solve(matrix_, blocks(), work_, x); }
  /// The rows and columns of A⁻¹ of some nodes, 3n × 3n by columns.
  void compliance(std::span<const Index> nodes, std::span<T> C) const {
    held_nodes().template compliance<3>(matrix_, nodes, C);
  }

  void memory(auto& archive) {
    archive(mesh_.points, mesh_.cells(), material_, blocks_);
    if constexpr (requires { mesh_.thickness; }) archive(mesh_.thickness);
    if (archive.reads) prepare();
  }

 private:
  HeldNodes held_nodes() const { return {is_held_, is_factored_}; }
  void prepare() {
    const std::size_t n = blocks_.size();
    number_ = next_owner();
    elements_.clear();
    const Lame lame(material_.young, material_.poisson);
    for (Index e = 0; e < Index(mesh_.cells().size()); ++e) elements_.emplace_back(mesh_, e, lame);
    order_corners();
    ties_.clear();
    if constexpr (has_ties) ties_ = E::ties(mesh_, material_);
    force_.assign(n, Velocity::Zero());
    work_ = product_ = force_;
    mass_.assign(n, T(0));
    is_held_.assign(n, 0);
    if (n > 0) matrix_.analyse(Index(n), nodes_, batched(), ties_, mesh_.points);
    has_stiffness_ = is_factored_ = false;
  }

  /// How many elements are taken lane_count at a time.
  Index batched() const { return LaneElement<E, M> ? Index(elements_.size()) / lane_count * lane_count : 0; }
  /// The element that is taken as number k. Those that meshes name one after the other share nodes, and lanes
  /// that add to one number wait for each other: of each lane_count² elements, a batch takes every
  /// lane_count-th.
  Index element_at(Index k) const {
    constexpr Index group = lane_count * lane_count;
    if (!LaneElement<E, M> || k >= Index(elements_.size()) / group * group) return k;
    const Index in_group = k % group;
    return k - in_group + in_group % lane_count * lane_count + in_group / lane_count;
  }
  /// The corners of each element by ascending node, and what its lane is made of.
  void order_corners() {
    const std::size_t n = elements_.size();
    order_.resize(n), nodes_.resize(n);
    lane_numbers_.clear();
    if constexpr (LaneElement<E, M>) lane_numbers_.resize(std::size_t(batched()) * E::lane_numbers);
    for (std::size_t k = 0; k < n; ++k) {
      const Index e = element_at(Index(k));
      const auto& t = mesh_.cells()[e];
      for (int a = 0; a < E::nodes; ++a) order_[k][a] = a;
      inner::sort(order_[k], [&](int a, int b) { return t[a] < t[b]; });
      for (int a = 0; a < E::nodes; ++a) nodes_[k][a] = t[order_[k][a]];
      if constexpr (LaneElement<E, M>)
        if (Index(k) < batched())
          elements_[e].enter_lane(order_[k],
                                  &lane_numbers_[k / lane_count * lane_count * E::lane_numbers + k % lane_count]);
    }
  }

  typename E::Corners corners(Index e, std::span<const Velocity> x) const {
    typename E::Corners at;
    for (int a = 0; a < E::nodes; ++a) at[a] = x[block_of(e, a)].template cast<double>();
    return at;
  }

  /// x_j − x_i, m.
  Vec3 apart(const Tie& t, std::span<const Velocity> x) const {
    return x[blocks_[t.j]].template cast<double>() - x[blocks_[t.i]].template cast<double>();
  }
  void add_element(Index e, std::span<const Velocity> x, bool with_stiffness) {
    const auto& t = mesh_.cells()[e];
    const auto state = elements_[e].at(material_, corners(e, x));
    for (int a = 0; a < E::nodes; ++a) force_[t[a]] += state.force[a].template cast<T>();
    if (!with_stiffness) return;
    const auto K = state.stiffness();
    const auto& order = order_[e];
    for (int k = 0; k < Matrix::pairs_each; ++k) {
      const auto& [i, j] = pairs_of_nodes<E::nodes>[k];
      matrix_.add(e, k, K.block(order[i], order[j]));
    }
  }

  /// The elements that are taken as numbers e … e + lane_count − 1 at once.
  void add_lanes(Index e, std::span<const Velocity> x, bool with_stiffness) {
    double places[E::nodes * 3 * lane_count], numbers[3 * lane_count];
    for (int l = 0; l < lane_count; ++l)
      for (int a = 0; a < E::nodes; ++a) {
        const Velocity& at = x[blocks_[nodes_[e + l][a]]];
        for (int k = 0; k < 3; ++k) places[(3 * a + k) * lane_count + l] = double(at[k]);
      }
    const auto state = E::lanes_at(material_, &lane_numbers_[std::size_t(e) * E::lane_numbers], places);
    for (int a = 0; a < E::nodes; ++a) {
      std::memcpy(numbers, &state.force[a], sizeof numbers);
      for (int l = 0; l < lane_count; ++l)
        for (int k = 0; k < 3; ++k) force_[nodes_[e + l][a]][k] += T(numbers[k * lane_count + l]);
    }
    if (!with_stiffness) return;
    const auto K = state.stiffness();
#pragma GCC unroll 6  // a block's numbers stay in registers from the material to their places
    for (int k = 0; k < Matrix::pairs_each; ++k) {
      const auto& [i, j] = pairs_of_nodes<E::nodes>[k];
      matrix_.add_lanes(e, k, K.block(i, j));
    }
  }

  /// Whether A is the one there was; takes over the masses.
  bool is_assembled_for(SystemScale scale, const Array<T>& mass, const Array<T>& inverse_mass) {
    bool is_same = has_constant_stiffness && scale_.mass == scale.mass && scale_.stiffness == scale.stiffness;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const char is_held = inverse_mass[blocks_[k]] > T(0) ? 0 : 1;
      is_same = is_same && is_held == is_held_[k];
      is_held_[k] = is_held;
      mass_[k] = mass[blocks_[k]];
    }
    return is_same;
  }

  Mesh mesh_;
  M material_{};
  std::uint32_t number_ = 0;
  Array<Index> blocks_;
  ArrayOrVector<E> elements_;
  Array<std::array<int, E::nodes>> order_;    ///< `element_at(k)`'s corners by ascending node
  Array<std::array<Index, E::nodes>> nodes_;  ///< these nodes
  Array<double> lane_numbers_;                ///< of whole lanes of elements
  Array<Tie> ties_;
  Array<Velocity> force_;
  Array<T> mass_;
  Array<char> is_held_;
  Matrix matrix_;
  SystemScale scale_;  ///< of A
  bool has_stiffness_ = false, is_factored_ = false;
  mutable Array<Velocity> work_, product_;
};

}  // namespace delassus::inner
