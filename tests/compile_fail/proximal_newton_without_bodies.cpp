// expect: delassus: Newton's method needs the bodies of a problem
#include <delassus/delassus.hpp>
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/proximal_newton.hpp>

using namespace delassus;

int main() {
  auto problem = make_friction_problem({0.5}, {Vec3(-1, 0, 0)}, {{0, 0, Mat3::Identity()}});
  return int(solve(problem, ProximalNewton{}).status);
}
