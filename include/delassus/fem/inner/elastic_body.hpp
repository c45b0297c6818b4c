/// One deformable body of a set: its elements, its elastic forces and its system matrix.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/fem/elasticity/material.hpp>
#include <delassus/fem/inner/body_elements.hpp>
#include <delassus/fem/inner/elements_made.hpp>
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

/// Of elements E, and of the ties between nodes that E has. Node k of the body is block `blocks[k]` of the
/// set. Elements are evaluated in double, whatever T is.
template <class E, class M, class T>
class ElasticBody : public BodyElements<E, M, T> {
  using Elements = BodyElements<E, M, T>;

 public:
  using typename Elements::Mesh, typename Elements::Velocity;
  static constexpr bool has_ties = requires(const Mesh& mesh, const M& material) { E::ties(mesh, material); };
  using Matrix = NodeMatrix<T, E::nodes, has_ties>;
  static constexpr bool has_constant_stiffness = requires { requires M::has_constant_stiffness; };

  ElasticBody() = default;
  /// Node k of the mesh is block blocks[k]; `mesh` is at rest.
  ElasticBody(Mesh mesh, const M& material, Array<Index> blocks)
      : Elements(std::move(mesh), material, std::move(blocks)) {
    prepare();
  }

  /// No other body has it, whatever world it is in, and none that a checkpoint brought back: names what is
  /// kept of this mesh. A copy has it too.
  std::uint32_t number() const { return number_; }
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
    const bool makes_stiffness = needs_stiffness(scale);
    for (Velocity& f : force_) f.setZero();
    Index e = 0;
    if constexpr (LaneElement<E, M>)
      for (; e < batched(); e += lane_count) add_lanes(e, x, makes_stiffness);
    for (; e < Index(elements_.size()); ++e) add_element(e, x, makes_stiffness);
    end_assembly(scale, x, mass, inverse_mass);
  }

  // --- by several workers, with the same bits --------------------------------------------------------------

  /// What elements make before it is added.
  using Made = ElementsMade<E, M>;

  template <class By, class Ex>
  void factor(SystemScale scale, std::span<const Velocity> x, const Array<T>& mass,
              const Array<T>& inverse_mass, By& by, auto& body, const Ex& execution) {
    if (body.number != number_ || body.workers != execution.workers()) {
      matrix_.prepare(body.factor, by.dense, execution.workers());
      body.number = number_, body.workers = execution.workers();
    }
    assemble(scale, x, mass, inverse_mass, by.made, execution);
    if (scale.stiffness == 0 || is_factored_) return;
    is_factored_ =
        matrix_.factor(T(scale.mass), T(scale.stiffness), mass_, is_held_, body.factor, by.dense, execution);
  }

  // --- for who factors A by itself -------------------------------------------------------------------------

  std::span<const std::pair<Index, Index>> pairs() const { return matrix_.pairs(); }
  std::span<const char> held() const { return is_held_; }
  std::span<const T> mass() const { return mass_; }
  SystemScale scale() const { return scale_; }
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

  /// x ← A⁻¹ x on the blocks of the body. `by`: what several workers keep, and the execution, and so below.
  void solve(std::span<Velocity> x, auto&... by) const {
    held_nodes().solve(matrix_, blocks_, work_, x, by...);
  }
  /// The rows and columns of A⁻¹ of some nodes, 3n × 3n by columns.
  void compliance(std::span<const Index> nodes, std::span<T> C, auto&... by) const {
    held_nodes().template compliance<3>(matrix_, nodes, C, by...);
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
    this->make_elements();
    ties_.clear();
    if constexpr (has_ties) ties_ = E::ties(mesh_, material_);
    force_.assign(n, Velocity::Zero());
    work_ = product_ = force_;
    mass_.assign(n, T(0));
    is_held_.assign(n, 0);
    if (n > 0) matrix_.analyse(Index(n), nodes_, batched(), ties_, mesh_.points);
    has_stiffness_ = is_factored_ = false;
  }

  /// x_j − x_i, m.
  Vec3 apart(const Tie& t, std::span<const Velocity> x) const {
    return x[blocks_[t.j]].template cast<double>() - x[blocks_[t.i]].template cast<double>();
  }
  bool needs_stiffness(SystemScale scale) const {
    return scale.stiffness != 0 && !(has_constant_stiffness && has_stiffness_);
  }
  /// When all elements are in.
  [[gnu::always_inline]] void end_assembly(SystemScale scale, std::span<const Velocity> x,
                                           const Array<T>& mass, const Array<T>& inverse_mass) {
    const bool is_implicit = scale.stiffness != 0, makes_stiffness = needs_stiffness(scale);
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
  /// Elements are made at once, some thousand at a time, and added one by one.
  template <class Ex>
  void assemble(SystemScale scale, std::span<const Velocity> x, const Array<T>& mass,
                const Array<T>& inverse_mass, Made& made, const Ex& execution) {
    const bool makes_stiffness = needs_stiffness(scale);
    for (Velocity& f : force_) f.setZero();
    if constexpr (LaneElement<E, M>)
      made.by_lanes.run(
          batched() / lane_count, execution,
          [&](Index k, auto& one) { this->make_lanes(lane_count * k, x, makes_stiffness, one); },
          [&](Index k, const auto& one) { add_lanes(lane_count * k, one, makes_stiffness); });
    made.alone.run(
        Index(elements_.size()) - batched(), execution,
        [&](Index k, auto& one) { this->make_element(batched() + k, x, makes_stiffness, one); },
        [&](Index k, const auto& one) { add_element(batched() + k, one, makes_stiffness); });
    end_assembly(scale, x, mass, inverse_mass);
  }

  void add_element(Index e, std::span<const Velocity> x, bool with_stiffness) {
    const auto state = elements_[e].at(material_, corners(e, x));
    add_force(e, state.force);
    if (!with_stiffness) return;
    const auto K = state.stiffness();
    const auto& order = order_[e];
    for (int k = 0; k < Matrix::pairs_each; ++k) {
      const auto& [i, j] = pairs_of_nodes<E::nodes>[k];
      matrix_.add(e, k, K.block(order[i], order[j]));
    }
  }
  void add_element(Index e, const ElementMade<E>& made, bool with_stiffness) {
    add_force(e, made.force);
    for (int k = 0; with_stiffness && k < Matrix::pairs_each; ++k) matrix_.add(e, k, made.K[k]);
  }
  [[gnu::always_inline]] void add_force(Index e, const auto& force) {
    const auto& t = mesh_.cells()[e];
    for (int a = 0; a < E::nodes; ++a) force_[t[a]] += force[a].template cast<T>();
  }

  void add_lanes(Index e, std::span<const Velocity> x, bool with_stiffness) {
    const auto state = lanes_at(e, x);
    add_lane_forces(e, state.force);
    if (!with_stiffness) return;
    const auto K = state.stiffness();
#pragma GCC unroll 6  // a block's numbers stay in registers from the material to their places
    for (int k = 0; k < Matrix::pairs_each; ++k) {
      const auto& [i, j] = pairs_of_nodes<E::nodes>[k];
      matrix_.add_lanes(e, k, K.block(i, j));
    }
  }
  void add_lanes(Index e, const LanesMade<E>& made, bool with_stiffness) {
    add_lane_forces(e, made.force);
    for (int k = 0; with_stiffness && k < Matrix::pairs_each; ++k) matrix_.add_lanes(e, k, made.K[k]);
  }
  [[gnu::always_inline]] void add_lane_forces(Index e, const LaneVector* force) {
    double numbers[3 * lane_count];
    for (int a = 0; a < E::nodes; ++a) {
      std::memcpy(numbers, &force[a], sizeof numbers);
      for (int l = 0; l < lane_count; ++l)
        for (int k = 0; k < 3; ++k) force_[nodes_[e + l][a]][k] += T(numbers[k * lane_count + l]);
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

  using Elements::batched, Elements::corners, Elements::lanes_at;
  using Elements::mesh_, Elements::material_, Elements::blocks_, Elements::elements_;
  using Elements::order_, Elements::nodes_;

  std::uint32_t number_ = 0;
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
