/// The lengths of tendons as sums of coordinates of a loop, and the laws of tendons by their number of parts.
#pragma once

#include <delassus/constraints/joints/tendon.hpp>
#include <delassus/model/machine.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace delassus::inner {

/// length = offset + Σ coefficient · coordinate.
struct TendonParts {
  std::vector<TendonPart> parts;
  std::vector<Index> joints;  ///< of the model, by part; −1 of a length
  double offset = 0;

  void add(const TendonPart& part, Index joint) {
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (joint >= 0 && joints[k] == joint) {
        parts[k].coefficient += part.coefficient;
        return;
      }
    parts.push_back(part), joints.push_back(joint);
  }
  /// factor times another length is added.
  void add(const TendonParts& other, double factor) {
    offset += factor * other.offset;
    for (std::size_t k = 0; k < other.parts.size(); ++k) {
      TendonPart part = other.parts[k];
      part.coefficient *= factor;
      add(part, other.joints[k]);
    }
    for (std::size_t k = parts.size(); k-- > 0;)
      if (!parts[k].is_used())
        parts.erase(parts.begin() + std::ptrdiff_t(k)), joints.erase(joints.begin() + std::ptrdiff_t(k));
  }
};

/// coefficient · q of a joint of the model.
template <class Builder>
TendonParts joint_parts(Builder& builder, Index joint, double coefficient) {
  TendonParts sum;
  const double reference = builder.model().joints[std::size_t(joint)].reference;
  sum.offset = coefficient * reference;
  if (!builder.moves(joint) || coefficient == 0) return sum;
  const model::Axis& axis = builder.machine().axes[std::size_t(joint)];
  sum.offset -= coefficient * axis.sign * axis.zero;
  sum.add({.a = axis.a,
           .b = axis.b,
           .coefficient = coefficient * axis.sign,
           .kind = axis.kind,
           .position = axis.zero},
          joint);
  return sum;
}

/// Of a tendon: of its joints, or of the ways from site to site.
template <class Builder>
TendonParts tendon_parts(Builder& builder, const model::Tendon& tendon) {
  TendonParts sum;
  for (const model::TendonJoint& joint : tendon.joints)
    sum.add(joint_parts(builder, joint.joint, joint.coefficient), 1);
  for (std::size_t k = 1; k < tendon.sites.size(); ++k) {
    const Index from = tendon.sites[k - 1], to = tendon.sites[k];
    const Index one = builder.model().sites[std::size_t(from)].body,
                other = builder.model().sites[std::size_t(to)].body;
    if (builder.moves_as_one(one, other))
      sum.offset += norm(Vec3(builder.site(from) - builder.site(to)));
    else
      sum.add({.a = builder.resolved(builder.end(one, builder.site(from))),
               .b = builder.resolved(builder.end(other, builder.site(to))),
               .coefficient = 1,
               .kind = AxisKind::length},
              -1);
  }
  return sum;
}

inline constexpr int most_tendon_parts = 8;

/// f.operator()<n>() with the least n ≥ `count` for which the builder's loop names Law<n>; 0 where it names
/// none.
template <template <int> class Law, int n = 1, class Builder, class F>
int with_tendon_law(Builder& builder, int count, F&& f) {
  if constexpr (n > most_tendon_parts) {
    return 0;
  } else {
    if constexpr (Builder::template names<Law<n>>) {
      if (count <= n) {
        f.template operator()<n>();
        return n;
      }
    }
    return with_tendon_law<Law, n + 1>(builder, count, f);
  }
}

/// The parts as an array of n.
template <int n>
std::array<TendonPart, std::size_t(n)> array_of(const TendonParts& sum) {
  std::array<TendonPart, std::size_t(n)> parts{};
  for (std::size_t k = 0; k < sum.parts.size(); ++k) parts[k] = sum.parts[k];
  return parts;
}

/// Adds make(parts, n) of a law of tendons, or notes the law; the number of parts of the law.
template <template <int> class Law, class Builder, class Make>
int emit_tendon(Builder& builder, const char* name, const TendonParts& sum, model::ConstraintNumber& number,
                const Make& make) {
  const int count = int(sum.parts.size());
  const int size = with_tendon_law<Law>(builder, count, [&]<int n>() {
    number = builder.template emit<Law<n>>(name, [&] {
      typename Law<n>::Item item{.parts = array_of<n>(sum)};
      make(item);
      return item;
    });
  });
  if (size == 0) builder.miss(std::string(name) + "<" + std::to_string(count) + ">{}");
  return size;
}
template <template <int> class Law, class Builder, class Make>
void emit_tendon(Builder& builder, const char* name, const TendonParts& sum, const Make& make) {
  model::ConstraintNumber number;
  emit_tendon<Law>(builder, name, sum, number, make);
}

}  // namespace delassus::inner
