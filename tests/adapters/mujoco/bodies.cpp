#include "same_model.hpp"

namespace delassus {

void check_bodies(const Model& model, const mjModel& m) {
  REQUIRE(Index(model.bodies.size()) == m.nbody - 1);
  for (int i = 1; i < m.nbody; ++i) {
    const model::Body& body = model.bodies[std::size_t(i - 1)];
    CAPTURE(body.name, i);
    CHECK(body.name == name_of(m, mjOBJ_BODY, i));
    CHECK(body.parent == m.body_parentid[i] - 1);
    check_same(body.pose, m.body_pos, m.body_quat, i);
    check_same(body.mass, m.body_mass[i]);
    CHECK(Index(body.joints.size()) == m.body_jntnum[i]);
    if (body.mass == 0) continue;  // then its centre is nowhere
    check_same(body.centre, vector_at(m.body_ipos, i), 1e-3);
    const Mat3 axes = turn_at(m.body_iquat, i);
    const Vec3 moments = vector_at(m.body_inertia, i);
    Mat3 turned = axes;
    for (int k = 0; k < 9; ++k) turned.data()[k] *= moments[k / 3];
    check_same(body.inertia, times_transposed(turned, axes));
  }
}

void check_joints(const Model& model, const mjModel& m) {
  REQUIRE(Index(model.joints.size()) == m.njnt);
  constexpr model::JointKind kinds[] = {model::JointKind::free, model::JointKind::ball,
                                        model::JointKind::slide, model::JointKind::hinge};
  for (int i = 0; i < m.njnt; ++i) {
    const model::Joint& joint = model.joints[std::size_t(i)];
    const int q = m.jnt_qposadr[i], v = m.jnt_dofadr[i];
    CAPTURE(joint.name, i);
    CHECK(joint.name == name_of(m, mjOBJ_JOINT, i));
    CHECK(joint.kind == kinds[m.jnt_type[i]]);
    const auto& of_body = model.bodies[std::size_t(m.jnt_bodyid[i] - 1)].joints;
    CHECK(of_body[std::size_t(i - m.body_jntadr[m.jnt_bodyid[i]])] == i);
    CHECK(joint.is_limited == bool(m.jnt_limited[i]));
    if (joint.is_limited) {
      check_same(joint.lower, m.jnt_range[2 * i]);
      check_same(joint.upper, m.jnt_range[2 * i + 1]);
    }
    check_same(joint.damping, m.dof_damping[v]);
    check_same(joint.friction_loss, m.dof_frictionloss[v]);
    check_same(joint.armature, m.dof_armature[v]);
    check_same(joint.stiffness, m.jnt_stiffness[i]);
    if (m.jnt_type[i] < mjJNT_SLIDE) continue;
    check_same(joint.point, vector_at(m.jnt_pos, i), 1e-3);
    check_same(joint.axis, vector_at(m.jnt_axis, i));
    check_same(joint.reference, m.qpos0[q]);
    check_same(joint.spring_reference, m.qpos_spring[q]);
  }
}

}  // namespace delassus
