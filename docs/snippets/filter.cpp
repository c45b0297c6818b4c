// Who collides: groups and masks, pairs named by hand, and a filter of your own around the backend.
// prints: red 0\.10 m, ghost -[0-9]+\.[0-9]+ m, jumper 1\.35 m
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;

/// Around a backend: fixed bodies hold from above only. What rises faster than 0.1 m/s passes through them.
template <class Backend>
struct OneWay {
  using plays = role::Collision;
  Backend backend{};

  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& points) {
    CollisionReport report = backend.detect(colliders, h, points);
    std::erase_if(points, [&](const ContactPoint& p) {
      const Collider &a = colliders[std::size_t(p.a)], &b = colliders[std::size_t(p.b)];
      const Collider& mover = a.is_movable ? a : b;
      return a.is_movable != b.is_movable && mover.velocity.z() > 0.1;
    });
    report.points = Index(points.size());
    return report;
  }
  void memory(auto& archive) { backend.memory(archive); }
};

int main() {
  enum : std::uint32_t { ground = 1, red = 2, blue = 4 };
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     WithFilter{OneWay<NativeCollision>{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());

  const auto floor = rigid.add_fixed(HalfSpace{});
  const auto a = rigid.add({.position = {0, 0, 0.1}, .mass = 1.0, .shape = Sphere{0.1},
                            .group = red, .collides_with = ground | red});  // passes through blue bodies
  rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.1}, .group = blue, .collides_with = ground | blue});

  const auto ghost = rigid.add({.position = {3, 0, 1}, .mass = 1.0, .shape = Sphere{0.1}});
  auto& filter = loop.get<WithFilter<OneWay<NativeCollision>>>();
  filter.ignore(loop.world(), anchor(rigid, ghost), anchor(rigid, floor));  // until filter.heed(...) with the same three

  rigid.add_fixed(Box{1, 1, 0.5}, {6, 0, 1});  // a platform whose top is at 1.25 m
  const auto jumper = rigid.add({.position = {6, 0, 0.1}, .velocity = {0, 0, 7}, .mass = 1.0, .shape = Sphere{0.1}});

  for (int i = 0; i < 400; ++i) loop.step(5e-3);
  std::printf("red %.2f m, ghost %.2f m, jumper %.2f m\n", rigid.position(a).z(), rigid.position(ghost).z(),
              rigid.position(jumper).z());
}
