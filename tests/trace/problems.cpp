/// Friction problems without a loop: towers, clusters, more contacts than a box needs, by each solver that
/// takes a matrix.
#include <delassus/core/clock.hpp>
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/minimum_norm.hpp>
#include <delassus/solvers/path_newton.hpp>
#include <delassus/solvers/solve_until.hpp>

#include <array>
#include <random>

#include "problem_run.hpp"

using namespace trace;

namespace {

/// A body with its middle at x that does not turn with respect to the world's axes.
struct Block {
  double mass;
  Vec3 x, v, size;
};
/// A contact of bodies a and b at a point, n from a to b. −1: the ground.
struct Touch {
  int a, b;
  Vec3 point, normal;
};

/// W = H A⁻¹ Hᵀ and d = H v of blocks that touch.
FrictionProblem problem_of(const std::vector<Block>& bodies, const std::vector<Touch>& touches,
                           double friction) {
  std::vector<std::vector<Mat<3, 6>>> H(touches.size(),
                                        std::vector<Mat<3, 6>>(bodies.size(), Mat<3, 6>::Zero()));
  std::vector<Vec3> d(touches.size(), Vec3::Zero());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Touch& t = touches[i];
    const Mat3 frame = contact_frame(t.normal);
    for (const auto& [body, sign] : {std::pair{t.a, -1.0}, std::pair{t.b, 1.0}}) {
      if (body < 0) continue;
      for (int r = 0; r < 3; ++r) {
        const Vec3 direction = frame.row(r).transpose(),
                   turn = (t.point - bodies[std::size_t(body)].x).cross(direction);
        for (int k = 0; k < 3; ++k) {
          H[i][std::size_t(body)](r, k) = sign * direction[k];
          H[i][std::size_t(body)](r, k + 3) = sign * turn[k];
        }
      }
      d[i] += sign * (frame * bodies[std::size_t(body)].v);
    }
  }
  std::vector<GivenBlock> blocks;
  for (std::size_t i = 0; i < touches.size(); ++i)
    for (std::size_t j = 0; j < touches.size(); ++j) {
      Mat3 W = Mat3::Zero();
      bool is_coupled = i == j;
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Block& body = bodies[b];
        const Vec3 s = body.size.cwiseProduct(body.size);
        Vec<6> inverse;
        for (int k = 0; k < 3; ++k)
          inverse[k] = 1 / body.mass, inverse[k + 3] = 12 / (body.mass * (s.sum() - s[k]));
        if (H[i][b].isZero(0) || H[j][b].isZero(0)) continue;
        is_coupled = true;
        W += H[i][b] * inverse.asDiagonal() * H[j][b].transpose();
      }
      if (is_coupled) blocks.push_back({Index(i), Index(j), W});
    }
  return make_friction_problem(std::vector<double>(touches.size(), friction), d, blocks);
}

/// Cubes on each other, four contacts a face, moving aside while they fall.
FrictionProblem tower(const std::vector<double>& masses) {
  std::vector<Block> bodies;
  std::vector<Touch> touches;
  for (int k = 0; k < int(masses.size()); ++k) {
    bodies.push_back(
        {masses[std::size_t(k)], {0.1 * k, 0, 0.5 + k}, {0.05 + 0.1 * k, 0.02, -0.16}, {1, 1, 1}});
    for (int c = 0; c < 4; ++c)
      touches.push_back(
          {k - 1, k, {0.1 * k + (c % 2 ? 0.45 : -0.45), c / 2 ? 0.45 : -0.45, double(k)}, {0, 0, 1}});
  }
  return problem_of(bodies, touches, 0.5);
}

/// Bodies of random masses and places that touch at random, the first on the ground.
FrictionProblem cluster() {
  std::mt19937 random(5);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * (double(random()) / 4294967296.0);
  };
  const auto vector = [&](double s) {
    const double x = draw(-s, s), y = draw(-s, s), z = draw(-s, s);
    return Vec3(x, y, z);
  };
  std::vector<Block> bodies;
  std::vector<Touch> touches;
  for (int k = 0; k < 4; ++k) {
    const double mass = std::exp(draw(-2, 2));
    const Vec3 x = vector(2), v = vector(1), size{draw(0.3, 2), draw(0.3, 2), draw(0.3, 2)};  // braces: from left to right
    bodies.push_back({mass, x, v, size});
  }
  for (int k = 0; k < 7; ++k) {
    const int b = k % 4, a = b - 1 - (b > 0 ? int(random() % unsigned(b)) : 0);
    const Vec3 middle =
        a < 0 ? bodies[std::size_t(b)].x : Vec3(0.5 * (bodies[std::size_t(a)].x + bodies[std::size_t(b)].x));
    const Vec3 point = middle + vector(0.5), normal = vector(1).normalized();
    touches.push_back({a, b, point, normal});
  }
  return problem_of(bodies, touches, 0.4);
}

/// A flat box on eight contacts.
FrictionProblem table() {
  std::vector<Touch> touches;
  for (int c = 0; c < 8; ++c)
    touches.push_back({-1, 0, {c % 2 ? 0.5 : -0.5, c / 2 % 2 ? 0.5 : -0.5, 0}, {0, 0, 1}});
  return problem_of({{2, {0, 0, 0.2}, {0.3, 0.1, -0.5}, {1, 1, 0.4}}}, touches, 0.3);
}

long calls = 0;  ///< of `CountedContact`

/// Coulomb's law, which counts how often it is asked: the clock of the deadline.
struct CountedContact : GivenContact {
  template <class T>
  Vec<3, T> solve_local(const Item& item, const Mat<3, 3, T>& W, const Vec<3, T>& b, Memory<T>& memory) const {
    return ++calls, GivenContact::solve_local(item, W, b, memory);
  }
};
struct ItemClock {
  double now() const { return double(calls); }
};
using CountedProblem =
    Problem<Constraints<CountedContact>, inner::GivenRows, AssembledCompliance::Operator<inner::GivenRows>>;
CountedProblem counted(const FrictionProblem& from) {
  CountedProblem to;
  for (const auto& item : from.laws.pool<0>().items) to.laws.pool<0>().items.push_back({item.parameters});
  to.rows = from.rows, to.W = from.W, to.h = from.h;
  to.islands.take_all(ArraysOf(to.rows).all());
  return to;
}

struct Case {
  const char* name;
  FrictionProblem (*make)();
  bool is_redundant;
};
const Case cases[] = {{"tower",
                       [] {
                         return tower({1, 1});
                       },
                       true},
                      {"heavy_tower",
                       [] {
                         return tower({1, 10});
                       },
                       true},
                      {"cluster", cluster, false},
                      {"table", table, true}};

template <class Solver>
void add_all(Trace& all, const char* name, const Solver& solver) {
  for (const Case& c : cases)
    add_problem(all, std::string(c.name) + "_" + name, {.is_redundant = c.is_redundant}, c.make,
                [=](auto& problem) { return solve(problem, solver); });
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("problems");
  add_all(all, "sweeps", GaussSeidel{.tolerance = 1e-8, .max_iterations = 2000});
  add_all(all, "accelerated", AcceleratedGaussSeidel{.tolerance = 1e-10});
  add_all(all, "path", PathNewton{.tolerance = 1e-10});
  add_all(all, "least", MinimumNorm{AcceleratedGaussSeidel{.tolerance = 1e-10}});
  for (const Case& c : {cases[1], cases[2]})
    add_problem(
        all, std::string(c.name) + "_until", {.is_redundant = c.is_redundant},
        [=] { return counted(c.make()); },
        [](auto& problem) {
          calls = 0;
          return solve_until(problem, AcceleratedGaussSeidel{.tolerance = 1e-12}, 120, ItemClock{});
        });
  return all.main(argc, argv);
}
