/// Several convex shapes that are one body, with its mass and inertia.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/geometry/inertia.hpp>
#include <delassus/geometry/support.hpp>

#include <span>
#include <string>
#include <vector>

namespace delassus {

/// A shape, where it stands in the compound (m) and what it is made of (kg/m³).
struct CompoundPart {
  Shape shape{};                        ///< one with a volume
  Vec3 position = zero<Vec3>();         ///< of its origin, m
  Quat orientation = Quat::Identity();  ///< of any length but zero
  double density = 1000;                ///< kg/m³, > 0
};

/// Its frame is moved to the common centre of mass: add the body at the given frame's position + `centre()`.
/// Where parts overlap, both count.
///
///   m = Σ mᵢ,   c = Σ mᵢ cᵢ / m,   I = Σ Rᵢ Iᵢ Rᵢᵀ + mᵢ (|dᵢ|² 1 − dᵢ dᵢᵀ),   dᵢ = cᵢ − c.
class Compound {
 public:
  Compound() = default;  ///< no part, until `memory` reads one
  /// Refuses no part at all, a part without volume, and numbers that are not finite or not > 0. Copies hulls.
  explicit Compound(std::span<const CompoundPart> parts) {
    DELASSUS_EXPECT(!parts.empty(), "a compound needs at least one part");
    std::vector<MassProperties> masses;
    for (std::size_t i = 0; i < parts.size(); ++i)
      masses.push_back(add(parts[i], "compound part #" + std::to_string(i)));
    for (const MassProperties& m : masses) mass_ += m.mass, centre_ += m.mass * m.centre;
    DELASSUS_EXPECT(std::isfinite(mass_) && mass_ > 0,
                    "a compound of " + inner::text(mass_) + " kg; its mass must be finite and > 0");
    centre_ /= mass_;
    for (const MassProperties& m : masses) {
      const Vec3 d = m.centre - centre_;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          inertia_(i, j) += m.inertia(i, j) + m.mass * ((i == j ? squared_norm(d) : 0.0) - d[i] * d[j]);
    }
    for (Pose& pose : poses_) pose.position -= centre_;
  }

  /// Moves the frame of the body to `point` of the frame that the parts were given in, m: for a body whose centre of mass you know
  /// otherwise. `mass` and `inertia` stay those of the parts about their own centre.
  void move_frame(const Vec3& point) {
    for (Pose& pose : poses_) pose.position += centre_ - point;
    centre_ = point;
  }

  Index part_count() const { return Index(shapes_.size()); }  ///< how many shapes there are
  /// Of part i; a hull in it is good as long as the compound.
  Shape shape(Index i) const {
    Shape s = shapes_[i];
    if (hull_of_[i] >= 0) s.hull = &hulls_[hull_of_[i]];
    return s;
  }
  const Pose& pose(Index i) const { return poses_[i]; }  ///< of part i, in the frame of the body

  double mass() const { return mass_; }             ///< kg
  const Vec3& centre() const { return centre_; }    ///< of mass, in the frame the parts were given in, m
  const Mat3& inertia() const { return inertia_; }  ///< about it, kg·m²
  /// Half edges of a box around the centre that holds all parts, m.
  Vec3 reach() const {
    Vec3 reach = zero<Vec3>();
    for (Index i = 0; i < part_count(); ++i) {
      const Aabb box = tight_box(shape(i), poses_[i]);
      for (int k = 0; k < 3; ++k)
        reach[k] = std::max({reach[k], std::abs(box.min()[k]), std::abs(box.max()[k])});
    }
    return reach;
  }

  /// All of it, for checkpoints.
  void memory(auto& archive) { archive(shapes_, poses_, hull_of_, hulls_, mass_, centre_, inertia_); }

 private:
  /// Keeps a part and returns its mass in the given frame.
  MassProperties add(const CompoundPart& part, const std::string& who) {
    check(part.shape, who);
    DELASSUS_EXPECT(part.shape.has_volume(),
                    who + ": a " + name(part.shape.kind) + " has no volume; give a convex shape");
    inner::expect_positive(who + ": density", part.density);
    const double length = norm(part.orientation.coeffs());
    DELASSUS_EXPECT(is_finite(part.position) && std::isfinite(length) && length > 1e-12,
                    who + ": its pose is not finite");
    const Pose pose{part.position, Quat(part.orientation.normalized()).toRotationMatrix()};
    MassProperties m = mass_properties(part.shape, part.density);
    m.centre = pose.to_world(m.centre);
    m.inertia = pose.rotation * m.inertia * Mat3(pose.rotation.transpose());
    shapes_.push_back(part.shape);
    poses_.push_back(pose);
    hull_of_.push_back(part.shape.hull ? Index(hulls_.size()) : -1);
    if (part.shape.hull) hulls_.push_back(*part.shape.hull);
    shapes_.back().hull = nullptr;
    return m;
  }

  std::vector<Shape> shapes_;
  std::vector<Pose> poses_;
  std::vector<Index> hull_of_;
  std::vector<ConvexHull> hulls_;
  double mass_ = 0;
  Vec3 centre_ = zero<Vec3>();
  Mat3 inertia_ = zero<Mat3>();
};

}  // namespace delassus
