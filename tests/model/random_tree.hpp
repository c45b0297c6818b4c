/// Random machines of all kinds of joints, and random states of them.
#pragma once

#include <delassus/model/joint_space.hpp>

#include <random>
#include <string>
#include <vector>

namespace delassus {

struct Dice {
  std::mt19937 engine;

  double number(double size) { return std::uniform_real_distribution<double>(-size, size)(engine); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine); }
  Vec3 vector(double size) { return {number(size), number(size), number(size)}; }
  Quat turn() {
    Quat q(number(1), number(1), number(1), number(1));
    while (q.norm() < 0.1) q = Quat(number(1), number(1), number(1), number(1));
    return unit(q);
  }
  Pose pose(double size) {
    const Vec3 position = vector(size);
    return {position, rotation_matrix(turn())};
  }
};

inline model::Body random_body(Dice& dice, Index parent) {
  model::Body body{.name = "body " + std::to_string(parent) + " " + std::to_string(dice.below(1 << 30)),
                   .parent = parent,
                   .pose = dice.pose(0.5),
                   .mass = 1 + dice.number(0.8)};
  body.centre = dice.vector(0.3);
  const Mat3 axes = rotation_matrix(dice.turn());
  const Mat3 moments = columns<double>({0.1 + dice.number(0.03), 0, 0}, {0, 0.12 + dice.number(0.03), 0},
                                       {0, 0, 0.14 + dice.number(0.03)});
  body.inertia = times_transposed(axes * moments, axes);
  body.inertia = 0.5 * (body.inertia + transposed(body.inertia));
  body.gravity_compensation = dice.below(3) == 0 ? 0.7 : 0;
  return body;
}

inline void add_joint(Model& m, model::Body& body, Dice& dice, model::JointKind kind, const Vec3& axis) {
  body.joints.push_back(Index(m.joints.size()));
  m.joints.push_back({.name = "joint" + std::to_string(m.joints.size()),
                      .kind = kind,
                      .point = dice.vector(0.3),
                      .axis = axis,
                      .reference = dice.number(0.5),
                      .damping = 0.3,
                      .stiffness = dice.below(2) * 2.0,
                      .spring_reference = dice.number(0.5),
                      .armature = dice.below(2) * 0.02});
}

/// Bodies with joints of each kind, with several, and fixed ones. Axes of one body are across each other, so
/// that turns by 1 rad leave them independent.
inline Model random_tree(unsigned seed, int bodies = 16) {
  using enum model::JointKind;
  const std::vector<std::vector<model::JointKind>> kinds{{free},
                                                         {hinge},
                                                         {ball},
                                                         {slide},
                                                         {slide, hinge, slide},
                                                         {slide, slide, slide, ball},
                                                         {hinge, hinge, hinge},
                                                         {}};
  Dice dice{std::mt19937(seed)};
  Model m{.name = "tree", .gravity = dice.vector(9)};
  for (int b = 0; b < bodies; ++b) {
    model::Body body = random_body(dice, Index(dice.below(b + 1) - 1));
    const Mat3 axes = rotation_matrix(dice.turn());
    int number = 0;
    for (const model::JointKind kind : kinds[std::size_t(b) % kinds.size()])
      add_joint(m, body, dice, kind, column(axes, number++ % 3));
    m.bodies.push_back(std::move(body));
  }
  return m;
}

inline std::vector<double> random_numbers(Dice& dice, Index count, double size) {
  std::vector<double> x(static_cast<std::size_t>(count));
  for (double& number : x) number = dice.number(size);
  return x;
}

/// Everywhere: a step from the reference by up to `size` in each freedom.
inline std::vector<double> random_q(const JointSpace& space, Dice& dice, double size) {
  std::vector<double> q(std::size_t(space.q_size()));
  space.reference(q);
  space.advance(q, random_numbers(dice, space.v_size(), size));
  return q;
}

inline double largest(const std::vector<double>& x) {
  double size = 0;
  for (const double number : x) size = std::max(size, std::abs(number));
  return size;
}
inline double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) size = std::max(size, std::abs(a[i] - b[i]));
  return size;
}

}  // namespace delassus
