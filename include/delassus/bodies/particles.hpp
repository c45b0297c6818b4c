/// Point masses as a structure of arrays, with springs between them and to points of the world.
#pragma once

#include <delassus/bodies/inner/particle_path.hpp>
#include <delassus/bodies/inner/point_storage.hpp>
#include <delassus/bodies/springs.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/rows/body_set.hpp>

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace delassus {

/// A particle as it is added. SI units. `radius` > 0 (m) makes it a sphere for collision, without rotation.
struct Particle {
  Vec3 position = zero<Vec3>();       ///< world, m
  Vec3 velocity = zero<Vec3>();       ///< world, m/s; zero of a fixed one
  std::optional<double> mass{};       ///< kg, > 0; may be left out of a fixed one, which has none
  double radius = 0;                  ///< m; 0: it meets nothing
  bool is_fixed = false;              ///< it never moves, whatever acts on it
  Index material = 0;  ///< a number that `Materials` gave; 0: the law's own friction and restitution
  std::uint32_t group = 1;            ///< a bit for every group it is in
  std::uint32_t collides_with = ~0u;  ///< the groups it meets; two bodies meet where both masks say so
};

/// q = x, v = ẋ. f = m g + loads + springs; A = mass M + damping D + stiffness K of the springs (`Springs`).
template <class T>
class BasicParticles : public inner::PointStorage<BasicParticles<T>, T> {
  using PointStorage = inner::PointStorage<BasicParticles, T>;

 public:
  using Body = Particle;  ///< what `add` takes
  using typename PointStorage::Handle, typename PointStorage::Velocity;
  using PointStorage::gravity, PointStorage::moves, PointStorage::v_free, PointStorage::v_next, PointStorage::who;
  static constexpr const char* kind = "particle";  ///< its word in messages, as in "particle #3"

  BasicParticles() = default;
  /// `auto set = bodies<...>(loop.world());` is a copy of which its loop knows nothing.
  template <std::same_as<BasicParticles> Set>
  [[deprecated("delassus: a copy of a set of bodies, which its loop does not see; write `auto&` for the set of a "
               "loop, or std::as_const(set) for a copy that is meant")]] BasicParticles(Set& set)
      : BasicParticles(std::as_const(set)) {}

  // --- editing -------------------------------------------------------------------------------------------------

  /// Adds a particle; throws InvalidArgument when it cannot be one.
  Handle add(const Particle& particle);

  /// Takes a particle out, and with it the springs that hold it.
  void remove(Handle particle) {
    const Index b = checked(particle);
    springs_.remove_of(b);
    slots_.release(b);
    inverse_mass_[b] = T(0);
  }

  /// A spring of stiffness k (N/m), damping c (N·s/m) and rest length (m; their distance now when not given).
  void add_spring(Handle a, Handle b, double stiffness, double damping = 0, std::optional<double> rest = {}) {
    const Index i = checked(a), j = checked(b);
    const double now = converted<double>(x_[i] - x_[j]).norm();
    springs_.add({i, j, zero<Vec3>(), stiffness, damping, rest.value_or(now)}, who(i));
  }
  /// The same to a point of the world (m).
  void add_spring(Handle a, const Vec3& point, double stiffness, double damping = 0, std::optional<double> rest = {}) {
    const Index i = checked(a);
    const double now = norm(converted<double>(x_[i]) - point);
    springs_.add({i, -1, point, stiffness, damping, rest.value_or(now)}, who(i));
  }

  /// World, m/s. Refuses a fixed particle, and numbers that are not finite.
  void set_velocity(Handle particle, const Vec3& velocity) {
    const Index b = checked(particle);
    check_velocity(velocity, b);
    DELASSUS_EXPECT(mass_[b] > T(0), who(b) + ": a fixed particle has no velocity");
    v_[b] = converted<T>(velocity);
  }
  /// Puts it elsewhere at once (world, m), its velocity unchanged.
  void place(Handle particle, const Vec3& position) {
    const Index b = checked(particle);
    check_position(position, b);
    x_[b] = converted<T>(position);
  }

  // --- reading -------------------------------------------------------------------------------------------------

  /// Σ k (l − L)²/2 over all springs, J.
  double spring_energy() const { return springs_.energy(x_); }

  // --- what the loop asks: the BodySet concept -----------------------------------------------------------------

  /// Takes a particle's answer to impulses away (A⁻¹ = 0), or gives it back.
  void set_fixed(Index b, bool is_held) { inverse_mass_[b] = is_held || !(mass_[b] > T(0)) ? T(0) : T(1) / mass_[b]; }
  /// Springs tie particles together outside of every island: while there are any, none sleeps.
  bool may_sleep() const { return springs_.is_empty(); }

  /// 1/m, mass scale and springs aside.
  T inverse_mass(Index b) const { return inverse_mass_[b]; }

  void factor(SystemScale scale) { springs_.factor(scale, x_, mass_, inverse_mass_, slots_.active()); }

  void add_forces(std::span<Velocity> p) const {
    const Velocity g = converted<T>(gravity);
    for (const Index b : slots_.active())
      if (moves(b)) p[b] += load_[b] + mass_[b] * g;
    springs_.add_forces(p, x_, v_);
  }
  /// p += s ∂f/∂q v: what the forces change while the set moves with its present velocity.
  void add_stiffness_times_velocity(std::span<Velocity> p, double s) const {
    springs_.add_stiffness_times_velocity(p, x_, v_, T(s));
  }

  /// True when A has entries between particles: then only `solve` is right, never `solve_block`.
  bool is_coupled() const { return springs_.is_coupled(); }
  /// f(a, b): what acts on particle a moves particle b.
  void each_tie(auto&& f) const { springs_.each_tie(f); }
  /// x ← A⁻¹ x for the whole set.
  void solve(std::span<Velocity> x) const { springs_.solve(x); }
  /// What A⁻¹ would be of the masses alone: for `UncoupledCompliance`.
  template <int C>
  Mat<3, C, T> solve_mass(Index b, const Mat<3, C, T>& x) const {
    return springs_.solve_mass(b, x);
  }
  /// A_b⁻¹ x for each column of x, a spring to the world included.
  template <int C>
  Mat<3, C, T> solve_block(Index b, const Mat<3, C, T>& x) const {
    return springs_.solve_block(b, x);
  }

  /// Nothing moves it at any time.
  bool never_moves(Index b) const { return !(mass_[b] > T(0)); }
  int anchor_blocks(const Anchor& a) const { return moves(a.block) ? 1 : 0; }
  Index anchor_block(const Anchor& a, int) const { return a.block; }
  Velocity along(const Anchor&, int, const Vec3&, const Vec3& direction) const { return converted<T>(direction); }
  Vec3 point(const Anchor& a) const { return converted<double>(x_[a.block]); }  ///< world, m

  /// x₊ = x + h v_next. A particle whose x₊ is not finite stays where it is.
  void advance(double h) { advance_with(h, T(0)); }
  /// x₊ = x + h (v + v_next)/2.
  void advance_midpoint(double h) { advance_with(h, T(0.5)); }

  /// One particle at a time, springs aside. The addresses are fetched once, so that no store makes a loop fetch them anew.
  struct Blocks {
    /// @var x
    /// World, m, by block.
    /// @var v
    /// World, m/s, at the start of the step.
    Velocity *x, *v, *load;  ///< N; taken when the particle has moved
    /// kg; 0 of a fixed one.
    const T *mass, *inverse_mass;  ///< 1/kg; 0 of what does not move
    Velocity gravity;                 ///< m/s²
    T inverse_scale;                  ///< 1 / `SystemScale::mass`
    inner::QuarantineRecord* record;  ///< notes who was left where it was

    bool moves(Index b) const { return inverse_mass[b] > T(0); }
    const Velocity& velocity(Index b) const { return v[b]; }  ///< m/s, at the start of the step
    /// p += load + m g, N.
    void add_force(Index b, Velocity& p) const { p += load[b] + mass[b] * gravity; }
    /// p += s m v, kg·m/s where s is 1.
    void add_mass_times_velocity(Index b, Velocity& p, double s) const { p += T(s) * mass[b] * v[b]; }
    Velocity solve(Index b, const Velocity& p) const { return (inverse_scale * inverse_mass[b]) * p; }
    /// x and v from v_next; `old_share` of the old velocity in the mean that moves x.
    void advance(Index b, const Velocity& next, double h, T old_share) const {
      if (!moves(b)) return set_zero(load[b]);
      const Velocity moved = x[b] + T(h) * inner::mean(v[b], next, old_share);
      if (!is_finite(moved)) [[unlikely]] return record->leave(load, load[b]);
      x[b] = moved;
      v[b] = next;
      set_zero(load[b]);
    }
  };
  /// Opens the set for one pass over its blocks, and forgets who was left before.
  Blocks by_block(SystemScale scale = {}) {
    quarantine_ = {};
    return {.x = x_.data(),
            .v = v_.data(),
            .load = load_.data(),
            .mass = mass_.data(),
            .inverse_mass = inverse_mass_.data(),
            .gravity = converted<T>(gravity),
            .inverse_scale = T(1 / scale.mass),
            .record = &quarantine_};
  }
  /// True when no spring joins anything: every particle moves by itself.
  bool is_separable() const { return springs_.is_empty(); }
  bool is_alone(Index b) const { return !springs_.holds(b); }  ///< no spring joins this one to anything

  /// What a scheme that finds x and v of the end itself does with each particle; it leaves x there, and v_next.
  using Path = inner::ParticlePath<T>;
  auto& state() { return x_; }  ///< places, m: what `Path` works on
  /// v ← v_next of what moves, whose x is there already; loads are taken.
  void finish_step(double) {
    quarantine_ = {};
    for (const Index b : slots_.active()) {
      if (moves(b) && is_finite(v_next[b])) v_[b] = v_next[b];
      else if (moves(b)) quarantine_.leave(load_.data(), load_[b]);
      set_zero(load_[b]);
    }
  }

  /// What outlives a step; handles of the set that wrote it stay with that set.
  void memory(auto& archive) {
    PointStorage::memory(archive);
    archive(springs_, x_, mass_, inverse_mass_, radius_);
  }

 private:
  void check_position(const Vec3& position, Index b) const {
    DELASSUS_EXPECT(is_finite(position), who(b) + ": position is not finite");
    DELASSUS_EXPECT(inner::fits<T>(position), who(b) + ": position " + inner::beyond<T>(position, "m"));
  }
  void check_velocity(const Vec3& velocity, Index b) const {
    DELASSUS_EXPECT(is_finite(velocity), who(b) + ": velocity is not finite");
    DELASSUS_EXPECT(inner::fits<T>(velocity), who(b) + ": velocity " + inner::beyond<T>(velocity, "m/s"));
  }
  void advance_with(double h, T old_share) {
    const Blocks blocks = by_block();
    for (const Index b : slots_.active()) blocks.advance(b, v_next[b], h, old_share);
  }

  using PointStorage::checked, PointStorage::slots_, PointStorage::quarantine_, PointStorage::v_, PointStorage::load_;
  using PointStorage::x_, PointStorage::mass_, PointStorage::inverse_mass_, PointStorage::radius_;
  Springs<T> springs_;
};

using Particles = BasicParticles<double>;  ///< in double
using ParticlesF = BasicParticles<float>;  ///< in float

template <class T>
typename BasicParticles<T>::Handle BasicParticles<T>::add(const Particle& particle) {
  const Index next = slots_.size();
  const std::string name = who(next);
  check_position(particle.position, next);
  check_velocity(particle.velocity, next);
  DELASSUS_EXPECT(particle.is_fixed || particle.mass, name + ": give mass (kg), or is_fixed");
  if (particle.mass) {
    const double mass = *particle.mass;
    inner::expect_positive(name + ": mass", mass);
    DELASSUS_EXPECT(inner::has_inverse<T>(mass), name + ": mass " + inner::without_inverse<T>(inner::text(mass), "kg"));
  }
  inner::expect_not_negative(name + ": radius", particle.radius);
  const Index b = PointStorage::take(particle, particle.is_fixed ? Velocity(zero<Velocity>())
                                                            : Velocity(converted<T>(particle.velocity)));
  x_[b] = converted<T>(particle.position);
  mass_[b] = particle.is_fixed ? T(0) : T(*particle.mass);
  inverse_mass_[b] = particle.is_fixed ? T(0) : T(1 / *particle.mass);
  radius_[b] = particle.radius;
  return this->handle(b);
}

}  // namespace delassus
