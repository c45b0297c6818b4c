// Takes a folder. Runs twelve scenes under `ErrorControlled` at accuracies from 1e-2 to 1e-6 and with fixed steps, against closed forms,
// equations of motion or much finer steps, and writes error_control.csv there. With a second argument, a page, its table between
// <!-- table --> and <!-- end --> is written anew. Three minutes. From the root of the tree:
//
//   g++ -std=c++20 -O2 -DNDEBUG -Iinclude -Itests -isystem /usr/include/eigen3 docs/evidence/figures/error_control.cpp
//   -o error_control && ./error_control docs/evidence/figures docs/evidence/error_control.md
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/st_venant_kirchhoff.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace delassus;

namespace {

constexpr double g = 9.81;

/// A body at an output, and the size by which its error counts.
struct Seen {
  Vec3 place;
  Mat3 turn = Mat3::Identity();
  double size = 1;
};
using Picture = std::vector<Seen>;  // of one output
using Film = std::vector<Picture>;  // of all

double apart(const Film& a, const Film& b) {
  double worst = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    for (std::size_t i = 0; i < a[k].size(); ++i) {
      const double e = (a[k][i].place - b[k][i].place).norm() / b[k][i].size + inner::turn_between(b[k][i].turn, a[k][i].turn).norm();
      worst = std::max(worst, std::isfinite(e) ? e : 1e9);
    }
  return worst;
}

Quat about_y(double angle) { return exponential<double>(Vec3(0, angle, 0)); }

/// Where all bodies of a loop are that move, in their own sizes.
Picture picture(auto& loop, double length = 0) {
  Picture all;
  inner::BodyLengths<std::remove_cvref_t<decltype(loop.world())>> lengths;
  lengths.take(loop.world(), length);
  loop.world().each([&](const auto& set, auto s) {
    for (const Index b : set.active())
      if (set.moves(b)) {
        const Pose pose = inner::pose_of(set, b);
        all.push_back({pose.position, pose.rotation, lengths.of(Index(s), b)});
      }
  });
  return all;
}

struct Run {
  Film film;
  long calls = 0;  ///< detections and solves: 3 a trial, 2 where its order is measured, and one each time that joints are closed
  long steps = 0, rejections = 0, at_floor = 0, measurements = 0;
};

/// `outputs` times `output` s. make(policies...) makes the loop; lead policies come with the scene.
Run controlled(const auto& make, int outputs, double output, const ErrorControlled& asked, bool has_joints) {
  auto loop = make(ErrorControlled{asked});
  Run run;
  for (int k = 0; k < outputs; ++k) {
    loop.step(output);
    const ErrorReport& r = error_report(loop);
    run.steps += r.steps, run.rejections += r.rejections, run.at_floor += r.at_floor, run.measurements += r.measurements;
    run.film.push_back(picture(loop));
  }
  run.calls = 3 * (run.steps + run.rejections) + 2 * run.measurements + (has_joints ? 3 * (run.steps + run.rejections) + run.steps : 0);
  return run;
}
Run fixed(const auto& make, int outputs, double output, long parts) {
  auto loop = make(PlainOrder{});
  Run run;
  for (int k = 0; k < outputs; ++k) {
    for (long i = 0; i < parts; ++i) {
      loop.data().policies.each([&](auto& policy) {
        if constexpr (requires { policy.lead(loop.world(), 0.0, 0.0); }) policy.lead(loop.world(), output * (double(k) + double(i) / double(parts)), output / double(parts));
      });
      loop.step(output / double(parts));
    }
    run.film.push_back(picture(loop));
  }
  run.calls = run.steps = outputs * parts;
  return run;
}

double slope(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const double n = double(points.size());
  for (const auto& [a, b] : points) {
    const double u = std::log(a), v = std::log(std::max(b, 1e-15));
    x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

struct Tables {
  std::ostringstream page, csv;
  const char* only;
  bool per_second = false;

  /// One scene: reference of its outputs, and how far that may be off.
  void scene(const char* name, const char* parts, const auto& make, int outputs, double output, const Film& exact, double off, bool has_joints = false,
             double coarsest = 1e-2, double finest = 1e-6, long most_parts = 4096) {
    const double max_step = has_joints || output > 0.5 ? 1 : 0.1;
    if (only && std::string(name).find(only) == std::string::npos) return;
    std::vector<std::pair<long, double>> curve;  // calls and error of fixed steps
    double last = 0;
    for (double n = 1; n <= double(most_parts); n *= std::numbers::sqrt2) {
      if (std::lround(n) == std::lround(last)) continue;
      last = n;
      const Run run = fixed(make, outputs, output, std::lround(n));
      curve.emplace_back(run.calls, apart(run.film, exact));
    }
    for (std::size_t i = curve.size(); i-- > 1;) curve[i - 1].second = std::max(curve[i - 1].second, curve[i].second);  // from here on it stays below
    std::vector<std::pair<double, double>> points;
    std::string gains, ratios;
    for (double accuracy = coarsest; accuracy > 0.5 * finest; accuracy /= 10) {
      if (accuracy < 10 * off * (1 - 1e-9)) break;
      const Run run = controlled(make, outputs, output, {.accuracy = accuracy, .min_step = 1e-9, .max_step = max_step, .per_second = per_second}, has_joints);
      const double error = apart(run.film, exact);
      points.emplace_back(accuracy, error);
      long cheapest = 0;
      for (const auto& [calls, e] : curve)
        if (e <= error && cheapest == 0) cheapest = calls;
      const double gain = cheapest > 0 ? double(cheapest) / double(run.calls) : double(curve.back().first) / double(run.calls);
      char text[200];
      std::snprintf(text, sizeof text, "%s%.2g", ratios.empty() ? "" : ", ", error / accuracy), ratios += text;
      std::snprintf(text, sizeof text, "%s%s%.2g", gains.empty() ? "" : ", ", cheapest > 0 ? "" : "> ", gain), gains += text;
      std::snprintf(text, sizeof text, "%s,%.0e,%.3e,%ld,%ld,%ld,%ld,%ld\n", name, accuracy, error, run.steps, run.rejections, run.at_floor, run.calls, cheapest), csv << text;
      std::printf("%s", text), std::fflush(stdout);
    }
    char text[400];
    std::snprintf(text, sizeof text, "| %s | %s | %.0e | %s | %s | %s |\n", name, parts, off, ratios.c_str(), points.size() > 1 ? inner::text(0.01 * std::round(100 * slope(points))).c_str() : "–", gains.c_str());
    page << text;
    std::printf("%s", text), std::fflush(stdout);
  }
};

// --- references that are not loops ------------------------------------------------------------------------------------------

double height_of_bounces(double t) {
  double v = std::sqrt(2 * g), start = -v / g;
  while (v > 1e-8 && t >= start + 2 * v / g) start += 2 * v / g, v *= 0.8;
  return v > 1e-8 ? v * (t - start) - g / 2 * (t - start) * (t - start) : 0;
}

/// A rod that falls and strikes the ground with its ends, one after the other: height and turn fly freely, and an end that closes in
/// at the ground gets e of its speed back.
Film falling_rod(int outputs, double output, double half, double radius, double inertia, double e, double z, double angle, const Quat& flat, double size) {
  Film film;
  double vz = 0, w = 0, t = 0;
  const auto gap = [&](double s, double dt) { return z + vz * dt - g / 2 * dt * dt - std::abs(half) * s * std::sin(angle + w * dt) - radius; };
  for (int k = 1; k <= outputs; ++k) {
    while (t < k * output) {
      const double dt = std::min(1e-5, k * output - t);
      double hit = 0, when = dt;
      for (const double s : {-1., 1.}) {
        const double closing = vz - s * half * std::cos(angle) * w;
        if (!(gap(s, dt) < 0) || (gap(s, 0) <= 1e-13 && closing >= 0)) continue;
        double low = 0, high = dt;
        for (int i = 0; i < 60; ++i) (gap(s, (low + high) / 2) > 0 ? low : high) = (low + high) / 2;
        if (hit == 0 || low < when) hit = s, when = low;
      }
      z += vz * when - g / 2 * when * when, vz -= g * when, angle += w * when, t += when;
      if (hit == 0) continue;
      const double arm = half * std::cos(angle), impulse = -(1 + e) * (vz - hit * arm * w) / (1 + arm * arm / inertia);
      vz += impulse, w -= hit * arm * impulse / inertia;
      if (when == 0) t += 1e-12;
    }
    film.push_back({{Vec3(0, 0, z), (about_y(angle) * flat).toRotationMatrix(), size}});
  }
  return film;
}

/// A block on a floor A sin(ω t) with friction µ: it sticks where that is enough.
Film shaken_block(int outputs, double output, double A, double rate, double mu, double size) {
  Film film;
  double x = 0, v = A * rate;
  bool slips = false;
  int sign = 0;
  const long parts = 100000;
  const double dt = output / double(parts);
  for (int k = 1; k <= outputs; ++k) {
    for (long i = 1; i <= parts; ++i) {
      const double t = (k - 1) * output + double(i) * dt, acceleration = -A * rate * rate * std::sin(rate * t), floor = A * rate * std::cos(rate * t), before = v;
      if (!slips && std::abs(acceleration) > mu * g) slips = true, sign = acceleration > 0 ? 1 : -1;
      if (slips) {
        v += sign * mu * g * dt;
        if (sign * (floor - v) <= 0) v = floor, slips = std::abs(acceleration) > mu * g, sign = acceleration > 0 ? 1 : -1;
      } else {
        v = floor;
      }
      x += 0.5 * (before + v) * dt;
    }
    film.push_back({{Vec3(x, 0, 0.1), Mat3::Identity(), size}});
  }
  return film;
}

/// Housner's block: a pendulum upside down about one edge or the other; where it stands upright 1 − 3/2 sin² of its rate goes on.
Film housner(int outputs, double output, double b, double h, double angle, double size) {
  Film film;
  const double R = std::hypot(b, h), alpha = std::atan2(b, h);
  double a = angle, w = 0;
  const auto bend = [&](double x, double side) { return -0.75 * g / R * std::sin(alpha - side * x) * side; };
  const auto fly = [&](double& x, double& u, double side, double dt) {
    const double k1 = u, l1 = bend(x, side), k2 = u + dt / 2 * l1, l2 = bend(x + dt / 2 * k1, side), k3 = u + dt / 2 * l2, l3 = bend(x + dt / 2 * k2, side),
                 k4 = u + dt * l3, l4 = bend(x + dt * k3, side);
    x += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4), u += dt / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
  };
  for (int k = 1; k <= outputs; ++k) {
    for (double left = output; left > 1e-15;) {
      const double dt = std::min(1e-4, left), side = a > 0 || (a == 0 && w > 0) ? 1 : -1;
      double x = a, u = w;
      fly(x, u, side, dt);
      if (!(a * x < 0)) {
        a = x, w = u, left -= dt;
        continue;
      }
      double low = 0, high = dt;
      for (int i = 0; i < 60; ++i) {
        double y = a, v = w;
        fly(y, v, side, (low + high) / 2);
        (a * y > 0 ? low : high) = (low + high) / 2;
      }
      fly(a, w, side, low);
      a = 0, w *= 1 - 1.5 * std::sin(alpha) * std::sin(alpha);
      left -= low;
    }
    const double side = a >= 0 ? 1 : -1, c = alpha - std::abs(a);
    film.push_back({{Vec3(side * (b - R * std::sin(c)), 0, R * std::cos(c)), about_y(a).toRotationMatrix(), size}});
  }
  return film;
}

/// An ellipsoid of 1 kg that rolls on a plane and does not slip, by the classical Runge-Kutta rule of its equations. With r from the centre to the contact:
/// v = −ω × r, I ω̇ + ω × I ω = r × (v̇ + g), v̇ = −ω̇ × r − ω × ṙ.
struct Rolling {
  Vec3 half_axes;
  Mat3 inertia;  ///< kg m², in its own axes
  Quat q = Quat::Identity();
  Vec3 place, w;

  struct Slope {
    Eigen::Vector4d q;
    Vec3 place, w;
  };
  Rolling moved(const Slope& by, double h) const {
    Rolling end = *this;
    end.q.coeffs() += h * by.q, end.q.normalize(), end.place += h * by.place, end.w += h * by.w;
    return end;
  }
  Slope slope() const {
    // In its own axes the lowest point is s = D n/√(n·D n), with D the squares of the half axes and n the direction down, which goes with n × ω.
    const Mat3 R = q.toRotationMatrix(), I = R * inertia * R.transpose();
    const Vec3 D = half_axes.cwiseProduct(half_axes), rate = R.transpose() * w, n = R.transpose() * Vec3(0, 0, -1), turned = n.cross(rate), Dn = D.cwiseProduct(n);
    const double root = std::sqrt(n.dot(Dn));
    const Vec3 s = Dn / root, moving = D.cwiseProduct(turned) / root - Dn * (turned.dot(Dn) / (root * root * root)), r = R * s, known = Vec3(0, 0, g) - w.cross(R * (rate.cross(s) + moving));
    const Mat3 about = I + r.squaredNorm() * Mat3::Identity() - r * r.transpose();
    return {0.5 * (Quat(0, w.x(), w.y(), w.z()) * q).coeffs(), r.cross(w), about.inverse() * (r.cross(known) - w.cross(I * w))};
  }
  void step(double h) {
    const Slope a = slope(), b = moved(a, h / 2).slope(), c = moved(b, h / 2).slope(), d = moved(c, h).slope();
    *this = moved({(a.q + 2 * b.q + 2 * c.q + d.q) / 6, (a.place + 2 * b.place + 2 * c.place + d.place) / 6, (a.w + 2 * b.w + 2 * c.w + d.w) / 6}, h);
  }
};
Film film_of(Rolling body, int outputs, double output, double h, double size) {
  Film film;
  for (int k = 0; k < outputs; ++k) {
    for (long i = std::lround(output / h); i > 0; --i) body.step(h);
    film.push_back({{body.place, body.q.toRotationMatrix(), size}});
  }
  return film;
}

struct Shaken {
  using plays = role::Listener;
  using listens = Listens<>;
  RigidBodies::Handle floor{};
  double amplitude = 0.1, rate = 2 * std::numbers::pi;
  void lead(auto& world, double t, double h) const { bodies<RigidBodies>(world).move_to(floor, {amplitude * std::sin(rate * (t + h)), 0, 0}); }
};

/// The film of a loop at fixed steps.
Film film_of(auto loop, int outputs, double output, double h) {
  Film film;
  for (int k = 0; k < outputs; ++k) {
    for (long i = std::lround(output / h); i > 0; --i) loop.step(h);
    film.push_back(picture(loop));
  }
  return film;
}
/// The same at h and h/2: the finer film, and how far the two are apart.
std::pair<Film, double> halved(const auto& make, int outputs, double output, double h) {
  Film fine = film_of(make(), outputs, output, h / 2);
  const double off = apart(film_of(make(), outputs, output, h), fine);
  return {std::move(fine), off};
}

}  // namespace

int main(int count, char** words) {
  const std::string folder = count > 1 ? words[1] : ".";
  Tables tables{.only = count > 3 ? words[3] : nullptr};
  tables.csv << "scene,accuracy,error,steps,rejections,at_floor,calls,fixed_steps\n";
  const auto contacts = [](auto law, auto... policies) {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{law}}, AcceleratedGaussSeidel{.tolerance = 1e-9, .max_iterations = 20000}, PositionProjection{}, policies...};
  };

  {
    const auto make = [](auto... p) {
      AnimationLoop loop{World{RigidBodies{}}, p...};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      set.add({.angular_velocity = {0.01, 5, 0.01}, .mass = 1, .inertia = Mat3(Vec3(1, 2, 3).asDiagonal())});
      return loop;
    };
    const auto [exact, off] = halved([&] { return make(RungeKutta4{}); }, 2, 2.5, 2e-4);
    tables.scene("Euler's top", "`ImplicitMidpoint`", [&](auto scheme) { return make(ImplicitMidpoint{}, scheme); }, 2, 2.5, exact, off, false, 1e-2, 1e-6, 16384);
  }
  {
    const auto make = [](auto... p) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, p...};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto body = set.add({.position = {0.3, 0, 0.4}, .orientation = about_y(std::atan2(0.3, 0.4)), .angular_velocity = {0, 0, 0}, .mass = 1,
                                 .inertia = Mat3(Vec3(0.02, 0.02, 0.01).asDiagonal())});
      const Vec3 axis(0.6, 0, 0.8), spin = 40 * axis;
      set.set_velocity(body, spin.cross(Vec3(0.3, 0, 0.4)), spin);
      loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor_at(set, body, Vec3(0, 0, 0))});
      return loop;
    };
    const auto [exact, off] = halved([&] { return make(RungeKutta4{}); }, 2, 0.5, 1e-4);
    tables.scene("heavy top", "`NewtonMidpoint`", [&](auto scheme) { return make(NewtonMidpoint{}, AcceleratedGaussSeidel{.tolerance = 1e-10}, scheme); }, 2, 0.5, exact, off, true, 1e-2, 1e-6, 16384);
  }
  {
    const auto make = [](auto... p) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, p...};
      auto& set = bodies<RigidBodies>(loop.world());
      const Mat3 inertia = Vec3(0.01, 0.1, 0.1).asDiagonal();
      const auto upper = set.add({.position = {0.5, 0, 0}, .mass = 1, .inertia = inertia}), lower = set.add({.position = {1.5, 0, 0}, .mass = 1, .inertia = inertia});
      loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor_at(set, upper, Vec3(0, 0, 0))});
      loop.add(BallJoint::Item{anchor_at(set, upper, Vec3(1, 0, 0)), anchor_at(set, lower, Vec3(1, 0, 0))});
      return loop;
    };
    const auto [exact, off] = halved([&] { return make(RungeKutta4{}); }, 4, 0.5, 2e-4);
    tables.scene("double pendulum", "`NewtonMidpoint`", [&](auto scheme) { return make(NewtonMidpoint{}, AcceleratedGaussSeidel{.tolerance = 1e-10}, scheme); }, 4, 0.5, exact, off, true, 1e-2, 1e-6, 16384);
    tables.scene("double pendulum by one solve", "`ImplicitMidpoint`, `PositionProjection{.rate = 1}`",
                 [&](auto scheme) { return make(ImplicitMidpoint{}, PositionProjection{.rate = 1}, AcceleratedGaussSeidel{.tolerance = 1e-10}, scheme); }, 4, 0.5, exact, off, true, 1e-2, 1e-6, 16384);
  }
  {
    const auto make = [](auto... p) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, BallJoint{}, Cylindrical{}}, p...};
      auto& set = bodies<RigidBodies>(loop.world());
      const double r = 0.2, l = 0.6;
      const auto crank = set.add({.position = {r / 2, 0, 0}, .velocity = {0, r / 2 * 8, 0}, .angular_velocity = {0, 0, 8}, .mass = 1.0, .shape = Box{r, 0.05, 0.05}});
      const auto rod = set.add({.position = {r + l / 2, 0, 0}, .velocity = {0, r * 8 / 2, 0}, .angular_velocity = {0, 0, -8 * r / l}, .mass = 0.5, .shape = Box{l, 0.03, 0.03}});
      const auto piston = set.add({.position = {r + l, 0, 0}, .mass = 0.8, .shape = Box{0.1, 0.1, 0.1}});
      const Quat along_x = frame_along({1, 0, 0});
      loop.add(Hinge::Item{world_anchor({0, 0, 0}), anchor_at(set, crank, {0, 0, 0})});
      loop.add(Hinge::Item{anchor_at(set, crank, {r, 0, 0}), anchor_at(set, rod, {r, 0, 0})});
      loop.add(BallJoint::Item{anchor_at(set, rod, {r + l, 0, 0}), anchor(set, piston)});
      loop.add(Cylindrical::Item{world_anchor({0, 0, 0}, along_x), anchor_at(set, piston, {r + l, 0, 0}, along_x)});
      return loop;
    };
    const auto [exact, off] = halved([&] { return make(RungeKutta4{}); }, 3, 1, 2e-4);
    tables.scene("slider-crank", "`NewtonMidpoint`", [&](auto scheme) { return make(NewtonMidpoint{}, AcceleratedGaussSeidel{.tolerance = 1e-10}, scheme); }, 3, 1, exact, off, true, 1e-2, 1e-6, 16384);
  }
  {
    const auto make = [](auto... p) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, p...};
      auto& set = bodies<RigidBodies>(loop.world());
      const Quat across = frame_along({0, 1, 0});
      std::vector<RigidBodies::Handle> cranks;
      for (int k = 0; k <= 2; ++k) {
        cranks.push_back(set.add({.position = {double(k), 0, 0.5}, .velocity = {0.5, 0, 0}, .angular_velocity = {0, 1, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1. / 12, 1. / 12, 1e-3).asDiagonal())}));
        loop.add(Hinge::Item{world_anchor({double(k), 0, 0}, across), anchor(set, cranks.back(), {0, 0, -0.5}, across)});
      }
      for (int k = 0; k < 2; ++k) {
        const auto bar = set.add({.position = {k + 0.5, 0, 1}, .velocity = {1, 0, 0}, .mass = 1.0, .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
        loop.add(Hinge::Item{anchor(set, cranks[std::size_t(k)], {0, 0, 0.5}, across), anchor(set, bar, {-0.5, 0, 0}, across)});
        loop.add(Hinge::Item{anchor(set, cranks[std::size_t(k + 1)], {0, 0, 0.5}, across), anchor(set, bar, {0.5, 0, 0}, across)});
      }
      return loop;
    };
    // All cranks turn alike: φ¨ = Ω² sin φ from the upright, which RungeKutta's rule of this equation tells.
    const double rate = g * (0.5 * 3 + 2) / (3 / 3.0 + 2);
    Film exact;
    double phi = 0, omega = 1;
    auto probe = make(NewtonMidpoint{});
    const Picture sizes = picture(probe);
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < 5000; ++i) {
        const double h = 1e-4, k1 = omega, l1 = rate * std::sin(phi), k2 = omega + h / 2 * l1, l2 = rate * std::sin(phi + h / 2 * k1), k3 = omega + h / 2 * l2,
                     l3 = rate * std::sin(phi + h / 2 * k2), k4 = omega + h * l3, l4 = rate * std::sin(phi + h * k3);
        phi += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), omega += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      }
      Picture all;
      const Vec3 top(std::sin(phi), 0, std::cos(phi));
      for (int c = 0; c < 3; ++c) all.push_back({Vec3(c, 0, 0) + 0.5 * top, about_y(phi).toRotationMatrix(), sizes[std::size_t(c)].size});
      for (int c = 0; c < 2; ++c) all.push_back({Vec3(c + 0.5, 0, 0) + top, Mat3::Identity(), sizes[std::size_t(3 + c)].size});
      exact.push_back(all);
    }
    tables.scene("two four-bars through their line", "`NewtonMidpoint`", [&](auto scheme) { return make(NewtonMidpoint{}, AcceleratedGaussSeidel{.tolerance = 1e-10}, scheme); }, 4, 0.5, exact, 1e-10, true, 1e-2, 1e-6, 16384);
  }
  {
    const auto make = [&](auto scheme) {
      auto loop = contacts(Restitution{Coulomb{.friction = 0.5}, 0.8}, ImplicitMidpoint{}, scheme);
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      set.add({.position = {0, 0, 1.1}, .mass = 1, .shape = Sphere{0.1}});
      return loop;
    };
    Film exact;
    for (int k = 1; k <= 45; ++k) exact.push_back({{Vec3(0, 0, 0.1 + height_of_bounces(0.1 * k)), Mat3::Identity(), 0.1}});
    tables.scene("ball, e = 0.8, to rest", "`ImplicitMidpoint`", make, 45, 0.1, exact, 1e-10);
  }
  {
    const double tilt = 0.4;
    const Quat flat = about_y(std::numbers::pi / 2);
    double inertia = 0;
    const auto make = [&](auto scheme) {
      auto loop = contacts(Restitution{Frictionless{}, 0.5}, ImplicitMidpoint{}, scheme);
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      const auto rod = set.add({.position = {0, 0, 0.8}, .orientation = about_y(tilt) * flat, .mass = 1, .shape = Capsule{0.02, 0.8}});
      inertia = set.inertia(rod.index)(0, 0);
      return loop;
    };
    auto probe = make(PlainOrder{});
    const double size = picture(probe)[0].size;
    tables.scene("rod that strikes with its ends", "`ImplicitMidpoint`", make, 14, 0.05, falling_rod(14, 0.05, 0.4, 0.02, inertia, 0.5, 0.8, tilt, flat, size), 1e-10);
  }
  {
    const auto make = [&](auto scheme) {
      auto loop = contacts(Coulomb{.friction = 0.3}, ImplicitMidpoint{}, Shaken{}, scheme);
      auto& set = bodies<RigidBodies>(loop.world());
      loop.data().template get<Shaken>().floor = set.add({.shape = HalfSpace{}, .motion = Motion::kinematic});
      set.add({.position = {0, 0, 0.1}, .velocity = {0.2 * std::numbers::pi, 0, 0}, .mass = 1, .shape = Box{0.4, 0.4, 0.2}});
      return loop;
    };
    tables.scene("block on a shaken floor", "`ImplicitMidpoint`", make, 30, 0.1, shaken_block(30, 0.1, 0.1, 2 * std::numbers::pi, 0.3, 0.3), 1e-8, false, 1e-2, 1e-5);
  }
  {
    const double b = 0.1, h = 0.3, angle = 0.15, R = std::hypot(b, h), c = std::atan2(b, h) - angle;
    const auto make = [&](auto scheme) {
      auto loop = contacts(Coulomb{.friction = 0.8}, ImplicitMidpoint{}, scheme);
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      set.add({.position = {b - R * std::sin(c), 0, R * std::cos(c)}, .orientation = about_y(angle), .mass = 1, .shape = Box{0.2, 0.4, 0.6}});
      return loop;
    };
    tables.scene("rocking block", "`ImplicitMidpoint`", make, 18, 0.1, housner(18, 0.1, b, h, angle, Vec3(0.1, 0.2, 0.3).norm()), 1e-9);
  }
  {
    const Vec3 axes(0.2, 0.03, 0.02), start(0.02, 0, -1.5);
    const Mat3 R = exponential<double>(Vec3(0, 0, 0.1)).toRotationMatrix(), inertia = R * Vec3(2e-4, 1.6e-3, 1.7e-3).asDiagonal() * R.transpose();
    const auto make = [&](auto scheme) {
      auto loop = contacts(Coulomb{.friction = 5}, ImplicitMidpoint{.looks = 2}, scheme);
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      set.add({.position = {0, 0, axes.z()}, .velocity = start.cross(Vec3(0, 0, axes.z())), .angular_velocity = start, .mass = 1, .inertia = inertia, .shape = Ellipsoid{axes.x(), axes.y(), axes.z()}});
      return loop;
    };
    auto probe = make(PlainOrder{});
    const double size = picture(probe)[0].size;
    const Rolling body{.half_axes = axes, .inertia = inertia, .place = {0, 0, axes.z()}, .w = start};
    const Film exact = film_of(body, 30, 0.1, 5e-5, size);
    const double off = apart(film_of(body, 30, 0.1, 1e-4, size), exact);
    tables.scene("rattleback", "`ImplicitMidpoint{.looks = 2}`", make, 30, 0.1, exact, off);
    tables.per_second = true;
    tables.scene("rattleback, error per second", "`ImplicitMidpoint{.looks = 2}`", make, 30, 0.1, exact, off);
    tables.per_second = false;
  }
  {
    const auto make = [&](auto scheme) {
      auto loop = contacts(Coulomb{.friction = 0.5}, ImplicitMidpoint{}, scheme);
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      for (int i = 0; i < 5; ++i) set.add({.position = {0, 0, 0.1 + 0.2 * i}, .mass = 4, .shape = Box{0.2, 0.2, 0.2}});
      set.add({.position = {-0.5, 0.03, 0.87}, .velocity = {4, 0, 0}, .mass = 1, .shape = Sphere{0.06}});
      return loop;
    };
    // To the horizon of the reference: the last output by which halving its step moves no body by more than 1e-3.
    const Film coarse = film_of(make(PlainOrder{}), 16, 0.025, 1e-5), fine = film_of(make(PlainOrder{}), 16, 0.025, 5e-6);
    Film exact;
    double off = 0;
    for (std::size_t k = 0; k < fine.size(); ++k) {
      const double moved = apart({coarse[k]}, {fine[k]});
      if (moved > 1e-3) break;
      off = std::max(off, moved);
      exact.push_back(fine[k]);
    }
    char name[80];
    std::snprintf(name, sizeof name, "stack of five that a ball strikes, to %.3f s", 0.025 * double(exact.size()));
    tables.scene(name, "`ImplicitMidpoint`", make, int(exact.size()), 0.025, exact, off, false, 1e-2, 1e-3, 1024);
  }
  {
    using Soft = TetrahedralFem<StVenantKirchhoff>;
    const auto make = [](auto scheme) {
      AnimationLoop loop{World{Soft{}}, ImplicitMidpoint{}, scheme};
      auto& set = bodies<Soft>(loop.world());
      const auto beam = set.add({.mesh = box_mesh({1, 0.1, 0.1}, {6, 1, 1}), .elasticity = {.young = 1e6, .poisson = 0.3}, .density = 1000});
      set.fix(beam, [](const Vec3& x) { return x.x() < 1e-6; });
      return loop;
    };
    const auto [exact, off] = halved([&] { return make(PlainOrder{}); }, 5, 0.1, 2e-6);
    tables.scene("soft beam let go", "`ImplicitMidpoint`", make, 5, 0.1, exact, off, false, 1e-2, 1e-5, 8192);
  }

  std::ofstream(folder + "/error_control.csv") << tables.csv.str();
  if (count > 2) {
    std::stringstream page;
    page << std::ifstream(words[2]).rdbuf();
    const std::string text = page.str(), begin = "<!-- table -->\n", end = "<!-- end -->";
    const std::size_t from = text.find(begin), to = text.find(end);
    if (from == std::string::npos || to == std::string::npos) return std::fprintf(stderr, "%s has no table between <!-- table --> and <!-- end -->\n", words[2]), 1;
    std::ofstream(words[2]) << text.substr(0, from + begin.size()) << "| scene | parts | reference off by | true over asked error, 1e-2, 1e-3, … | slope | steps of the cheapest fixed step as good, over ours |\n|---|---|--:|---|--:|---|\n"
                            << tables.page.str() << text.substr(to);
  }
}
