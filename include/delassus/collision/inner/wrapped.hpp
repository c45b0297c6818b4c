/// What detection that goes around a backend asks of it, whatever kind it is, and in which order it goes around.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/settings.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/core/wrapping.hpp>

#include <vector>

namespace delassus::inner {

/// What the layer `own` may go around: the lower ones, and the first three each other as they like.
template <class Backend, unsigned own>
concept Detects = CollisionBackend<Backend> && Fills<Backend, role::Collision, own> &&
    layers_of<Backend> < (own < layer::compounds ? layer::compounds : own);

template <class Backend>
void check_inside(const Backend& backend) {
  if constexpr (requires { backend.check(); }) backend.check();
}

/// What the backend keeps from step to step, by itself, in its engine or in what it goes around.
template <class Backend>
void remember(Backend& backend, auto& archive) {
  if constexpr (requires { backend.memory(archive); })
    backend.memory(archive);
  else if constexpr (requires { backend.engine->memory(archive); })
    backend.engine->memory(archive);
  else if constexpr (requires { backend.backend; })
    remember(backend.backend, archive);
}

/// Those of the innermost backend.
template <class Backend>
CollisionSettings settings_of(const Backend& backend) {
  if constexpr (requires { backend.backend; })
    return settings_of(backend.backend);
  else
    return {backend.margin, backend.contact_distance, backend.max_points};
}

/// Shows the world to the layer of the backend that asks for it, before it detects.
template <class Backend, class World>
void show_world(Backend& backend, const World& world) {
  if constexpr (requires { backend.see(world); })
    backend.see(world);
  else if constexpr (requires { backend.backend; })
    show_world(backend.backend, world);
}
/// Lets that layer say where the ends of its contacts are, when these are not at the bodies' own anchors.
template <class Backend, class Results>
void place_ends(const Backend& backend, Results& results) {
  if constexpr (requires { backend.place_ends(results); })
    backend.place_ends(results);
  else if constexpr (requires { backend.backend; })
    place_ends(backend.backend, results);
}

/// The order in which every backend answers: by pair, then by feature.
inline void sort_by_name(std::vector<ContactPoint>& contacts) {
  inner::sort(contacts, [](const ContactPoint& p, const ContactPoint& q) {
    return p.pair != q.pair ? p.pair < q.pair : p.feature < q.feature;
  });
}

}  // namespace delassus::inner
