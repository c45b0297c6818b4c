// The materials at one deformation gradient, against energies, closed forms and each other.
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/elasticity/linear.hpp>
#include <delassus/fem/elasticity/st_venant_kirchhoff.hpp>
#include <delassus/fem/elasticity/stable_neo_hookean.hpp>
#include <delassus/fem/elasticity/with_fibres.hpp>

#include <delassus/math/rotation.hpp>

#include <cmath>
#include <random>

#include "catch.hpp"

namespace materials_tests {

using namespace delassus;

namespace {

using Muscle = WithFibres<StableNeoHookean>;
static_assert(ElasticMaterial<Muscle>);

struct Draw {
  std::mt19937 random;
  std::uniform_real_distribution<double> draw{-1, 1};
  explicit Draw(unsigned seed) : random(seed) {}
  Vec3 vector() { return {draw(random), draw(random), draw(random)}; }
  Mat3 matrix() { return columns(vector(), vector(), vector()); }
};

/// ∂P/∂F contracted with the gradients a and b, entry by entry of `block`'s definition, from stresses h
/// apart.
template <class M>
Mat3 block_by_differences(const M& material, const Mat3& F, const Vec3& a, const Vec3& b, double h) {
  Mat3 B = Mat3::Zero();
  for (int k = 0; k < 3; ++k) {
    Mat3 up = F, down = F;  // x_k moves by h with the gradient b
    for (int l = 0; l < 3; ++l) up(k, l) += h * b[l], down(k, l) -= h * b[l];
    const Vec3 df = (Mat3(material.at(up).stress()) - Mat3(material.at(down).stress())) * a / (2 * h);
    for (int i = 0; i < 3; ++i) B(i, k) = df[i];
  }
  return B;
}

double distance(const Mat3& A, const Mat3& B) { return (A - B).cwiseAbs().maxCoeff(); }

Mat3 diagonal(double x, double y, double z) { return columns<double>({x, 0, 0}, {0, y, 0}, {0, 0, z}); }

}  // namespace

TEMPLATE_TEST_CASE("the stress is the energy's derivative, at every F but where R jumps", "", Linear,
                   Corotational, StableNeoHookean, StVenantKirchhoff, Muscle) {
  const TestType material{.young = 1, .poisson = 0.35};
  Draw draw(3);
  const double h = 1e-5;
  for (int n = 0; n < 40; ++n) {
    const Mat3 F = draw.matrix() + (n % 2 ? 2.0 : 0.5) * Mat3(Mat3::Identity());
    if (F.determinant() < 0.1) continue;  // R of a flat F turns as fast as one likes
    const Mat3 P = material.at(F).stress();
    for (int k = 0; k < 9; ++k) {
      Mat3 up = F, down = F;
      up.data()[k] += h, down.data()[k] -= h;
      const double slope = (material.at(up).energy() - material.at(down).energy()) / (2 * h);
      // h² of the third derivative, some tens here, and ε Ψ/h.
      CHECK(std::abs(slope - P.data()[k]) < 1e-7);
    }
  }
}

TEMPLATE_TEST_CASE("the tangent is the stress's derivative where it is positive", "", Linear, Corotational,
                   StableNeoHookean, StVenantKirchhoff, Muscle) {
  const TestType material{.young = 1, .poisson = 0.3};
  Draw draw(5);
  for (int n = 0; n < 40; ++n) {
    // Stretched a little in all directions, and turned: every mode of every material is stiff there.
    const Mat3 R = exponential(Vec3(3 * draw.vector())).toRotationMatrix();
    const Mat3 F =
        R * (1.1 * Mat3(Mat3::Identity()) + 0.03 * (draw.matrix() + draw.matrix().transpose().eval()));
    if (singular_values(F).sigma[2] < 1.02) continue;
    const Vec3 a = draw.vector(), b = draw.vector();
    const auto point = material.at(F);
    const Mat3 B = point.block(point.pull(a), point.pull(b));
    CHECK(distance(B, block_by_differences(material, F, a, b, 1e-5)) < 1e-8);
    CHECK(distance(B, point.block(point.pull(b), point.pull(a)).transpose()) < 1e-14);
  }
}

TEMPLATE_TEST_CASE("the tangent is positive semidefinite at every F, flat and inside out ones too", "",
                   Corotational, StableNeoHookean, StVenantKirchhoff, Muscle) {
  const TestType material{.young = 1, .poisson = 0.4};
  Draw draw(9);
  bool is_cut = false;
  for (int n = 0; n < 300; ++n) {
    Mat3 F = 1.5 * draw.matrix();
    if (n % 5 == 0) F = columns(Vec3(F.col(0)), Vec3(F.col(1)), Vec3(F.col(0) + F.col(1)));
    if (n == 17) F.setZero();
    // D : C : D with D = Σ_k d_k g_kᵀ, g_k the axes.
    const auto point = material.at(F);
    const Mat3 D = draw.matrix();
    double along = 0, exact = 0, size = 0;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        const Vec3 a = unit_axis(k), b = unit_axis(l), d = D.col(k), e = D.col(l);
        const Mat3 B = point.block(point.pull(a), point.pull(b));
        along += d.dot(B * e);
        size += std::abs(d.dot(B * e));
        exact += d.dot(block_by_differences(material, F, a, b, 1e-6) * e);
      }
    CHECK(along >= -1e-14 * size);
    is_cut = is_cut || exact < -1e-3;
  }
  CHECK(is_cut);  // there was something to cut
}

TEMPLATE_TEST_CASE("no turn strains, 179 degrees included", "", Corotational, StableNeoHookean, Muscle,
                   StVenantKirchhoff) {
  const TestType material{.young = 1, .poisson = 0.3};
  Draw draw(11);
  for (const double angle : {0.0, 1.0, 90.0, 179.0, 180.0}) {
    const Vec3 axis = draw.vector();
    const Mat3 R = exponential(Vec3(angle * M_PI / 180 / axis.norm() * axis)).toRotationMatrix();
    const auto point = material.at(R);
    CHECK(distance(point.stress(), Mat3::Zero()) < 1e-14);  // E ε times a few
    CHECK(std::abs(point.energy()) < 1e-15);
  }
}

TEMPLATE_TEST_CASE("small strains follow Hooke's law", "", Corotational, StableNeoHookean,
                   StVenantKirchhoff) {
  const TestType material{.young = 1, .poisson = 0.3};
  const Linear hooke{.young = 1, .poisson = 0.3};
  Draw draw(13);
  for (int n = 0; n < 20; ++n) {
    const Vec3 a = draw.vector(), b = draw.vector();
    const auto point = material.at(Mat3::Identity());
    const auto reference = hooke.at(Mat3::Identity());
    CHECK(distance(point.block(point.pull(a), point.pull(b)), reference.block(a, b)) < 1e-14);
  }
}

TEST_CASE("a bar pulled and pressed along its length follows the closed forms of its material") {
  // Free sides: P = ½ (λ³ − λ) E and lateral stretch √(1 − ν (λ² − 1)) of St. Venant and Kirchhoff;
  // E (λ − 1) and 1 − ν (λ − 1) where R = 1 splits off Hooke's law.
  for (const double stretch : {0.7, 0.9, 1.5, 2.0}) {
    const double side = std::sqrt(1 - 0.3 * (stretch * stretch - 1));
    const Mat3 P = StVenantKirchhoff{.young = 1, .poisson = 0.3}.at(diagonal(stretch, side, side)).stress();
    CHECK(std::abs(P(0, 0) - 0.5 * (stretch * stretch * stretch - stretch)) < 1e-14);
    CHECK(std::abs(P(1, 1)) < 1e-14);
    const double width = 1 - 0.3 * (stretch - 1);
    const Mat3 Q = Corotational{.young = 1, .poisson = 0.3}.at(diagonal(stretch, width, width)).stress();
    CHECK(std::abs(Q(0, 0) - (stretch - 1)) < 1e-14);
    CHECK(std::abs(Q(2, 2)) < 1e-14);
  }
  // (ν, λ, lateral, P/E) from the root of the lateral stress in 30 digits.
  const double rubber[][4] = {
      {0.3, 0.5, 1.09464698867832, -0.705854241014314},  {0.3, 1.5, 0.86708612354576, 0.404445520062712},
      {0.3, 2.0, 0.771045340652879, 0.732113421429001},  {0.45, 0.5, 1.33193684989408, -1.10935097535473},
      {0.45, 1.5, 0.828994039604836, 0.375427927925447}, {0.45, 2.0, 0.722880839003539, 0.66717118366591}};
  for (const auto& [nu, stretch, side, stress] : rubber) {
    const Mat3 P = StableNeoHookean{.young = 1, .poisson = nu}.at(diagonal(stretch, side, side)).stress();
    CHECK(std::abs(P(0, 0) - stress) < 1e-13);  // the last digit written
    CHECK(std::abs(P(1, 1)) < 1e-13);
  }
}

TEST_CASE(
    "a bar of St. Venant and Kirchhoff's material gives way below 1/sqrt(3) of its length, as its page "
    "says") {
  const StVenantKirchhoff material{.young = 1, .poisson = 0};
  const auto stress = [&](double stretch) {
    return Mat3(material.at(diagonal(stretch, 1, 1)).stress())(0, 0);
  };
  CHECK(std::abs(stress(1 / std::sqrt(3.0)) + 0.192450089729875) < 1e-14);
  CHECK(stress(0.5) > stress(1 / std::sqrt(3.0)));
  CHECK(stress(0.65) > stress(1 / std::sqrt(3.0)));
}

TEST_CASE("fibres add k/2 (l^2 - 1) l where they are pulled, and nothing where they are pressed or across") {
  const Vec3 along = Vec3(1, 2, -2) / 3;
  const Muscle muscle{.young = 2, .poisson = 0.3, .direction = along, .fibres = 3};
  const StableNeoHookean rubber{.young = 2, .poisson = 0.3};
  for (const double stretch : {0.6, 1.0, 1.5}) {
    // F stretches the direction of the fibres alone.
    Mat3 F = Mat3::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F(i, j) += (stretch - 1) * along[i] * along[j];
    const Mat3 more = Mat3(muscle.at(F).stress()) - Mat3(rubber.at(F).stress());
    const double expected = stretch > 1 ? 3.0 * (stretch * stretch - 1) * stretch : 0;  // k = 6
    CHECK(std::abs(along.dot(more * along) - expected) < 1e-13);
    CHECK(Vec3(more * Vec3(Vec3(2, 1, 2) / 3)).norm() < 1e-13);
    const double energy = stretch > 1 ? 0.75 * (stretch * stretch - 1) * (stretch * stretch - 1) : 0;
    CHECK(std::abs(muscle.at(F).energy() - rubber.at(F).energy() - energy) < 1e-13);
  }
  CHECK_THROWS_WITH(check_material(Muscle{.direction = {1, 1, 0}}, "soft body #0"),
                    Catch::Contains("direction of its fibres is not a unit vector"));
  CHECK_THROWS_WITH(check_material(Muscle{.fibres = -1}, "soft body #0"),
                    Catch::Contains("fibres, -1 times"));
}

TEST_CASE("a material with impossible numbers is refused") {
  CHECK_THROWS_AS(check_material(Linear{.young = 0}, "soft body #0"), InvalidArgument);
  CHECK_THROWS_AS(check_material(Linear{.young = -0.0 / 0.0}, "soft body #0"), InvalidArgument);
  CHECK_THROWS_AS(check_material(Corotational{.poisson = 0.5}, "soft body #0"), InvalidArgument);
  CHECK_THROWS_AS(check_material(StableNeoHookean{.poisson = -1}, "soft body #0"), InvalidArgument);
  check_material(StableNeoHookean{.poisson = -0.999}, "soft body #0");
}

}  // namespace materials_tests
