/// Among normals that are equally good, the one a resting contact keeps from step to step: a face's own.
#pragma once

#include <delassus/collision/certificate.hpp>
#include <delassus/geometry/face.hpp>

#include <concepts>
#include <cstdint>

namespace delassus::inner {

/// Whose face gave the normal of a pair last time.
enum class NormalOwner : std::uint8_t { kernel, a, b };

/// Replaces the certified normal by that of A's or B's supporting face when it is within 0.02 rad and proves
/// a distance no worse than 1e-5 of the scale. Last step's choice has as much in advance, so that two nearly
/// parallel faces do not take turns. Afterwards the normal of a flat contact is exact, whatever the kernel's
/// rounding.
NormalOwner snap_normal_to_face(const std::same_as<Shape> auto& a, const Shape& b, const Pose& b_in_a, double scale,
                                NormalOwner last, SignedPair& r) {
  const double advance = 1e-5 * scale;
  const SignedPair kernel = r;
  NormalOwner owner = NormalOwner::kernel;
  double best = kernel.distance - advance;
  const auto consider = [&](const Vec3& normal, NormalOwner who) {
    if (!(dot(normal, kernel.normal) > 0.9998)) return;
    SignedPair trial = kernel;
    trial.normal = normal;
    const Vec3 reach_a = support(a, normal);
    const Vec3 reach_b = b_in_a.to_world(support(b, Vec3(-transposed_times(b_in_a.rotation, normal))));
    trial.distance = dot(normal, reach_b - reach_a);
    if (!(trial.distance >= kernel.distance - advance)) return;
    const double value = trial.distance + (who == last ? advance : 0.0);
    if (owner != NormalOwner::kernel && !(value > best)) return;
    best = value;
    owner = who;
    put_witnesses(dot(normal, reach_a), dot(normal, reach_b), trial);
    r = trial;
  };
  const Face face_a = face_towards(a, kernel.normal);
  if (face_a.count >= 3) consider(face_a.normal, NormalOwner::a);
  const Face face_b = face_towards(b, Vec3(-transposed_times(b_in_a.rotation, kernel.normal)));
  if (face_b.count >= 3) consider(Vec3(-(b_in_a.rotation * face_b.normal)), NormalOwner::b);
  return owner;
}

}  // namespace delassus::inner
