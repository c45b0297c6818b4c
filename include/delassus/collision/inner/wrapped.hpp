/// What detection that goes around a backend asks of it, whatever kind it is, and in which order it goes around.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/settings.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/core/wrapping.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace delassus::inner {

/// What the layer `own` may go around: the lower ones, and the first three each other as they like.
template <class Backend, unsigned own>
concept Detects = CollisionBackend<Backend> && Fills<Backend, role::Collision, own> &&
    layers_of<Backend> < (own < layer::compounds ? layer::compounds : own);

/// A filter that also says of a pair whether it pushed in the last step. With it pairs that are apart get contacts only where
/// they meet.
template <class F>
concept KnowsWhoPushed = requires(const F& filter, std::uint64_t pair) { bool(filter.pushed(pair)); };

/// One that also says of a pair with contacts of an impact to come whether it is to lose them: it asks meets(a, b) by the velocities
/// that the two would have without them.
template <class F>
concept KnowsWhoMisses = requires(const F& filter, std::uint64_t pair, const Collider& c) {
  bool(filter.misses(pair, c, c, [](const Collider&, const Collider&) { return true; }));
};

/// A backend that leaves out pairs which are apart, and finds those of them that meet after all.
template <class Backend, class Filter>
concept DetectsMissed = KnowsWhoPushed<Filter> && requires(Backend& backend, std::span<const Collider> colliders, std::vector<ContactPoint>& contacts, const Filter& filter) {
  backend.detect(colliders, 1.0, contacts, filter);
  backend.detect_missed(colliders, 1.0, contacts, filter);
};

/// f(layer) of the outermost layer that can take it, or of the backend within; nothing where none can.
template <class Backend, class F>
void ask_layer(Backend& backend, const F& f) {
  if constexpr (requires { f(backend); }) f(backend);
  else if constexpr (requires { backend.backend; }) ask_layer(backend.backend, f);
}

/// What the backend keeps from step to step.
void remember(auto& backend, auto& archive) {
  ask_layer(backend, [&](auto& layer) -> decltype(layer.memory(archive)) { return layer.memory(archive); });
}

/// Those of the innermost backend.
template <class Backend>
CollisionSettings settings_of(const Backend& backend) {
  if constexpr (requires { backend.backend; }) return settings_of(backend.backend);
  else return {backend.margin, backend.contact_distance, backend.max_points};
}

/// Shows the world to the layer of the backend that asks for it, before it detects.
void show_world(auto& backend, const auto& world) {
  ask_layer(backend, [&](auto& layer) -> decltype(layer.see(world)) { return layer.see(world); });
}
/// Lets that layer say where the ends of its contacts are, when these are not at the bodies' own anchors.
void place_ends(const auto& backend, auto& results) {
  ask_layer(backend, [&](auto& layer) -> decltype(layer.place_ends(results)) { return layer.place_ends(results); });
}

/// The order in which every backend answers: by pair, then by feature.
inline void sort_by_name(std::vector<ContactPoint>& contacts) {
  inner::sort(contacts, [](const ContactPoint& p, const ContactPoint& q) {
    return p.pair != q.pair ? p.pair < q.pair : p.feature < q.feature;
  });
}

/// Of sorted contacts whose names are equal, the later ones take the next.
inline void part_equal_names(std::vector<ContactPoint>& contacts) {
  for (std::size_t i = 1; i < contacts.size(); ++i)
    if (contacts[i].pair == contacts[i - 1].pair && contacts[i].feature <= contacts[i - 1].feature)
      contacts[i].feature = contacts[i - 1].feature + 1;
}

}  // namespace delassus::inner
