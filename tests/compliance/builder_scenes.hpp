/// A soft beam, a rigid body and rows drawn at random, for every builder of W; no loop.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/compliance/compliance.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/step/correct.hpp>

#include <Eigen/Cholesky>

#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace builder_scenes {

using namespace delassus;

using Soft = TetrahedralFem<Corotational>;
using Rows = RowSystem<double, Widths<6, 3>, 3>;
inline constexpr SystemScale scale{
    .mass = 1.001, .damping = 0.01, .stiffness = 1.2e-4};  // h = 0.01 s, some damping

struct Scene {
  World<RigidBodies, Soft> world{RigidBodies{}, Soft{}};
  Soft::BodyHandle beam;
  Rows rows;

  Scene() {
    auto& soft = bodies<Soft>(world);
    beam = soft.add({.mesh = box_mesh({0.4, 0.1, 0.1}, {5, 2, 2}), .elasticity = {.young = 2e4}});
    soft.fix(beam, [](const Vec3& x) { return x.x() < 1e-9; });
    bodies<RigidBodies>(world).add({.mass = 0.3, .inertia = Mat3(Vec3(.1, .2, .3).asDiagonal())});
    draw_rows();
  }
  /// x ← R(x₁ θ) x about the z axis: the end turns by 0.4 θ.
  void bend(double theta) {
    auto& soft = bodies<Soft>(world);
    for (Index k = 0; k < soft.node_count(beam); ++k) {
      const Vec3& x = soft.mesh(beam).points[k];
      soft.place(soft.node(beam, k), Eigen::AngleAxisd(theta * x.x(), Vec3::UnitZ()) * x);
    }
  }
  /// Twelve items of three rows: on the rigid body and a node, on the nodes of an element, on fixed nodes
  /// too.
  void draw_rows() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> draw(-1, 1);
    auto& pool = rows.pool<0>();
    pool.reset(12);
    for (Index i = 0; i < 12; ++i) {
      auto& on_rigid = inner::part<0>(pool.sets);
      if (i % 4 == 0)
        on_rigid.block.push_back(0),
            on_rigid.H.push_back(Mat<3, 6>::NullaryExpr([&] { return draw(random); }));
      auto& on_soft = inner::part<1>(pool.sets);
      for (Index k = 0; k <= i % 3; ++k) {
        on_soft.block.push_back(Index(random() % 54));
        on_soft.H.push_back(Mat3::NullaryExpr([&] { return draw(random); }));
      }
      pool.close();
      pool.lambda[i] = Vec3::NullaryExpr([&] { return draw(random); });
    }
  }
};

/// What a body enters its A into.
struct DenseMatrix {
  using Block = Mat3;
  Eigen::MatrixXd A;
  void set_zero() { A.setZero(); }
  void add_diagonal(Index i, const Block& b) { A.block<3, 3>(3 * i, 3 * i) += b; }
  void add_pair(Index i, Index j, const Block& b) {
    A.block<3, 3>(3 * i, 3 * j) += b;
    A.block<3, 3>(3 * j, 3 * i) += b.transpose();
  }
};

/// H of a scene, and H A⁻¹ Hᵀ by whole solves with its dense A: velocities of the rigid body first.
struct Whole {
  Eigen::MatrixXd H, W;

  explicit Whole(const Scene& scene) {
    const auto& soft = bodies<Soft>(scene.world);
    const auto& pool = scene.rows.pool<0>();
    const Index n = 3 * soft.blocks();
    H = Eigen::MatrixXd::Zero(3 * pool.items(), 6 + n);
    for (Index i = 0; i < pool.items(); ++i) {
      const auto put = [&](const auto& set, Index at, Index width) {
        for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e)
          H.block(3 * i, at + width * set.block[e], 3, width) += set.H[e];
      };
      put(inner::part<0>(pool.sets), 0, 6), put(inner::part<1>(pool.sets), 6, 3);
    }
    DenseMatrix A{Eigen::MatrixXd::Zero(n, n)};
    soft.each_system([&](Index, auto, const auto& body, const auto&) { body.enter(A); });
    Eigen::MatrixXd moving = H;
    for (Index b = 0; b < soft.blocks(); ++b)
      if (!soft.moves(b)) moving.middleCols<3>(6 + 3 * b).setZero();
    const Mat<6, 6> M = bodies<RigidBodies>(scene.world).solve_block<6>(0, Mat<6, 6>::Identity());
    Eigen::MatrixXd G(6 + n, H.rows());
    G.topRows<6>() = M * moving.leftCols<6>().transpose();
    G.bottomRows(n) = A.A.llt().solve(moving.rightCols(n).transpose());
    W = moving * G;
  }
};

/// The W of a builder, and the motion by its own A⁻¹ of the impulses there are.
template <class Compliance>
struct Built {
  typename Compliance::template Operator<Rows> W;
  Eigen::MatrixXd made, exact;
  Eigen::VectorXd change, lambda;  ///< H Δv, and the impulses

  void build(Scene& scene, const Compliance& policy) {
    auto& soft = bodies<Soft>(scene.world);
    auto& rigid = bodies<RigidBodies>(scene.world);
    if constexpr (requires { W.begin(policy); }) W.begin(policy);
    inner::inverse_of<0>(W, rigid, 0).factor(scale);
    inner::inverse_of<1>(W, soft, 0).factor(scale);
    W.build(scene.world, scene.rows);
    Array<Vec<6>> on_rigid(1, Vec<6>::Zero()), rigid_scratch;
    Array<Vec3> on_soft(soft.blocks(), Vec3::Zero()), soft_scratch;
    add_impulses(inner::inverse_of<0>(W, rigid, 1), 0, ArraysOf(scene.rows).all(), on_rigid, rigid_scratch);
    add_impulses(inner::inverse_of<1>(W, soft, 1), 1, ArraysOf(scene.rows).all(), on_soft, soft_scratch);
    gather(scene, on_rigid[0], on_soft);
  }
  double error() const { return (made - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff(); }
  double asymmetry() const {
    return (made - made.transpose()).cwiseAbs().maxCoeff() / made.cwiseAbs().maxCoeff();
  }

 private:
  void gather(const Scene& scene, const Vec<6>& on_rigid, std::span<const Vec3> on_soft) {
    const Whole whole(scene);
    const auto& pool = scene.rows.pool<0>();
    const auto blocks = W.template blocks<0, 0>();
    exact = whole.W;
    made = Eigen::MatrixXd::Zero(exact.rows(), exact.rows());
    lambda.resize(exact.rows());
    for (Index i = 0; i < pool.items(); ++i) {
      made.block<3, 3>(3 * i, 3 * i) = W.template diagonal<0>(i);
      for (Index e = blocks.start[i]; e < blocks.start[i + 1]; ++e)
        made.block<3, 3>(3 * i, 3 * blocks.column[e]) = blocks.block[e];
      lambda.segment<3>(3 * i) = pool.lambda[i];
    }
    Eigen::VectorXd v(whole.H.cols());
    v.head<6>() = on_rigid;
    for (std::size_t b = 0; b < on_soft.size(); ++b) v.segment<3>(6 + 3 * Index(b)) = on_soft[b];
    change = whole.H * v;
  }
};

}  // namespace builder_scenes
