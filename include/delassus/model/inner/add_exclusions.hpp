/// Which bodies of a machine never meet: what the model excludes, and what a joint holds to a link that the
/// world holds.
#pragma once

#include <delassus/model/inner/add_shapes.hpp>
#include <delassus/model/inner/machine_builder.hpp>

#include <type_traits>

namespace delassus::inner {

template <class Builder>
void ignore(Builder& builder, auto& filter, Index one, Index other) {
  const bool is_one_still = builder.is_in_world(one), is_other_still = builder.is_in_world(other);
  if (is_one_still && is_other_still) return;
  if (is_one_still) return ignore(builder, filter, other, one);
  const auto& world = builder.loop().world();
  const RigidBodies::Handle body = builder.machine().parts[std::size_t(one)].body;
  if (!is_other_still) {
    const RigidBodies::Handle against = builder.machine().parts[std::size_t(other)].body;
    if (body.index != against.index)
      filter.ignore(world, anchor(builder.set(), body), anchor(builder.set(), against));
    return;
  }
  for (const Still& still : builder.still())
    if (still.link == other)
      filter.ignore(world, anchor(builder.set(), body), anchor(builder.set(), still.body));
}

inline Index root_link_of(const Model& model, Index body) {
  while (model.bodies[std::size_t(body)].parent >= 0) body = model.bodies[std::size_t(body)].parent;
  return body;
}

/// A joint to the world names no body that a filter could ask for.
template <class Builder>
void exclude_what_hangs(Builder& builder, auto& filter) {
  const Model& model = builder.model();
  for (const Chain& chain : builder.chains()) {
    const Index parent = model.bodies[std::size_t(chain.body)].parent;
    if (parent < 0 || !builder.machine().parts[std::size_t(parent)].is_world) continue;
    for (const Still& still : builder.still())
      if (still.link >= 0 && root_link_of(model, still.link) == root_link_of(model, parent))
        ignore(builder, filter, chain.body, still.link);
  }
}

template <class Builder>
void add_exclusions(Builder& builder) {
  if (!builder.has_contacts()) return;
  if constexpr (Builder::collides) {
    auto* filter = filter_layer(builder.backend(), builder.loop().world());
    if constexpr (std::is_same_v<decltype(filter), int*>) {
      if (!builder.model().excludes.empty()) builder.miss("WithFilter{...}");
    } else if (!builder.is_looking()) {
      for (const model::Exclude& pair : builder.model().excludes)
        ignore(builder, *filter, pair.body, pair.other);
      if (!builder.model().parents_collide) exclude_what_hangs(builder, *filter);
    }
  }
}

}  // namespace delassus::inner
