/// Limits, springs and dry friction of the tendons of a model.
#pragma once

#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/model/inner/tendon_parts.hpp>

#include <string>

namespace delassus::inner {

/// Between two points there are laws of one length.
inline bool is_plain_length(const TendonParts& sum) {
  return sum.parts.size() == 1 && sum.parts[0].kind == AxisKind::length && sum.parts[0].coefficient == 1;
}

template <class Builder>
void add_string(Builder& builder, const model::Tendon& tendon, const TendonParts& sum, double stiffness,
                double damping) {
  const Anchor &a = sum.parts[0].a, &b = sum.parts[0].b;
  if (tendon.is_limited && !builder.leave_out().limits)
    builder.template emit<Limit<Length>>("Limit<Length>{}", [&] {
      return Limit<Length>::Item{
          .a = a, .b = b, .lower = tendon.lower - sum.offset, .upper = tendon.upper - sum.offset};
    });
  if (stiffness > 0 || damping > 0)
    builder.template emit<SpringDamper<Length>>("SpringDamper<Length>{}", [&] {
      return SpringDamper<Length>::Item{
          .a = a, .b = b, .rest = tendon.rest_lower - sum.offset, .stiffness = stiffness, .damping = damping};
    });
  if (tendon.friction_loss > 0 && !builder.leave_out().friction_loss)
    builder.template emit<Motor<Length>>("Motor<Length>{}", [&] {
      return Motor<Length>::Item{.a = a, .b = b, .max_force = tendon.friction_loss};
    });
}

template <class Builder>
void add_tendon(Builder& builder, const model::Tendon& tendon) {
  const LeaveOut& leave_out = builder.leave_out();
  builder.speak_of("tendon", tendon.name);
  const double stiffness = leave_out.springs ? 0 : tendon.stiffness,
               damping = leave_out.damping ? 0 : tendon.damping;
  const bool acts =
      tendon.is_limited || tendon.stiffness > 0 || tendon.damping > 0 || tendon.friction_loss > 0;
  if (!acts) return;
  const TendonParts sum = tendon_parts(builder, tendon);
  if (sum.parts.empty())
    return builder.leave("tendon '" + tendon.name + "' does not act: nothing moves its length");
  if (int(sum.parts.size()) > most_tendon_parts)
    return builder.leave("tendon '" + tendon.name + "' does not act: it has more than " +
                         std::to_string(most_tendon_parts) + " parts");
  if (stiffness > 0 && tendon.rest_lower != tendon.rest_upper)
    builder.leave("the spring of tendon '" + tendon.name +
                  "' is at rest at its lower length, not between two");
  if (is_plain_length(sum)) return add_string(builder, tendon, sum, stiffness, damping);
  if (tendon.is_limited && !leave_out.limits)
    emit_tendon<TendonLimit>(builder, "TendonLimit", sum, [&](auto& item) {
      item.lower = tendon.lower - sum.offset, item.upper = tendon.upper - sum.offset;
      if (tendon.joints.empty()) item.margin = Length::limit_margin;
    });
  if (stiffness > 0 || damping > 0)
    emit_tendon<Tendon>(builder, "Tendon", sum, [&](auto& item) {
      item.rest = tendon.rest_lower - sum.offset, item.stiffness = stiffness, item.damping = damping;
    });
  if (tendon.friction_loss > 0 && !leave_out.friction_loss)
    emit_tendon<TendonMotor>(builder, "TendonMotor", sum,
                             [&](auto& item) { item.max_force = tendon.friction_loss; });
}

template <class Builder>
void add_tendons(Builder& builder) {
  for (const model::Tendon& tendon : builder.model().tendons) add_tendon(builder, tendon);
}

}  // namespace delassus::inner
