// Bullet, its double-precision build.
#include "engine.hpp"
#include "tree.hpp"

#include <btBulletDynamicsCommon.h>

namespace ladders::peers {

namespace {

btVector3 bt(const Triple& x) { return {x[0], x[1], x[2]}; }
btTransform bt(const Triple& x, const Quadruple& q) {
  return btTransform(btQuaternion(q[1], q[2], q[3], q[0]), bt(x));
}
Triple triple(const btVector3& x) { return {x.x(), x.y(), x.z()}; }

/// Left as they are: the solver, its ERP, its slops and margins of boxes, no damping, the gyroscopic term.
/// Set: no sleeping; no margin around hulls, to which it would add; friction and restitution, which Bullet
/// multiplies over a pair, as roots. One step is stepSimulation(h, 0).
class Bullet : public Engine {
 public:
  Bullet(const Scene& scene, int iterations)
      : scene_(scene),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    world_.setGravity(bt(scene.gravity));
    if (iterations > 0) world_.getSolverInfo().m_numIterations = iterations;
    still_ = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &nothing_));
    for (const Body& body : scene.bodies) add(body);
    for (const Joint& joint : scene.joints) add(joint);
  }
  ~Bullet() override {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void push(int body, const Triple& force, const Triple& torque) override {
    bodies_[std::size_t(body)]->applyCentralForce(bt(force));
    bodies_[std::size_t(body)]->applyTorque(bt(torque));
  }
  void step(double h) override { world_.stepSimulation(h, 0); }
  State state(int body) const override {
    const btRigidBody& b = *bodies_[std::size_t(body)];
    const btQuaternion q = b.getWorldTransform().getRotation();
    return {triple(b.getWorldTransform().getOrigin()),
            {q.w(), q.x(), q.y(), q.z()},
            triple(b.getLinearVelocity()),
            triple(b.getAngularVelocity())};
  }

 private:
  std::unique_ptr<btCollisionShape> shape_of(const Geometry& g) const {
    const auto& s = g.size;
    switch (g.form) {
      case Form::none:
        break;
      case Form::half_space:
        return std::make_unique<btStaticPlaneShape>(btVector3(s[0], s[1], s[2]), s[3]);
      case Form::box:
        return std::make_unique<btBoxShape>(btVector3(s[0], s[1], s[2]));
      case Form::sphere:
        return std::make_unique<btSphereShape>(s[0]);
      case Form::capsule:
        return std::make_unique<btCapsuleShapeZ>(s[0], 2 * s[1]);
      case Form::cylinder:
        return std::make_unique<btCylinderShapeZ>(btVector3(s[0], s[0], s[1]));
      case Form::convex: {
        auto hull = std::make_unique<btConvexHullShape>();
        for (const Triple& x : g.corners) hull->addPoint(bt(x), false);
        hull->recalcLocalAabb();
        hull->setMargin(0);
        return hull;
      }
    }
    return std::make_unique<btEmptyShape>();
  }

  void add(const Body& body) {
    shapes_.push_back(shape_of(body.geometry));
    btRigidBody::btRigidBodyConstructionInfo info(body.mass, nullptr, shapes_.back().get(), bt(body.moments));
    info.m_startWorldTransform = bt(body.start.position, body.start.turn);
    info.m_friction = std::sqrt(scene_.friction);
    info.m_restitution = std::sqrt(scene_.restitution);
    auto b = std::make_unique<btRigidBody>(info);
    if (!body.is_fixed) {
      b->setLinearVelocity(bt(body.start.velocity));
      b->setAngularVelocity(bt(body.start.spin));
      b->setActivationState(DISABLE_DEACTIVATION);
    }
    const bool touches = scene_.touches && body.geometry.form != Form::none;
    const int all = btBroadphaseProxy::AllFilter;
    world_.addRigidBody(b.get(), touches ? all : 0, touches ? all : 0);
    bodies_.push_back(std::move(b));
  }

  void add(const Joint& joint) {
    const auto body = [&](int k) -> btRigidBody& { return k < 0 ? *still_ : *bodies_[std::size_t(k)]; };
    btRigidBody &a = body(joint.a), &b = body(joint.b);
    const btTransform on_a = bt(joint.on_a, joint.frame_a), on_b = bt(joint.on_b, joint.frame_b);
    switch (joint.hold) {
      case Hold::ball:
        joints_.push_back(std::make_unique<btPoint2PointConstraint>(a, b, bt(joint.on_a), bt(joint.on_b)));
        break;
      case Hold::hinge:
        joints_.push_back(std::make_unique<btHingeConstraint>(a, b, on_a, on_b));
        break;
      case Hold::slider: {
        // Bullet's slides along x: a quarter turn about y takes x to −z.
        const btTransform quarter(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI));
        joints_.push_back(std::make_unique<btSliderConstraint>(a, b, on_a * quarter, on_b * quarter, true));
        break;
      }
      case Hold::weld:
        joints_.push_back(std::make_unique<btFixedConstraint>(a, b, on_a, on_b));
        break;
    }
    world_.addConstraint(joints_.back().get());
  }

  Scene scene_;
  btEmptyShape nothing_;
  std::unique_ptr<btRigidBody> still_;  ///< the world, for joints
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
};

template <int iterations>
std::unique_ptr<Engine> make(const Scene& scene, double) {
  return std::make_unique<Bullet>(scene, iterations);
}

}  // namespace

std::span<const EngineKind> bullet_kinds() {
  static const EngineKind kinds[] = {
      {"bullet", "Bullet 3.24", "double precision", &make<0>},
      {"bullet-100", "Bullet 3.24, 100 iterations", "m_numIterations = 100", &make<100>}};
  return kinds;
}

}  // namespace ladders::peers
