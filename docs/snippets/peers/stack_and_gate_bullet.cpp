// The stack and the gate in Bullet.
// prints: top at 4\.[0-9]+ m, gate at 1\.[0-9]+ rad
#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <memory>
#include <vector>

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broad_phase, &solver, &configuration);
  world.setGravity({0, 0, btScalar(-9.81)});

  std::vector<std::unique_ptr<btRigidBody>> bodies;
  const auto add = [&](btScalar mass, btCollisionShape& shape, const btVector3& position) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(position);
    info.m_friction = btSqrt(btScalar(0.6));  // two bodies multiply theirs
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies.back().get());
    return bodies.back().get();
  };

  btStaticPlaneShape ground({0, 0, 1}, 0);
  btBoxShape cube({0.5, 0.5, 0.5}), leaf({0.5, btScalar(0.05), 0.5});  // half lengths
  add(0, ground, {0, 0, 0});
  btRigidBody* top = nullptr;
  for (int i = 0; i < 5; ++i) top = add(1, cube, {0, 0, btScalar(0.5 + i)});

  btRigidBody* gate = add(10, leaf, {3.5, 0, 1.5});
  gate->setActivationState(DISABLE_DEACTIVATION);
  // with one body the angle is that of the world against it: the axis points down
  btHingeConstraint hinge(*gate, btVector3(-0.5, 0, 0), btVector3(0, 0, -1), true);
  const btScalar h = btScalar(0.002);
  hinge.setLimit(0, btScalar(1.2));
  hinge.enableAngularMotor(true, 1, 20 * h);  // the cap is an impulse
  world.addConstraint(&hinge);

  for (int i = 0; i < 1000; ++i) world.stepSimulation(h, 0);
  std::printf("top at %.3f m, gate at %.3f rad\n", double(top->getWorldTransform().getOrigin().z()),
              double(hinge.getHingeAngle()));
  world.removeConstraint(&hinge);
  for (const auto& body : bodies) world.removeRigidBody(body.get());
}
