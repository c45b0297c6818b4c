#include <delassus/constraints/contact/cone.hpp>

#include "catch.hpp"

#include <random>

namespace cone_tests {

using namespace delassus;

namespace {

bool is_inside(const Vec3& x, double friction) {
  return x.tail<2>().norm() <= friction * x[0] + 4e-16 * (1 + friction) * x.norm();
}

}  // namespace

// P is the closest point of a convex set exactly when (x − P)·(y − P) <= 0 for every y in the set; y runs over rays of
// the boundary and the axis at several distances.
TEST_CASE("the projection on the cone is its closest point") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-2, 2);
  for (int n = 0; n < 3000; ++n) {
    const double friction = n % 7 == 0 ? 0 : std::abs(draw(random));
    const Vec3 x{draw(random), draw(random), draw(random)};
    const Vec3 p = project_on_cone(x, friction);
    REQUIRE(is_inside(p, friction));
    for (int k = 0; k < 64; ++k)
      for (const double length : {0.0, 0.1, 1.0, 10.0})
        for (const double share : {0.0, 0.5, 1.0}) {
          const double a = 2 * M_PI * k / 64, r = share * friction;
          const Vec3 y = length * Vec3(1, r * std::cos(a), r * std::sin(a));
          REQUIRE((x - p).dot(y - p) <= 1e-14 * (1 + y.norm()) * (1 + x.norm()));
        }
  }
}

TEST_CASE("projecting twice is projecting once") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> draw(-2, 2);
  for (int n = 0; n < 1000; ++n) {
    const double friction = std::abs(draw(random));
    const Vec3 p = project_on_cone(Vec3{draw(random), draw(random), draw(random)}, friction);
    REQUIRE((project_on_cone(p, friction) - p).norm() <= 1e-15 * p.norm());
  }
}

TEST_CASE("the natural map is zero for a contact that is open, that sticks, and that slips") {
  const double mu = 0.5;
  for (const double scale : {0.3, 1.0, 7.0}) {
    REQUIRE(coulomb_natural_map<double>({0, 0, 0}, {1, 3, -2}, mu, scale).norm() == 0);
    REQUIRE(coulomb_natural_map<double>({2, 0.5, -0.3}, {0, 0, 0}, mu, scale).norm() < 1e-15);
    REQUIRE(coulomb_natural_map<double>({2, 0.6, -0.8}, {0, -3, 4}, mu, scale).norm() < 1e-14);
  }
}

// Both are sums of squares of at most five roundings each of numbers below |s λ| + (1 + μ) |u|.
TEST_CASE("the squares of the natural map at two scales are those of the map") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> draw(-2, 2);
  int open = 0, sticking = 0;
  for (int n = 0; n < 3000; ++n) {
    const double friction = std::abs(draw(random)), scale = std::exp(3 * draw(random));
    Vec3 lambda = Vec3::Zero(), u;
    for (int k = 0; k < 3; ++k) u[k] = draw(random);
    if (n % 5 != 0)
      for (int k = 0; k < 3; ++k) lambda[k] = draw(random);
    if (n % 3 == 0) u *= 1e-3;
    const Vec<2> squares = coulomb_natural_squares<double>(lambda, u, friction, scale);
    for (int k = 0; k < 2; ++k) {
      const double s = k == 0 ? scale : 1.0, size = s * lambda.norm() + (1 + friction) * u.norm();
      const Vec3 map = coulomb_natural_map<double>(lambda, u, friction, s);
      REQUIRE(std::abs(squares[k] - map.squaredNorm()) <= 1e-14 * size * size);
      open += map.norm() == 0;
      sticking += map.norm() > 0 && map.tail<2>() == u.tail<2>();
    }
  }
  REQUIRE(open > 300);
  REQUIRE(sticking > 300);
}

TEST_CASE("the natural map sees each way to break the law") {
  const double mu = 0.5;
  REQUIRE(coulomb_natural_map<double>({-1, 0, 0}, {0, 0, 0}, mu, 1.0).norm() > 0.1);      // pulls
  REQUIRE(coulomb_natural_map<double>({0, 0, 0}, {-1, 0, 0}, mu, 1.0).norm() > 0.1);      // penetrates
  REQUIRE(coulomb_natural_map<double>({1, 0, 0}, {1, 0, 0}, mu, 1.0).norm() > 0.1);       // pushes what leaves
  REQUIRE(coulomb_natural_map<double>({1, 0.6, 0}, {0, 0, 0}, mu, 1.0).norm() > 0.05);    // outside the cone
  REQUIRE(coulomb_natural_map<double>({1, 0.1, 0}, {0, -1, 0}, mu, 1.0).norm() > 0.1);    // slips with too little
  REQUIRE(coulomb_natural_map<double>({1, 0.5, 0}, {0, 1, 0}, mu, 1.0).norm() > 0.1);     // friction that drives
  REQUIRE(coulomb_natural_map<double>({2, 1, 0}, {0.5, -1, 0}, mu, 1.0).norm() > 0.1);    // glides: u_n = mu |u_t|
}

TEST_CASE("without friction the cone is a ray, and an open contact meets its law") {
  REQUIRE(project_on_cone<double>({-1, 0, 0}, 0.0) == Vec3(0, 0, 0));
  REQUIRE(project_on_cone<double>({2, 0, 0}, 0.0) == Vec3(2, 0, 0));
  REQUIRE(project_on_cone<double>({2, 3, -1}, 0.0) == Vec3(2, 0, 0));
  REQUIRE(coulomb_natural_map<double>({0, 0, 0}, {1, 0, 0}, 0.0, 1.0).norm() == 0);
}

}  // namespace cone_tests
