/// One deformable body of a set: its elements, its elastic forces and its system matrix.
#pragma once

#include <delassus/bodies/elasticity/material.hpp>
#include <delassus/bodies/inner/held_nodes.hpp>
#include <delassus/bodies/inner/node_matrix.hpp>
#include <delassus/rows/body_set.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

/// Of elements E. Node k of the body is block `blocks[k]` of the set. Elements are evaluated in double,
/// whatever T is.
template <class E, class M, class T>
class ElasticBody {
 public:
  using Mesh = typename E::Mesh;
  using Velocity = Vec<3, T>;
  static constexpr bool has_constant_stiffness = requires { requires M::has_constant_stiffness; };

  ElasticBody() = default;
  /// Node k of the mesh is block blocks[k]; `mesh` is at rest.
  ElasticBody(Mesh mesh, const M& material, std::vector<Index> blocks)
      : mesh_(std::move(mesh)), material_(material), blocks_(std::move(blocks)) {
    prepare();
  }

  std::span<const Index> blocks() const { return blocks_; }
  const Mesh& mesh() const { return mesh_; }
  /// The block of corner `corner` of element e.
  Index block_of(Index e, int corner) const { return blocks_[mesh_.cells()[e][corner]]; }

  /// The element a point of the world is in, and its place there, by which E weighs the corners; −1 where it
  /// is outside of all of them by more than 1e-6 of one.
  Index locate(const Vec3& point, const std::vector<Velocity>& x, Vec3& local) const {
    Index found = -1;
    double best = -1e-6;
    for (Index e = 0; e < Index(elements_.size()); ++e) {
      Vec3 at;
      const double inside = E::locate(corners(e, x), point, at);
      if (!(inside > best)) continue;
      best = inside;
      local = at;
      found = e;
    }
    return found;
  }

  /// Makes elastic forces and A at the positions x of the set's blocks. Where A has no factor, as where x is
  /// not finite, `solve` answers with numbers that are none, and the body stays where it was.
  void factor(SystemScale scale, const std::vector<Velocity>& x, const std::vector<T>& mass,
              const std::vector<T>& inverse_mass) {
    const bool is_implicit = scale.stiffness != 0;
    const bool keeps_stiffness = has_constant_stiffness && has_stiffness_;
    if (is_implicit && !keeps_stiffness) matrix_.set_zero();
    for (Velocity& f : force_) f.setZero();
    for (Index e = 0; e < Index(elements_.size()); ++e) add_element(e, x, is_implicit && !keeps_stiffness);
    has_stiffness_ = has_stiffness_ || is_implicit;
    if (!is_implicit || is_factored_for(scale, mass, inverse_mass)) return;
    is_factored_ = matrix_.factor(T(scale.mass), T(scale.stiffness), mass_, is_held_);
    factored_ = scale;
  }

  /// ∫Ψ at the positions x, J.
  double energy(const std::vector<Velocity>& x) const {
    double sum = 0;
    for (Index e = 0; e < Index(elements_.size()); ++e) sum += elements_[e].energy(material_, corners(e, x));
    return sum;
  }
  /// N by node, at the positions of the last `factor`.
  const std::vector<Velocity>& force() const { return force_; }

  /// p += −s K v by blocks of the set.
  void add_stiffness_times_velocity(std::vector<Velocity>& p, const std::vector<Velocity>& v, T s) const {
    if (!has_stiffness_) return;
    for (std::size_t k = 0; k < blocks_.size(); ++k) work_[k] = v[blocks_[k]], product_[k].setZero();
    matrix_.add_product(-s, work_, product_);
    for (std::size_t k = 0; k < blocks_.size(); ++k) p[blocks_[k]] += product_[k];
  }

  /// x ← A⁻¹ x on the blocks of the body.
  void solve(std::vector<Velocity>& x) const { held().solve(matrix_, blocks(), work_, x); }
  /// The rows and columns of A⁻¹ of some nodes, 3n × 3n by columns.
  void compliance(std::span<const Index> nodes, std::span<T> C) const {
    held().template compliance<3>(matrix_, nodes, C);
  }

  void memory(auto& archive) {
    archive(mesh_.points, mesh_.cells(), material_, blocks_);
    if constexpr (std::remove_reference_t<decltype(archive)>::reads) prepare();
  }

 private:
  HeldNodes held() const { return {is_held_, is_factored_}; }
  void prepare() {
    const std::size_t n = blocks_.size();
    elements_.clear();
    const Lame lame(material_.young, material_.poisson);
    for (Index e = 0; e < Index(mesh_.cells().size()); ++e) elements_.emplace_back(mesh_, e, lame);
    force_.assign(n, Velocity::Zero());
    work_ = product_ = force_;
    mass_.assign(n, T(0));
    is_held_.assign(n, 0);
    if (n > 0) matrix_.analyse(Index(n), mesh_.cells(), mesh_.points);
    has_stiffness_ = is_factored_ = false;
  }

  typename E::Corners corners(Index e, const std::vector<Velocity>& x) const {
    typename E::Corners at;
    for (int a = 0; a < E::nodes; ++a) at[a] = x[block_of(e, a)].template cast<double>();
    return at;
  }

  void add_element(Index e, const std::vector<Velocity>& x, bool with_stiffness) {
    const auto& t = mesh_.cells()[e];
    const auto state = elements_[e].at(material_, corners(e, x));
    for (int a = 0; a < E::nodes; ++a) force_[t[a]] += state.force[a].template cast<T>();
    if (with_stiffness) add_stiffness(e, state.stiffness());
  }

  void add_stiffness(Index e, const auto& K) {
    const auto& t = mesh_.cells()[e];
    for (int a = 0; a < E::nodes; ++a) matrix_.add_diagonal(t[a], K.block(a, a).template cast<T>());
    for (int k = 0; k < int(pairs_of_nodes<E::nodes>.size()); ++k) {
      const auto& [i, j] = pairs_of_nodes<E::nodes>[k];
      const bool is_upper = t[i] < t[j];
      matrix_.add_pair(e, k, K.block(is_upper ? i : j, is_upper ? j : i).template cast<T>());
    }
  }

  /// Whether the factor there is is the one that is wanted; takes over the masses.
  bool is_factored_for(SystemScale scale, const std::vector<T>& mass, const std::vector<T>& inverse_mass) {
    bool is_same = has_constant_stiffness && is_factored_ && factored_.mass == scale.mass &&
                   factored_.stiffness == scale.stiffness;
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
  std::vector<Index> blocks_;
  std::vector<E> elements_;
  std::vector<Velocity> force_;
  std::vector<T> mass_;
  std::vector<char> is_held_;
  NodeMatrix<T, E::nodes> matrix_;
  SystemScale factored_;
  bool has_stiffness_ = false, is_factored_ = false;
  mutable std::vector<Velocity> work_, product_;
};

}  // namespace delassus::inner
