/// What closes the loops of a model: couplings of joints and lengths, points and bodies that stay together.
#pragma once

#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/constraints/joints/weld.hpp>
#include <delassus/model/inner/lumps.hpp>
#include <delassus/model/inner/tendon_parts.hpp>

#include <string>

namespace delassus::inner {

/// A coupling of two lengths, or of two joints that `Coupling` does not take: past − c₁ · other's past = c₀.
template <class Builder>
void couple_lengths(Builder& builder, const model::Coupling& coupling) {
  const auto parts_of = [&](Index k) {
    return coupling.of_tendons ? tendon_parts(builder, builder.model().tendons[std::size_t(k)])
                               : joint_parts(builder, k, 1);
  };
  // The length where the tree is as described, of which `past` counts.
  const auto reference = [&](Index k) {
    const TendonParts sum = parts_of(k);
    double length = sum.offset;
    for (const TendonPart& part : sum.parts)
      length += part.coefficient *
                (part.kind == AxisKind::length ? builder.distance(part.a, part.b) : part.position);
    return length;
  };
  TendonParts sum = parts_of(coupling.joint);
  double rest = reference(coupling.joint) + coupling.coefficients[0];
  if (coupling.other >= 0) {
    sum.add(parts_of(coupling.other), -coupling.coefficients[1]);
    rest -= coupling.coefficients[1] * reference(coupling.other);
  }
  if (sum.parts.empty())
    return builder.leave("coupling '" + coupling.name + "' does not act: nothing moves what it couples");
  if (int(sum.parts.size()) > most_tendon_parts)
    return builder.leave("coupling '" + coupling.name + "' does not act: it has more than " +
                         std::to_string(most_tendon_parts) + " parts");
  emit_tendon<Tendon>(builder, "Tendon", sum, [&](auto& item) { item.rest = rest - sum.offset; });
}

template <class A, class B, class Builder>
void couple_axes(Builder& builder, const char* name, const model::Coupling& coupling) {
  const auto& axes = builder.machine().axes;
  const model::Axis &one = axes[std::size_t(coupling.joint)], &other = axes[std::size_t(coupling.other)];
  builder.template emit<Coupling<A, B>>(name, [&] {
    const double ratio = one.sign * other.sign * coupling.coefficients[1];
    return typename Coupling<A, B>::Item{
        .a = one.b,
        .b = other.b,
        .c = one.a,
        .d = other.a,
        .ratio = ratio,
        .phase = one.zero + one.sign * coupling.coefficients[0] - ratio * other.zero,
        .position_a = one.zero,
        .position_b = other.zero};
  });
}

template <class Builder>
void add_coupling(Builder& builder, const model::Coupling& coupling) {
  const auto& c = coupling.coefficients;
  const auto turns = [&](Index j) { return builder.machine().axes[std::size_t(j)].kind == AxisKind::turn; };
  const auto slides = [&](Index j) { return builder.machine().axes[std::size_t(j)].kind == AxisKind::slide; };
  const auto is_simple = [&](Index j) {
    return j >= 0 && (turns(j) || slides(j)) &&
           builder.model().joints[std::size_t(j)].kind != model::JointKind::ball;
  };
  if (c[2] != 0 || c[3] != 0 || c[4] != 0)
    return builder.leave("coupling '" + coupling.name + "' does not act: it is not linear");
  if (coupling.of_tendons || !is_simple(coupling.joint) || !is_simple(coupling.other) ||
      builder.owner(coupling.joint) == builder.owner(coupling.other))
    return couple_lengths(builder, coupling);
  const bool first_turns = turns(coupling.joint), second_turns = turns(coupling.other);
  if (first_turns && second_turns)
    couple_axes<Turn, Turn>(builder, "Coupling<Turn, Turn>{}", coupling);
  else if (first_turns)
    couple_axes<Turn, Slide>(builder, "Coupling<Turn, Slide>{}", coupling);
  else if (second_turns)
    couple_axes<Slide, Turn>(builder, "Coupling<Slide, Turn>{}", coupling);
  else
    couple_axes<Slide, Slide>(builder, "Coupling<Slide, Slide>{}", coupling);
}

template <class Builder>
void add_couplings(Builder& builder) {
  const Model& model = builder.model();
  for (const model::Coupling& coupling : model.couplings) {
    builder.speak_of("coupling", coupling.name);
    add_coupling(builder, coupling);
  }
  for (const model::Connect& connect : model.connects) {
    builder.speak_of("connect", connect.name);
    if (builder.moves_as_one(connect.body, connect.other)) {
      builder.leave("connect '" + connect.name + "' has nothing to hold: its two bodies move as one");
      continue;
    }
    builder.template emit<BallJoint>("BallJoint{}", [&] {
      return BallJoint::Item{
          builder.end(connect.body, builder.world(connect.body).to_world(connect.point)),
          builder.end(connect.other, builder.world(connect.other).to_world(connect.other_point))};
    });
  }
  for (const model::Weld& weld : model.welds) {
    builder.speak_of("weld", weld.name);
    if (builder.moves_as_one(weld.body, weld.other)) {
      builder.leave("weld '" + weld.name + "' has nothing to hold: its two bodies move as one");
      continue;
    }
    const Pose there = Lumps::in(builder.world(weld.body), weld.pose), other = builder.world(weld.other);
    builder.template emit<Weld>("Weld{}", [&] {
      return Weld::Item{builder.end(weld.body, there.position, Quat(there.rotation)),
                        builder.end(weld.other, other.position, Quat(other.rotation))};
    });
  }
}

}  // namespace delassus::inner
