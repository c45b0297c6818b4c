/// Deformable bodies of finite elements, their nodes a structure of arrays.
#pragma once

#include <delassus/bodies/inner/point_storage.hpp>
#include <delassus/core/array.hpp>
#include <delassus/fem/inner/bodies_of_nodes.hpp>
#include <delassus/fem/inner/elastic_body.hpp>
#include <delassus/fem/inner/elastic_workers.hpp>
#include <delassus/fem/soft_body.hpp>

#include <algorithm>
#include <concepts>
#include <string>
#include <utility>

namespace delassus {

/// q = x, v = ẋ of the nodes. f = m g + loads − ∂Ψ/∂x; A = mass M + stiffness K with M lumped, each
/// element's mass shared out to its nodes, and K = ∂²Ψ/∂x² element by element with its negative part cut.
/// One factor of A a body. Damping is the integrator's: `ImplicitEuler{.rayleigh_mass, .rayleigh_stiffness}`.
///
/// Blocks are nodes. E is the element.
template <class E, ElasticMaterial M, class T = double>
class BasicFem : public inner::BodiesOfNodes<BasicFem<E, M, T>, inner::PointStorage<BasicFem<E, M, T>, T>,
                                             SoftBody<M, typename E::Mesh>, inner::ElasticBody<E, M, T>> {
  using Nodes = typename BasicFem::BodiesOfNodes;

 public:
  using Mesh = typename E::Mesh;
  using Nodes::gravity, Nodes::moves, Nodes::name, Nodes::v_free, Nodes::v_next;
  using typename Nodes::Body, typename Nodes::BodyHandle, typename Nodes::Handle, typename Nodes::Velocity;
  static constexpr const char* body_kind = "soft body";

  BasicFem() = default;
  /// `auto set = bodies<...>(loop.world());` is a copy of which its loop knows nothing.
  template <std::same_as<BasicFem> Set>
  [[deprecated("delassus: a copy of a set of bodies, which its loop does not see; write `auto&` for the set of a "
               "loop, or std::as_const(set) for a copy that is meant")]] BasicFem(Set& set)
      : BasicFem(std::as_const(set)) {}

  // --- editing -------------------------------------------------------------------------------------------

  /// Adds a body; throws InvalidArgument when it cannot be one.
  BodyHandle add(const Body& body);

  void set_velocity(Handle node, const Vec3& velocity) {
    const Index b = checked(node);
    DELASSUS_EXPECT(inner::fits<T>(velocity), name(b) + ": velocity " + inner::beyond<T>(velocity, "m/s"));
    DELASSUS_EXPECT(!is_fixed_[b], name(b) + ": a fixed node has no velocity; release it first");
    v_[b] = converted<T>(velocity);
  }
  void place(Handle node, const Vec3& position) {
    const Index b = checked(node);
    DELASSUS_EXPECT(inner::fits<T>(position), name(b) + ": position " + inner::beyond<T>(position, "m"));
    x_[b] = converted<T>(position);
  }

  // --- reading -------------------------------------------------------------------------------------------

  /// The mesh at rest, where it was put.
  const Mesh& mesh(BodyHandle body) const { return bodies_[this->checked_body(body)].mesh(); }
  /// ∫Ψ of all bodies where they are now, J. Evaluates every element.
  double elastic_energy() const {
    double sum = 0;
    each_body([&](const auto& body) { sum += body.energy(x_); });
    return sum;
  }
  /// A material point of a body, by where it is now (world, m): a joint's end, held by the nodes around
  /// it. Refuses a point outside of every element by more than 1e-6 of its size.
  Anchor anchor_at(BodyHandle body, const Vec3& point) const;

  // --- what the loop asks: the BodySet concept -----------------------------------------------------------

  void set_fixed(Index b, bool is_held) { inverse_mass_[b] = is_held || is_fixed_[b] ? T(0) : T(1) / mass_[b]; }

  void factor(SystemScale scale) {
    scale_ = scale;
    each_body([&](auto& body) { body.factor(scale, x_, mass_, inverse_mass_); });
  }
  /// What several workers keep.
  using Workers = inner::ElasticWorkers<inner::ElasticBody<E, M, T>>;
  /// The same by several workers, with the same bits.
  template <class Ex>
  void factor(SystemScale scale, Workers& by, const Ex& execution) {
    scale_ = scale;
    by.sort(body_slots_.active(), execution.workers(),
            [&](Index k) { return Index(bodies_[k].blocks().size()); });
    for (const Index k : by.large)
      bodies_[k].factor(scale, x_, mass_, inverse_mass_, by, by.at(k), execution);
    by.each_small(execution, [&](Index k) { bodies_[k].factor(scale, x_, mass_, inverse_mass_); });
  }
  /// Elastic forces and A without its factor, for a compliance that has one of its own.
  void assemble(SystemScale scale) {
    scale_ = scale;
    each_body([&](auto& body) { body.assemble(scale, x_, mass_, inverse_mass_); });
  }
  /// The same with all nodes where they are at rest.
  void assemble_at_rest(SystemScale scale) {
    shifted_x_ = x_;
    each_body([&](const auto& body) {
      for (std::size_t k = 0; k < body.blocks().size(); ++k)
        x_[body.blocks()[k]] = converted<T>(body.mesh().points[k]);
    });
    assemble(scale);
    x_ = shifted_x_;
  }
  /// f(k, number, body, x) for every body, x by blocks.
  void each_system(auto&& f) const {
    for (const Index k : body_slots_.active()) f(k, bodies_[k].number(), bodies_[k], x_);
  }

  /// The elastic ones are those of the last `factor`.
  void add_forces(std::span<Velocity> p) const {
    const Velocity g = converted<T>(gravity);
    each_body([&](const auto& body) {
      const auto blocks = body.blocks();
      for (std::size_t k = 0; k < blocks.size(); ++k)
        if (moves(blocks[k])) p[blocks[k]] += load_[blocks[k]] + mass_[blocks[k]] * g + body.force()[k];
    });
  }

  template <int C>
  Mat<3, C, T> solve_mass(Index b, const Mat<3, C, T>& x) const {
    return (T(1 / scale_.mass) * inverse_mass_[b]) * x;
  }
  template <int C>
  Mat<3, C, T> solve_block(Index b, const Mat<3, C, T>& x) const {
    return solve_mass<C>(b, x);
  }

  /// Of an element those of its corners that have a share in the point, the fixed ones with A⁻¹ = 0.
  int anchor_blocks(const Anchor& a) const {
    if (a.element < 0) return moves(a.block) ? 1 : 0;
    int count = 0;
    for (int k = 0; k < E::nodes; ++k) count += weight(a, k) != 0 ? 1 : 0;
    return count;
  }
  Index anchor_block(const Anchor& a, int k) const {
    return a.element >= 0 ? body_at(a).block_of(a.element, corner(a, k)) : a.block;
  }
  Velocity along(const Anchor& a, int k, const Vec3&, const Vec3& direction) const {
    return converted<T>(weight(a, corner(a, k)) * direction);
  }
  Vec3 point(const Anchor& a) const {
    if (a.element < 0) return converted<double>(x_[a.block]);
    Vec3 x = Vec3::Zero();
    for (int k = 0; k < E::nodes; ++k)
      x += weight(a, k) * Vec3(converted<double>(x_[body_at(a).block_of(a.element, k)]));
    return x;
  }

  void advance(double h) { advance_with(h, T(0)); }
  void advance_midpoint(double h) { advance_with(h, T(0.5)); }

  /// f(k, number, body) for every body, with `body.mesh()` and `body.blocks()`: for who needs surfaces.
  void each_mesh(auto&& f) const {
    for (const Index k : body_slots_.active()) f(k, bodies_[k].number(), bodies_[k]);
  }

  void memory(auto& archive) {
    Nodes::memory(archive);
    archive(x_, shifted_x_, mass_, inverse_mass_, radius_);
  }

 private:
  const auto& body_at(const Anchor& a) const { return this->elastic(a.block); }
  static double weight(const Anchor& a, int k) {
    if (a.element < 0) return 1;
    return E::weight(a.local, k);
  }
  /// The k-th corner of the element that has a share in the point.
  static int corner(const Anchor& a, int k) {
    if (a.element < 0) return 0;
    int at = 0;
    for (;; ++at)
      if (weight(a, at) != 0 && k-- == 0) return at;
  }
  /// x₊ = x + h times the mean velocity. A body with a node whose x₊ is not finite stays where it is, whole.
  void advance_with(double h, T old_share) {
    quarantine_ = {};
    each_body([&](const auto& body) {
      bool is_sound = true;
      for (const Index b : body.blocks()) {
        if (!moves(b)) continue;
        shifted_x_[b] = x_[b] + T(h) * inner::mean(v_[b], v_next[b], old_share);
        is_sound = is_sound && is_finite(shifted_x_[b]);
      }
      if (!is_sound) this->note_held(body);
      for (const Index b : body.blocks()) {
        load_[b].setZero();
        if (is_sound && moves(b)) x_[b] = shifted_x_[b], v_[b] = v_next[b];
      }
    });
  }

  using Nodes::bodies_, Nodes::body_slots_, Nodes::scale_;
  using Nodes::checked, Nodes::checked_body, Nodes::body_name, Nodes::each_body;
  using Nodes::slots_, Nodes::quarantine_, Nodes::v_, Nodes::load_, Nodes::is_fixed_;
  using Nodes::x_, Nodes::shifted_x_, Nodes::mass_, Nodes::inverse_mass_, Nodes::radius_;
};

template <class E, ElasticMaterial M, class T>
auto BasicFem<E, M, T>::add(const Body& body) -> BodyHandle {
  inner::check_soft_body<T>(body, body_name(body_slots_.size()));
  Mesh mesh = body.mesh;
  for (Vec3& p : mesh.points) {
    p = body.position + body.orientation * p;
    DELASSUS_EXPECT(inner::fits<T>(p),
                    body_name(body_slots_.size()) + ": a node at " + inner::beyond<T>(p, "m"));
  }
  inner::check_placed(mesh, body.position, body_name(body_slots_.size()));
  const Index k = this->take_body(body.material);
  Array<Index> blocks;
  for (const Vec3& p : mesh.points) {
    const Index b =
        this->take_node(body, k, Index(blocks.size()), Velocity(converted<T>(body.velocity)));
    x_[b] = converted<T>(p);
    mass_[b] = T(0);
    radius_[b] = 0;
    blocks.push_back(b);
  }
  for (Index e = 0; e < Index(mesh.cells().size()); ++e)
    for (int a = 0; a < E::nodes; ++a)
      mass_[blocks[mesh.cells()[e][a]]] += T(body.density * E::share(mesh, e, a));
  for (const auto& triangle : surface(mesh))
    for (const Index i : triangle) radius_[blocks[i]] = body.contact_radius;
  return this->give(k, {std::move(mesh), body.elasticity, std::move(blocks)});
}

template <class E, ElasticMaterial M, class T>
Anchor BasicFem<E, M, T>::anchor_at(BodyHandle body, const Vec3& point) const {
  const auto& soft = bodies_[checked_body(body)];
  Anchor anchor{.has_frame = false, .owner = this->owner()};
  anchor.element = soft.locate(point, x_, anchor.local);
  DELASSUS_EXPECT(anchor.element >= 0, "anchor_at: the point " + inner::text(point) + " m is in no " +
                                           Mesh::cell + " of " + body_name(body.index));
  anchor.block = soft.block_of(anchor.element, 0);
  anchor.generation = slots_.generation(anchor.block);
  return anchor;
}

}  // namespace delassus

#include <delassus/fem/soft_invariants.hpp>  // its energy and momentum
#include <span>
