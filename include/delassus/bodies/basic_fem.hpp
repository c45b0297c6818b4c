/// Deformable bodies of finite elements, their nodes a structure of arrays.
#pragma once

#include <delassus/bodies/inner/elastic_body.hpp>
#include <delassus/bodies/inner/places.hpp>
#include <delassus/bodies/soft_body.hpp>
#include <delassus/geometry/shape.hpp>
#include <delassus/math/pose.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// q = x, v = ẋ of the nodes. f = m g + loads − ∂Ψ/∂x; A = mass M + stiffness K with M lumped, each
/// element's mass shared out to its nodes, and K = ∂²Ψ/∂x² element by element with its negative part cut.
/// One factor of A a body. Damping is the integrator's: `ImplicitEuler{.rayleigh_mass, .rayleigh_stiffness}`.
///
/// Blocks are nodes. A `Handle` names a node, a `BodyHandle` a body. E is the element.
template <class E, ElasticMaterial M, class T = double>
class BasicFem : public inner::Places<BasicFem<E, M, T>, T, 3> {
  using Places = inner::Places<BasicFem, T, 3>;

 public:
  using Mesh = typename E::Mesh;
  using Body = SoftBody<M, Mesh>;
  using BodyHandle = delassus::Handle<Body>;
  using Places::gravity, Places::v_free, Places::v_next, Places::who;
  using typename Places::Handle, typename Places::Velocity;
  static constexpr const char* kind = "node";

  // --- editing -------------------------------------------------------------------------------------------

  /// Adds a body; throws InvalidArgument when it cannot be one.
  BodyHandle add(const Body& body);

  /// Takes a body out, all its nodes with it.
  void remove(BodyHandle body) {
    const Index k = checked_body(body);
    for (const Index b : bodies_[k].blocks()) {
      inverse_mass_[b] = T(0);
      slots_.give_back(b);
    }
    bodies_[k] = {};
    body_slots_.give_back(k);
  }

  /// Holds a node where it is, as the clamped end of a beam.
  void fix(Handle node, bool is_fixed = true) {
    const Index b = checked(node);
    is_fixed_[b] = is_fixed;
    if (is_fixed) v_[b].setZero();
    hold(b, false);
  }
  void release(Handle node) { fix(node, false); }
  /// Fixes the nodes of a body for whose position (world, m) `where` is true; returns how many.
  Index fix(BodyHandle body, const auto& where) {
    Index count = 0;
    for (const Index b : bodies_[checked_body(body)].blocks())
      if (where(Vec3(x_[b].template cast<double>()))) fix(this->handle(b)), ++count;
    return count;
  }

  /// Adds a force (N) that acts during the next step only.
  void apply_force(Handle node, const Vec3& force) { load_[checked(node)] += force.template cast<T>(); }
  void set_velocity(Handle node, const Vec3& velocity) {
    const Index b = checked(node);
    DELASSUS_EXPECT(inner::fits<T>(velocity), name(b) + ": velocity " + inner::beyond<T>(velocity, "m/s"));
    DELASSUS_EXPECT(!is_fixed_[b], name(b) + ": a fixed node has no velocity; release it first");
    v_[b] = velocity.template cast<T>();
  }
  void place(Handle node, const Vec3& position) {
    const Index b = checked(node);
    DELASSUS_EXPECT(inner::fits<T>(position), name(b) + ": position " + inner::beyond<T>(position, "m"));
    x_[b] = position.template cast<T>();
  }

  // --- reading -------------------------------------------------------------------------------------------

  Index node_count(BodyHandle body) const { return Index(bodies_[checked_body(body)].blocks().size()); }
  /// Node k of a body, numbered as the points of its mesh.
  Handle node(BodyHandle body, Index k) const {
    const auto blocks = bodies_[checked_body(body)].blocks();
    DELASSUS_EXPECT(k >= 0 && k < Index(blocks.size()), body_name(body.index) + " has nodes 0 to " +
                                                            std::to_string(blocks.size() - 1) + ", not " +
                                                            std::to_string(k));
    return this->handle(blocks[k]);
  }
  /// The mesh at rest, where it was put.
  const Mesh& mesh(BodyHandle body) const { return bodies_[checked_body(body)].mesh(); }
  Vec3 position(Handle node) const { return x_[checked(node)].template cast<double>(); }
  using Places::velocity;
  Vec3 velocity(Handle node) const { return v_[checked(node)].template cast<double>(); }
  /// The share of the elements around a node, kg; fixed nodes have theirs too.
  T mass(Index b) const { return mass_[b]; }
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

  bool moves(Index b) const { return inverse_mass_[b] > T(0); }
  void hold(Index b, bool is_held) { inverse_mass_[b] = is_held || is_fixed_[b] ? T(0) : T(1) / mass_[b]; }
  bool may_sleep() const { return false; }

  void factor(SystemScale scale) {
    scale_ = scale;
    each_body([&](auto& body) { body.factor(scale, x_, mass_, inverse_mass_); });
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
        x_[body.blocks()[k]] = body.mesh().points[k].template cast<T>();
    });
    assemble(scale);
    x_ = shifted_x_;
  }
  /// f(k, generation, body, x) for every body, x by blocks.
  void each_system(auto&& f) const {
    for (const Index k : body_slots_.active()) f(k, body_slots_.generation(k), bodies_[k], x_);
  }

  /// The elastic ones are those of the last `factor`.
  void add_forces(std::vector<Velocity>& p) const {
    const Velocity g = gravity.template cast<T>();
    each_body([&](const auto& body) {
      const auto blocks = body.blocks();
      for (std::size_t k = 0; k < blocks.size(); ++k)
        if (moves(blocks[k])) p[blocks[k]] += load_[blocks[k]] + mass_[blocks[k]] * g + body.force()[k];
    });
  }
  void add_stiffness_times_velocity(std::vector<Velocity>& p, double s) const {
    each_body([&](const auto& body) { body.add_stiffness_times_velocity(p, v_, T(s)); });
  }
  void add_mass_times_velocity(std::vector<Velocity>& p, double s) const {
    for (const Index b : slots_.active()) p[b] += T(s) * mass_[b] * v_[b];
  }

  /// The stiffness couples nodes; an explicit integrator leaves it out.
  bool is_coupled() const { return scale_.stiffness != 0; }
  /// f(a, b): what acts on block a moves block b.
  void each_tie(auto&& f) const {
    if (!is_coupled()) return;
    each_body([&](const auto& body) {
      Index last = -1;
      for (const Index b : body.blocks()) {
        if (!moves(b)) continue;
        if (last >= 0) f(last, b);
        last = b;
      }
    });
  }
  void solve(std::vector<Velocity>& x) const {
    each_body([&](const auto& body) { body.solve(x); });
  }
  Index body_of(Index b) const { return body_[b]; }
  /// The number of a block among the nodes of its body.
  Index node_of(Index b) const { return node_[b]; }
  /// A⁻¹ at nodes of one body: what its rows of W are made of.
  void node_compliance(std::span<const Index> blocks, std::span<T> C) const {
    touched_.clear();
    for (const Index b : blocks) touched_.push_back(node_[b]);
    bodies_[body_[blocks.front()]].compliance(touched_, C);
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
    return (weight(a, corner(a, k)) * direction).template cast<T>();
  }
  Vec3 point(const Anchor& a) const {
    if (a.element < 0) return x_[a.block].template cast<double>();
    Vec3 x = Vec3::Zero();
    for (int k = 0; k < E::nodes; ++k)
      x += weight(a, k) * Vec3(x_[body_at(a).block_of(a.element, k)].template cast<double>());
    return x;
  }

  void begin_step(double) {}
  void advance(double h) { advance_with(h, T(0)); }
  void advance_midpoint(double h) { advance_with(h, T(0.5)); }
  void displace(Index b, const Velocity& by) {
    const Velocity moved = x_[b] + by;
    if (is_finite(moved)) x_[b] = moved;
  }
  void shift(double h) {
    shifted_x_ = x_;
    for (const Index b : slots_.active())
      if (moves(b)) x_[b] += T(h) * v_[b];
  }
  void restore() { x_ = shifted_x_; }

  /// f(k, generation, body) for every body of tetrahedra, with `body.mesh()` and `body.blocks()`: for who needs surfaces.
  void each_mesh(auto&& f) const
    requires(E::nodes == 4)
  {
    for (const Index k : body_slots_.active()) f(k, body_slots_.generation(k), bodies_[k]);
  }
  bool has_collider(Index b) const { return slots_.is_alive(b) && radius_[b] > 0; }
  Shape shape(Index b) const { return Sphere{radius_[b]}; }
  Pose pose(Index b) const { return {x_[b].template cast<double>(), Mat3::Identity()}; }

  /// What outlives a step; the handles of the set that wrote it stay with that set.
  void memory(auto& archive) {
    Places::memory(archive);
    archive(body_slots_, x_, shifted_x_, mass_, inverse_mass_, radius_, is_fixed_, body_, node_, bodies_);
  }

 private:
  std::string body_name(Index k) const { return std::string("soft body #") + std::to_string(k); }
  std::string name(Index b) const { return body_name(body_[b]) + ", " + who(b); }
  Index checked_body(BodyHandle body) const {
    DELASSUS_EXPECT(body.owner == this->owner(), "this soft body's handle belongs to another world");
    DELASSUS_EXPECT(body_slots_.is_current(body.index, body.generation),
                    body_name(body.index) + " was removed; its handle is stale");
    return body.index;
  }
  const auto& body_at(const Anchor& a) const { return bodies_[body_[a.block]]; }
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
  void each_body(auto&& f) const {
    for (const Index k : body_slots_.active()) f(bodies_[k]);
  }
  void each_body(auto&& f) {
    for (const Index k : body_slots_.active()) f(bodies_[k]);
  }

  /// x₊ = x + h times the mean velocity. A body with a node whose x₊ is not finite stays where it is, whole.
  void advance_with(double h, T old_share) {
    held_ = 0;
    each_body([&](const auto& body) {
      bool is_sound = true;
      for (const Index b : body.blocks()) {
        load_[b].setZero();
        if (!moves(b)) continue;
        shifted_x_[b] = x_[b] + T(h) * inner::mean(v_[b], v_next[b], old_share);
        is_sound = is_sound && is_finite(shifted_x_[b]);
      }
      held_ += is_sound ? 0 : 1;
      if (!is_sound) return;
      for (const Index b : body.blocks())
        if (moves(b)) x_[b] = shifted_x_[b], v_[b] = v_next[b];
    });
  }

  using Places::checked, Places::slots_, Places::held_, Places::v_, Places::load_;
  SystemScale scale_;
  Slots body_slots_;
  std::vector<inner::ElasticBody<E, M, T>> bodies_;
  std::vector<Velocity> x_, shifted_x_;
  std::vector<T> mass_, inverse_mass_;
  std::vector<double> radius_;
  std::vector<char> is_fixed_;
  std::vector<Index> body_;  ///< of each block
  std::vector<Index> node_;  ///< its number in that body's mesh
  mutable std::vector<Index> touched_;
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
  const Index k = body_slots_.take();
  bodies_.resize(body_slots_.size());
  std::vector<Index> blocks;
  for (const Vec3& p : mesh.points) {
    const Index b = Places::take(body, Velocity(body.velocity.template cast<T>()));
    const std::size_t n = std::size_t(slots_.size());
    for (auto* array : {&x_, &shifted_x_}) array->resize(n);
    for (auto* array : {&mass_, &inverse_mass_}) array->resize(n);
    radius_.resize(n), is_fixed_.resize(n), body_.resize(n), node_.resize(n);
    x_[b] = p.template cast<T>();
    mass_[b] = T(0);
    radius_[b] = 0;
    is_fixed_[b] = 0;
    body_[b] = k;
    node_[b] = Index(blocks.size());
    blocks.push_back(b);
  }
  for (Index e = 0; e < Index(mesh.cells().size()); ++e)
    for (int a = 0; a < E::nodes; ++a)
      mass_[blocks[mesh.cells()[e][a]]] += T(body.density * E::share(mesh, e, a));
  for (const auto& triangle : surface(mesh))
    for (const Index i : triangle) radius_[blocks[i]] = body.contact_radius;
  for (const Index b : blocks) hold(b, false);
  bodies_[k] = {std::move(mesh), body.elasticity, std::move(blocks)};
  return {k, body_slots_.generation(k), this->owner()};
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

#include <delassus/bodies/soft_invariants.hpp>  // its energy and momentum
