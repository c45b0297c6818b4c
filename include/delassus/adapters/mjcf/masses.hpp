/// Masses of the bodies, once all of their geoms are known.
#pragma once

#include <delassus/adapters/mjcf/reading.hpp>

#include <algorithm>

namespace delassus::inner::mjcf {

/// What `boundmass`, `boundinertia` and `balanceinertia` make of a body, and what no distribution of mass can
/// have.
inline void bound_mass(const Element& e, const Compiler& c, MassProperties& p) {
  p.mass = std::max(p.mass, c.least_mass);
  PrincipalMoments m = principal_moments(p.inertia);
  // A turn and back is not exact: what needs none keeps its bits.
  bool has_changed = false;
  for (int k = 0; k < 3; ++k)
    if (m.moments[k] < c.least_inertia) {
      m.moments[k] = c.least_inertia;
      has_changed = true;
    }
  const double largest = max_entry(m.moments);
  if (trace(inertia_of(m)) < 2 * largest * (1 - 1e-9)) {
    if (!c.balance_inertia)
      e.refuse("the principal moments " + text(m.moments[0]) + ", " + text(m.moments[1]) + ", " +
               text(m.moments[2]) +
               " kg·m² of the body belong to no distribution of mass: one is larger than the two others "
               "together; say balanceinertia='true' in the compiler to make them equal");
    set_all(m.moments, (m.moments[0] + m.moments[1] + m.moments[2]) / 3);
    has_changed = true;
  }
  if (has_changed) p.inertia = inertia_of(m);
}

inline void set_masses(Reading& r) {
  double all = 0;
  for (std::size_t b = 0; b < r.parts.size(); ++b) {
    const BodyParts& parts = r.parts[b];
    const Compiler& c = parts.source->compiler;
    MassProperties p;
    const bool from_geoms = c.inertia_from_geoms == FromGeoms::always ||
                            (c.inertia_from_geoms == FromGeoms::where_no_inertial && !parts.has_inertial);
    if (parts.has_inertial) p = parts.inertial;
    if (from_geoms && !parts.geoms.empty())
      p = parts.geoms.size() == 1 ? parts.geoms[0] : together(parts.geoms);
    bound_mass(parts.element, c, p);
    if (!(p.mass <= 1e40) || !is_finite(p.centre) || !is_finite(p.inertia) || !(norm(p.inertia) <= 1e40))
      parts.element.refuse("mass and inertia of the body, " + text(p.mass) + " kg and " +
                           text(norm(p.inertia)) + " kg·m², are beyond what can be reckoned with");
    model::Body& body = r.model.bodies[b];
    body.mass = p.mass;
    body.centre = p.centre;
    body.inertia = p.inertia;
    all += p.mass;
  }
  const double total = r.copies.front().source->compiler.total_mass;
  if (!(total > 0) || !(all > 0)) return;
  for (model::Body& body : r.model.bodies) {
    body.mass *= total / all;
    body.inertia *= total / all;
  }
}

/// Refuses a body that a joint moves and that has no mass, nor has what is fixed to it.
inline void expect_masses(const Reading& r) {
  constexpr double least = 1e-15;
  const std::vector<model::Body>& bodies = r.model.bodies;
  std::vector<bool> has(bodies.size(), false);
  for (std::size_t b = bodies.size(); b-- > 0;) {
    const Vec3 m = principal_moments(bodies[b].inertia).moments;
    has[b] = has[b] || (bodies[b].mass >= least && m[2] >= least);
    if (bodies[b].joints.empty() && bodies[b].parent >= 0 && has[b])
      has[std::size_t(bodies[b].parent)] = true;
    if (!bodies[b].joints.empty() && !has[b])
      r.parts[b].element.refuse(
          "joints move the body, and neither it nor what is fixed to it has mass and inertia; give it geoms "
          "with a density, or an inertial");
  }
}

}  // namespace delassus::inner::mjcf
