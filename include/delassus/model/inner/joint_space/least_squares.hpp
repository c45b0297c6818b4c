/// The rates of the joints of one body whose motion together is nearest to a given one.
#pragma once

#include <delassus/math/positive.hpp>
#include <delassus/model/inner/joint_space/kinematics.hpp>

namespace delassus::inner::tree {

/// How the frame of a body moves, along its own axes, with each freedom of its joints: at most six.
struct Axes {
  Vec<6> columns[6];
  Index count = 0;
};

/// q being all numbers of the tree.
inline Axes axes_of(const Tree& tree, const Place& body, std::span<const double> q) {
  Axes axes;
  for (Index i = body.first; i < body.last; ++i) {
    const Node& node = tree.nodes[std::size_t(i)];
    const Pose by_joint = moved(node, &q[std::size_t(node.q)]);
    for (Index k = 0; k < axes.count; ++k) axes.columns[k] = motion_into(by_joint, axes.columns[k]);
    for (Index k = 0; k < v_count(node.kind); ++k)
      axes.columns[axes.count++] = tree.S[std::size_t(node.v + k)];
  }
  return axes;
}

/// x that makes |Σ columns x − motion|² least, m and rad alike. A freedom that moves the body as others
/// before it do has the rate 0. `damping` is added for each x²: it bounds x where freedoms move the body nearly alike.
inline Vec<6> nearest_rates(const Axes& axes, const Vec<6>& motion, double damping = 0) {
  Mat<6, 6> N = zero<Mat<6, 6>>();
  Vec<6> b = zero<Vec<6>>();
  for (Index i = 0; i < axes.count; ++i) {
    for (Index j = 0; j <= i; ++j) N(i, j) = dot(axes.columns[i], axes.columns[j]);
    N(i, i) += damping;
    b[i] = dot(axes.columns[i], motion);
  }
  return solve_positive(N, b);
}

}  // namespace delassus::inner::tree
