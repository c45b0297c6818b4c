/// What friction sees of surfaces that turn with a body that is led, or run beside their body.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/rows/contact_place.hpp>
#include <delassus/rows/surface_motion.hpp>
#include <delassus/rows/world_view.hpp>

#include <algorithm>

namespace delassus {

/// The surfaces of a step, where some move so that H v does not say it.
template <class T>
struct MovingSurfaces {
  const WorldView<T>* world = nullptr;
  bool turn = false;  ///< a kinematic body turns, or a surface
  bool run = false;   ///< a body has a surface velocity

  explicit operator bool() const { return turn || run; }
};

/// Those of a world in a step of h seconds; `view` is of that world.
template <class World>
MovingSurfaces<typename World::Scalar> moving_surfaces(const World& world, const WorldView<typename World::Scalar>& view, double h) {
  MovingSurfaces<typename World::Scalar> moving{&view};
  world.each([&](const auto& set, auto) {
    if constexpr (requires { set.surface_velocities(); }) {
      moving.run = moving.run || set.surface_velocities().are_any();
      moving.turn = moving.turn || set.has_turning_carriers(h) || set.surface_velocities().may_turn();
    }
  });
  return moving;
}

namespace inner {

/// What a body at x from the centre of one that turns by ω goes with besides ω × x, so that it stays where it is on it:
///
///   θ = 1:   (e^{hω^} − 1) x/h,   the chord of its way,
///   θ = ½:   e^{hω^} (ω × x) tan(α/2)/(α/2),   whose mean with that of the step before is the chord,   α = h |ω|.
inline Vec3 bend_of_circle(const Vec3& x, const Vec3& turn, double h, double theta) {
  const double rate = norm(turn), angle = h * rate;
  if (!(angle > 1e-9)) return zero<Vec3>();  // straight to rounding; squares of less may vanish
  const Vec3 along = cross(turn, x), inwards = cross(turn, along);
  const double sine = std::sin(angle), half = std::sin(0.5 * angle);
  if (theta == 1) return (sine / angle - 1) * along + (2 * half * half / (angle * rate)) * inwards;
  const double stretch = angle < 1 ? 2 * std::tan(0.5 * angle) / angle : 1.0;  // beyond, tan has no say: a step is too long
  return (stretch * (1 - 2 * half * half) - 1) * along + (stretch * sine / rate) * inwards;
}

/// How the end that carries turns. One that is led carries. Of two that are pushed, where both turn alike, both do; else
/// the one that the contact is farther from the middle of: a plank under a ball.
inline Vec3 turn_of_carrier(const SurfaceMotion& a, const SurfaceMotion& b, const Vec3& point, const Vec3& normal, bool are_alike) {
  if (a.is_led || !b.is_rigid) return a.turn;
  if (b.is_led || !a.is_rigid) return b.turn;
  const Vec3 to_a = point - a.centre, to_b = point - b.centre;
  double share = squared_norm(cross(to_b, normal));
  const double sum = share + squared_norm(cross(to_a, normal));
  share = are_alike || sum <= 1e-12 * (squared_norm(to_a) + squared_norm(to_b)) ? 0.5 : share / sum;
  return (1 - share) * a.turn + share * b.turn;
}

/// Whether two bodies turn alike, as what lies on a turntable and the table do.
inline bool turn_alike(const SurfaceMotion& a, const SurfaceMotion& b) {
  return 4 * squared_norm(Vec3(b.turn - a.turn)) <= std::max(squared_norm(a.turn), squared_norm(b.turn));
}

/// The surface at the point x as if its body went with it.
inline SurfaceMotion with_running(SurfaceMotion s, const Vec3& x) {
  s.velocity += s.running - cross(s.running_turn, x - s.centre);
  s.turn += s.running_turn;
  return s;
}

/// Rows hold for velocities of the start of the step, u = v_b − v_a at the contact. While the step lasts the carrier turns, and
/// u changes by −ω × (way of b − way of a), half of it in the mean of the step. Where the bodies turn alike they stay together,
/// and that way is known: the circle's.
inline Vec3 turned_away(SurfaceMotion a, SurfaceMotion b, const ContactPlace& c, const Vec3& u, double h, double theta) {
  if (!a.is_rigid && !b.is_rigid) return zero<Vec3>();
  // A node has no turn: it is where the contact is, and goes as that says.
  if (!a.is_rigid) a.centre = *c.point, a.velocity = b.velocity + cross(b.turn, *c.point - b.centre) - u;
  if (!b.is_rigid) b.centre = *c.point, b.velocity = a.velocity + cross(a.turn, *c.point - a.centre) + u;
  const bool are_alike = turn_alike(a, b);
  const Vec3 turn = turn_of_carrier(a, b, *c.point, c.axis(0), are_alike);
  if (are_alike) return -bend_of_circle(b.centre - a.centre, turn, h, theta);
  return (-0.5 * h / theta) * cross(turn, b.velocity - a.velocity);
}

/// Adds to the friction rows of one contact, and to those of its turns. d: its velocities without impulses; start: H v, where the step begins.
template <class T>
void see_moving_surfaces(const MovingSurfaces<T>& moving, const ContactPlace& c, int rows, double h, double theta, T* start, T* d) {
  const Vec3 at = c.friction_point();
  const SurfaceMotion a = moving.world->surface(c.record->a, at), b = moving.world->surface(c.record->b, at);
  Vec3 away = zero<Vec3>();
  if (moving.turn) {
    const Vec3 u = double(start[0]) * c.axis(0) + double(start[1]) * c.axis(1) + double(start[2]) * c.axis(2);
    away = turned_away(with_running(a, at), with_running(b, at), c, u, h, theta);
  }
  const Vec3 running = b.running - a.running;
  for (int k = 1; k < 3; ++k) {
    const double runs = dot(c.axis(k), running);
    start[k] += T(runs);
    d[k] += T(runs + dot(c.axis(k), away));
  }
  for (int k = 3; k < rows; ++k) {
    const T turns = T(dot(c.axis((k - 2) % 3), Vec3(b.running_turn - a.running_turn)));
    start[k] += turns;
    d[k] += turns;
  }
}

}  // namespace inner
}  // namespace delassus
