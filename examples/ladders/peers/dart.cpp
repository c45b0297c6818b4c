// DART: joint coordinates, and a direct solver of the boxed complementarity problem.
#include "engine.hpp"
#include "tree.hpp"

#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BallJointConstraint.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/constraint/WeldJointConstraint.hpp>
#include <dart/dynamics/BallJoint.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CylinderShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include <algorithm>

namespace ladders::peers {

namespace {

namespace dd = dart::dynamics;

Eigen::Vector3d ev(const Triple& x) { return {x[0], x[1], x[2]}; }
Eigen::Isometry3d pose(const Triple& x, const Quadruple& q) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  out.translation() = ev(x);
  return out;
}
Eigen::Isometry3d pose(const State& s) { return pose(s.position, s.turn); }

/// Left as they are: FCL's collision detector on meshes, Dantzig's method, error reduction of contacts.
/// `is_native`: its own detector of boxes and spheres. Set: restitution, which it multiplies over a pair, as
/// a root; a larger limit of contacts (1000 by default); a half-space is a large box.
class Dart : public Engine {
 public:
  Dart(const Scene& scene, double h, bool is_native)
      : scene_(scene), tree_(scene), is_native_(is_native), nodes_(scene.bodies.size(), nullptr), h_(h) {
    expect_together(scene);
    world_ = dart::simulation::World::create();
    world_->setTimeStep(h);
    world_->setGravity(ev(scene.gravity));
    auto* solver = world_->getConstraintSolver();
    if (is_native) solver->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
    solver->getCollisionOption().maxNumContacts = 100000;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (scene.bodies[b].is_fixed) add_fixed(b);
    for (const int b : tree_.order) add(std::size_t(b));
    for (const auto& skeleton : skeletons_) world_->addSkeleton(skeleton);
    for (const int k : tree_.closures) close(scene.joints[std::size_t(k)]);
    for (const int b : tree_.order) start(b);
  }

  void push(int body, const Triple& force, const Triple& torque) override {
    nodes_[std::size_t(body)]->addExtForce(ev(force), Eigen::Vector3d::Zero(), false, true);
    nodes_[std::size_t(body)]->addExtTorque(ev(torque), false);
  }
  void step(double) override { world_->step(); }
  State state(int body) const override {
    const dd::BodyNode& node = *nodes_[std::size_t(body)];
    const Eigen::Isometry3d X = node.getWorldTransform();
    const Eigen::Quaterniond q(X.linear());
    const Eigen::Vector3d x = X.translation(), v = node.getCOMLinearVelocity(), w = node.getAngularVelocity();
    return {{x[0], x[1], x[2]}, {q.w(), q.x(), q.y(), q.z()}, {v[0], v[1], v[2]}, {w[0], w[1], w[2]}};
  }

 private:
  /// Half the edge of a box that stands for a half-space: far beyond all bodies.
  double reach() const {
    double out = 1;
    for (const Body& body : scene_.bodies)
      if (!body.is_fixed)
        for (const Body& other : scene_.bodies) {
          const Triple apart = body.start.position - other.start.position;
          out = std::max({out, std::sqrt(dot(apart, apart)), body.geometry.size[0], body.geometry.size[2]});
        }
    return 10 * out;
  }

  dd::ShapePtr shape_of(const Geometry& g) const {
    const auto& s = g.size;
    const bool is_simple = g.form == Form::box || g.form == Form::sphere || g.form == Form::half_space;
    if (is_native_ && !is_simple) throw Unsayable("its own detector has boxes and spheres alone");
    switch (g.form) {
      case Form::box:
        return std::make_shared<dd::BoxShape>(2 * Eigen::Vector3d(s[0], s[1], s[2]));
      case Form::sphere:
        return std::make_shared<dd::SphereShape>(s[0]);
      case Form::capsule:
        throw Unsayable("its FCL detector takes a capsule for a small sphere");
      case Form::cylinder:
        return std::make_shared<dd::CylinderShape>(s[0], 2 * s[1]);
      case Form::half_space:
        return std::make_shared<dd::BoxShape>(Eigen::Vector3d::Constant(2 * reach()));
      case Form::convex:
        throw Unsayable("hulls were not tried: it collides surfaces of meshes");
      case Form::none:
        break;
    }
    return nullptr;
  }
  void give_shape(dd::BodyNode* node, const Body& body) const {
    if (!scene_.touches || body.geometry.form == Form::none) return;
    auto* shape = node->createShapeNodeWith<dd::CollisionAspect, dd::DynamicsAspect>(shape_of(body.geometry));
    shape->getDynamicsAspect()->setFrictionCoeff(scene_.friction);
    shape->getDynamicsAspect()->setRestitutionCoeff(std::sqrt(scene_.restitution));
  }

  void add_fixed(std::size_t b) {
    const Body& body = scene_.bodies[b];
    auto skeleton = dd::Skeleton::create(numbered("fixed", int(b)));
    const auto [joint, node] = skeleton->createJointAndBodyNodePair<dd::WeldJoint>();
    Eigen::Isometry3d X = pose(body.start);
    if (body.geometry.form == Form::half_space) {
      const Plane plane = plane_of(body);
      const Eigen::Vector3d n = ev(plane.normal);
      X.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), n).toRotationMatrix();
      // The middle of the face below the bodies' place, not below the origin.
      X.translation() = ev(body.start.position);
      X.translation() += (plane.offset - n.dot(X.translation()) - reach()) * n;
    }
    joint->setTransformFromParentBodyNode(X);
    give_shape(node, body);
    skeleton->setMobile(false);
    skeletons_.push_back(skeleton);
  }

  void add(std::size_t b) {
    const Body& body = scene_.bodies[b];
    dd::BodyNode::Properties properties;
    properties.mName = numbered("b", int(b));
    properties.mInertia = dd::Inertia(body.mass, Eigen::Vector3d::Zero(), ev(body.moments).asDiagonal());
    const int k = tree_.joint[b], parent = tree_.parent[b];
    dd::BodyNode* above = parent < 0 ? nullptr : nodes_[std::size_t(parent)];
    dd::SkeletonPtr skeleton = above ? above->getSkeleton() : dd::Skeleton::create(numbered("s", int(b)));
    if (k < 0) {
      nodes_[b] =
          skeleton
              ->createJointAndBodyNodePair<dd::FreeJoint>(nullptr, dd::FreeJoint::Properties(), properties)
              .second;
      dd::FreeJoint::setTransformOf(nodes_[b], pose(body.start));
    } else {
      hang(b, scene_.joints[std::size_t(k)], skeleton, above, properties);
    }
    give_shape(nodes_[b], body);
    if (!above) skeletons_.push_back(skeleton);
  }

  template <class JointType, class Properties>
  void hang_by(std::size_t b, Properties joint, const Eigen::Isometry3d& at, const dd::SkeletonPtr& skeleton,
               dd::BodyNode* above, const dd::BodyNode::Properties& properties) {
    const Eigen::Isometry3d from =
        above ? pose(scene_.bodies[std::size_t(tree_.parent[b])].start) : Eigen::Isometry3d::Identity();
    joint.mT_ParentBodyToJoint = from.inverse() * at;
    joint.mT_ChildBodyToJoint = pose(scene_.bodies[b].start).inverse() * at;
    joint.mName = numbered("j", int(b));
    nodes_[b] = skeleton->createJointAndBodyNodePair<JointType>(above, joint, properties).second;
  }
  void hang(std::size_t b, const Joint& joint, const dd::SkeletonPtr& skeleton, dd::BodyNode* above,
            const dd::BodyNode::Properties& properties) {
    const End end = end_b(scene_, joint);
    const Eigen::Isometry3d at = pose(end.point, end.frame);
    if (joint.hold == Hold::ball)
      hang_by<dd::BallJoint>(b, dd::BallJoint::Properties(), at, skeleton, above, properties);
    if (joint.hold == Hold::weld)
      hang_by<dd::WeldJoint>(b, dd::WeldJoint::Properties(), at, skeleton, above, properties);
    if (joint.hold == Hold::hinge) {
      dd::RevoluteJoint::Properties hinge;
      hinge.mAxis = Eigen::Vector3d::UnitZ();
      hang_by<dd::RevoluteJoint>(b, hinge, at, skeleton, above, properties);
    }
    if (joint.hold == Hold::slider) {
      dd::PrismaticJoint::Properties slider;
      slider.mAxis = Eigen::Vector3d::UnitZ();
      hang_by<dd::PrismaticJoint>(b, slider, at, skeleton, above, properties);
    }
  }

  void close(const Joint& joint) {
    if (joint.hold != Hold::ball) throw Unsayable("it closes loops by ball joints alone");
    const auto node = [&](int b) { return b < 0 ? nullptr : nodes_[std::size_t(b)]; };
    dd::BodyNode *a = node(joint.a), *b = node(joint.b);
    if (!a) std::swap(a, b);
    const Eigen::Vector3d at = ev(end_b(scene_, joint).point);
    auto constraint = b ? std::make_shared<dart::constraint::BallJointConstraint>(a, b, at)
                        : std::make_shared<dart::constraint::BallJointConstraint>(a, at);
    world_->getConstraintSolver()->addConstraint(constraint);
  }

  /// A free body has its velocity; one of a tree is given it by an impulse in the first step, as its joints
  /// let it.
  void start(int b) {
    const Body& body = scene_.bodies[std::size_t(b)];
    if (tree_.is_free(b)) {
      auto* joint = static_cast<dd::FreeJoint*>(nodes_[std::size_t(b)]->getParentJoint());
      joint->setLinearVelocity(ev(body.start.velocity));
      joint->setAngularVelocity(ev(body.start.spin));
      return;
    }
    const auto [p, l] = starting_impulse(body);
    if (dot(p, p) + dot(l, l) > 0) push(b, 1 / h_ * p, 1 / h_ * l);
  }

  Scene scene_;
  Tree tree_;
  bool is_native_;
  std::vector<dd::BodyNode*> nodes_;
  double h_;
  dart::simulation::WorldPtr world_;
  std::vector<dd::SkeletonPtr> skeletons_;
};

template <bool is_native>
std::unique_ptr<Engine> make(const Scene& scene, double h) {
  return std::make_unique<Dart>(scene, h, is_native);
}

}  // namespace

std::span<const EngineKind> dart_kinds() {
  static const EngineKind kinds[] = {{"dart", "DART 6.12.1", "a half-space is a box", &make<false>},
                                     {"dart-native", "DART 6.12.1, own detector",
                                      "DARTCollisionDetector; a half-space is a box", &make<true>}};
  return kinds;
}

}  // namespace ladders::peers
