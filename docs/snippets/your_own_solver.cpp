// A solver of your own, with a deadline around it: plain sweeps until the residual is small enough.
// prints: converged, [1-9][0-9]* sweeps, residual [0-9.]+e-0[789], top at 2\.5000 m
#include <delassus/delassus.hpp>

#include <cmath>
#include <cstdio>

using namespace delassus;

struct PlainSweeps {
  using plays = role::Solver;
  static constexpr Needs needs = Needs::sweeps;
  double tolerance = 1e-6;
  int max_sweeps = 500;

  void check() const {
    if (!(tolerance >= 0)) throw InvalidArgument("PlainSweeps: tolerance must be >= 0");
  }
  template <class Rows>
  struct Workspace {};  // nothing is kept between two solves

  template <class T, class Space>
  SolveReport solve(Island<T>& island, Space&) const {
    SolveReport report;
    report.measure = island.measure();
    island.notify(0, report.measure);  // for listeners of the convergence
    while (report.measure.residual > tolerance && report.sweeps < max_sweeps && !island.is_out_of_time()) {
      island.sweep();
      report.measure = island.measure();
      island.notify(++report.sweeps, report.measure);
    }
    if (!std::isfinite(report.measure.residual)) report.status = Status::quarantined;
    else if (report.measure.residual > tolerance) report.status = Status::max_iterations;
    return report;
  }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}},
                     WithDeadline{PlainSweeps{}, 1.0}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  RigidBodies::Handle top;
  for (int i = 0; i < 3; ++i) top = rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  StepReport report;
  for (int i = 0; i < 200; ++i) report = loop.step(5e-3);
  std::printf("%s, %d sweeps, residual %.1e, top at %.4f m\n", name(report.status), report.sweeps, report.residual,
              rigid.position(top).z());
}
