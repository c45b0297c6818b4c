// ODE, in double precision as Debian has it.
#include "engine.hpp"
#include "tree.hpp"

#include <ode/ode.h>

namespace ladders::peers {

namespace {

/// Left as they are: ERP 0.2, CFM 1e-10, QuickStep's 20 iterations, no damping, no auto-disabling, the
/// gyroscopic term. Set: a contact's `mu` is a coefficient (dContactApprox1), not a force; up to 16 contacts
/// of a pair.
template <bool is_direct>
class Ode : public Engine {
 public:
  explicit Ode(const Scene& scene) : scene_(scene) {
    static const bool is_ready = dInitODE2(0) != 0;
    if (!is_ready) throw std::runtime_error("dInitODE2 failed");
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, scene.gravity[0], scene.gravity[1], scene.gravity[2]);
    for (const Body& body : scene.bodies) add(body);
    for (const Joint& joint : scene.joints) add(joint);
  }
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void push(int body, const Triple& force, const Triple& torque) override {
    dBodyAddForce(bodies_[std::size_t(body)], force[0], force[1], force[2]);
    dBodyAddTorque(bodies_[std::size_t(body)], torque[0], torque[1], torque[2]);
  }

  void step(double h) override {
    if (scene_.touches) dSpaceCollide(space_, this, &Ode::meet);
    is_direct ? dWorldStep(world_, h) : dWorldQuickStep(world_, h);
    dJointGroupEmpty(contacts_);
  }

  State state(int body) const override {
    const dBodyID b = bodies_[std::size_t(body)];
    const dReal *x = dBodyGetPosition(b), *q = dBodyGetQuaternion(b), *v = dBodyGetLinearVel(b),
                *w = dBodyGetAngularVel(b);
    return {{x[0], x[1], x[2]}, {q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2]}, {w[0], w[1], w[2]}};
  }

 private:
  dGeomID geom_of(const Body& body) {
    const auto& s = body.geometry.size;
    switch (body.geometry.form) {
      case Form::none:
        return nullptr;
      case Form::half_space: {
        const Plane plane = plane_of(body);
        return dCreatePlane(space_, plane.normal[0], plane.normal[1], plane.normal[2], plane.offset);
      }
      case Form::box:
        return dCreateBox(space_, 2 * s[0], 2 * s[1], 2 * s[2]);
      case Form::sphere:
        return dCreateSphere(space_, s[0]);
      case Form::capsule:
        return dCreateCapsule(space_, s[0], 2 * s[1]);
      case Form::cylinder:
        return dCreateCylinder(space_, s[0], 2 * s[1]);
      case Form::convex:
        throw Unsayable("hulls were not tried: its own want faces");
    }
    return nullptr;
  }

  void add(const Body& body) {
    const State& s = body.start;
    const dQuaternion turn{s.turn[0], s.turn[1], s.turn[2], s.turn[3]};
    const dGeomID geom = scene_.touches ? geom_of(body) : nullptr;
    if (body.is_fixed) {
      if (geom && body.geometry.form != Form::half_space) {
        dGeomSetPosition(geom, s.position[0], s.position[1], s.position[2]);
        dGeomSetQuaternion(geom, turn);
      }
      bodies_.push_back(nullptr);
      return;
    }
    const dBodyID b = dBodyCreate(world_);
    dMass mass;
    dMassSetParameters(&mass, body.mass, 0, 0, 0, body.moments[0], body.moments[1], body.moments[2], 0, 0, 0);
    dBodySetMass(b, &mass);
    dBodySetPosition(b, s.position[0], s.position[1], s.position[2]);
    dBodySetQuaternion(b, turn);
    dBodySetLinearVel(b, s.velocity[0], s.velocity[1], s.velocity[2]);
    dBodySetAngularVel(b, s.spin[0], s.spin[1], s.spin[2]);
    if (geom) dGeomSetBody(geom, b);
    bodies_.push_back(b);
  }

  void add(const Joint& joint) {
    const dBodyID a = joint.a < 0 ? nullptr : bodies_[std::size_t(joint.a)],
                  b = joint.b < 0 ? nullptr : bodies_[std::size_t(joint.b)];
    const End on_a = end_a(scene_, joint), on_b = end_b(scene_, joint);
    const Triple& x = on_b.point;
    const Triple axis = z_axis(on_b.frame);
    if (joint.hold != Hold::ball) expect_together(scene_);
    dJointID j = nullptr;
    switch (joint.hold) {
      case Hold::ball: {
        // The second anchor is told in the frame of the second body, or of the world; the first body must be
        // one.
        const bool has_b = b != nullptr;
        const Triple first = has_b ? on_b.point : on_a.point;
        const Triple second = has_b ? (a ? joint.on_a : on_a.point) : on_b.point;
        j = dJointCreateBall(world_, nullptr);
        dJointAttach(j, has_b ? b : a, has_b ? a : nullptr);
        dJointSetBallAnchor(j, first[0], first[1], first[2]);
        dJointSetBallAnchor2(j, second[0], second[1], second[2]);
        break;
      }
      case Hold::hinge:
        j = dJointCreateHinge(world_, nullptr);
        dJointAttach(j, b, a);
        dJointSetHingeAnchor(j, x[0], x[1], x[2]);
        dJointSetHingeAxis(j, axis[0], axis[1], axis[2]);
        break;
      case Hold::slider:
        j = dJointCreateSlider(world_, nullptr);
        dJointAttach(j, b, a);
        dJointSetSliderAxis(j, axis[0], axis[1], axis[2]);
        break;
      case Hold::weld:
        j = dJointCreateFixed(world_, nullptr);
        dJointAttach(j, b, a);
        dJointSetFixed(j);
        break;
    }
  }

  static void meet(void* self, dGeomID one, dGeomID other) {
    auto& ode = *static_cast<Ode*>(self);
    const dBodyID a = dGeomGetBody(one), b = dGeomGetBody(other);
    if (!a && !b) return;
    constexpr int most = 16;
    dContact contacts[most];
    const int count = dCollide(one, other, most, &contacts[0].geom, sizeof(dContact));
    for (int k = 0; k < count; ++k) {
      dSurfaceParameters& surface = contacts[k].surface;
      surface.mode = dContactApprox1;
      surface.mu = ode.scene_.friction;
      if (ode.scene_.restitution > 0) {
        surface.mode |= dContactBounce;
        surface.bounce = ode.scene_.restitution;
        surface.bounce_vel = 0;
      }
      dJointAttach(dJointCreateContact(ode.world_, ode.contacts_, &contacts[k]), a, b);
    }
  }

  Scene scene_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
};

template <bool is_direct>
std::unique_ptr<Engine> make(const Scene& scene, double) {
  return std::make_unique<Ode<is_direct>>(scene);
}

}  // namespace

std::span<const EngineKind> ode_kinds() {
  static const EngineKind kinds[] = {
      {"ode", "ODE 0.16.2", "dWorldQuickStep; contact's mu a coefficient", &make<false>},
      {"ode-direct", "ODE 0.16.2 direct", "dWorldStep; contact's mu a coefficient", &make<true>}};
  return kinds;
}

}  // namespace ladders::peers
