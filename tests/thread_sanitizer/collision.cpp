// Four detections in four threads share their hulls and nothing else.
#include <delassus/collision/native.hpp>

#include <array>
#include <cmath>
#include <thread>
#include <vector>

using namespace delassus;

namespace {

double heap(const ConvexHull& hull) {
  const Shape shapes[] = {Sphere{0.4}, Box{1, 0.6, 0.8}, Capsule{0.25, 0.8}, Cylinder{0.35, 0.8},
                          hull,        Cone{0.4, 0.9}};
  std::vector<Collider> colliders;
  for (int i = 0; i < 24; ++i) {
    Collider c{.shape = shapes[i % 6], .is_movable = i % 5 != 0, .key = std::uint32_t(i)};
    c.pose.position = 1.2 * Vec3(std::sin(7.0 * i), std::cos(5.0 * i), std::sin(3.0 * i));
    c.pose.rotation = Quat(1, std::sin(i), std::cos(i), 0.3).normalized().toRotationMatrix();
    colliders.push_back(c);
  }
  NativeCollision collision;
  std::vector<ContactPoint> contacts;
  double sum = 0;
  for (int step = 0; step < 5; ++step) {
    for (Collider& c : colliders)
      if (c.is_movable) c.pose.position += 1e-3 * Vec3(std::sin(step + c.key), 0, 0);
    collision.detect(colliders, 1e-2, contacts);
    for (const ContactPoint& c : contacts) sum += c.gap + c.point_a.sum() + c.feature;
  }
  return sum;
}

}  // namespace

int main() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 0.4 : -0.4, i & 2 ? 0.3 : -0.3, i & 4 ? 0.5 : -0.5});
  const ConvexHull hull(corners);
  std::array<double, 4> sums{};
  std::vector<std::thread> threads;
  for (double& sum : sums) threads.emplace_back([&] { sum = heap(hull); });
  for (std::thread& t : threads) t.join();
  const double alone = heap(hull);
  for (const double sum : sums)
    if (sum != alone) return 1;
  return alone != 0 ? 0 : 1;
}
