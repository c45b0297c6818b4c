#include "same_model.hpp"

#include <algorithm>

namespace delassus {
namespace {

/// What a tendon of MuJoCo wraps around, and what an actuator pulls, is left out here: such files have fewer.
bool is_read(const mjModel& m, int tendon) {
  for (int k = 0; k < m.tendon_num[tendon]; ++k) {
    const int type = m.wrap_type[m.tendon_adr[tendon] + k];
    if (type != mjWRAP_JOINT && type != mjWRAP_SITE) return false;
  }
  return true;
}
bool actuator_is_read(const mjModel& m, int i) {
  if (m.actuator_trntype[i] == mjTRN_SLIDERCRANK || m.actuator_biastype[i] == mjBIAS_MUSCLE) return false;
  return m.actuator_trntype[i] != mjTRN_TENDON || is_read(m, m.actuator_trnid[2 * i]);
}

}  // namespace

void check_tendons(const Model& model, const mjModel& m) {
  std::size_t next = 0;
  for (int i = 0; i < m.ntendon; ++i) {
    if (!is_read(m, i)) continue;
    REQUIRE(next < model.tendons.size());
    const model::Tendon& t = model.tendons[next++];
    CAPTURE(t.name, i);
    CHECK(t.name == name_of(m, mjOBJ_TENDON, i));
    REQUIRE(int(t.joints.size() + t.sites.size()) == m.tendon_num[i]);
    for (int k = 0; k < m.tendon_num[i]; ++k) {
      const int w = m.tendon_adr[i] + k;
      if (t.joints.empty()) {
        CHECK(t.sites[std::size_t(k)] == m.wrap_objid[w]);
      } else {
        CHECK(t.joints[std::size_t(k)].joint == m.wrap_objid[w]);
        check_same(t.joints[std::size_t(k)].coefficient, m.wrap_prm[w]);
      }
    }
    CHECK(t.is_limited == bool(m.tendon_limited[i]));
    if (t.is_limited) {
      check_same(t.lower, m.tendon_range[2 * i]);
      check_same(t.upper, m.tendon_range[2 * i + 1]);
    }
    check_same(t.stiffness, m.tendon_stiffness[i]);
    check_same(t.damping, m.tendon_damping[i]);
    check_same(t.friction_loss, m.tendon_frictionloss[i]);
    CHECK(std::abs(t.rest_lower - m.tendon_lengthspring[i]) < 1e-9);
  }
  CHECK(next == model.tendons.size());
}

void check_actuators(const Model& model, const mjModel& m) {
  std::size_t next = 0;
  for (int i = 0; i < m.nu; ++i) {
    if (!actuator_is_read(m, i)) continue;
    REQUIRE(next < model.actuators.size());
    const model::Actuator& a = model.actuators[next++];
    CAPTURE(a.name, i);
    CHECK(a.name == name_of(m, mjOBJ_ACTUATOR, i));
    const int on = m.actuator_trntype[i];
    const auto transmission = on == mjTRN_TENDON ? model::Transmission::tendon
                              : on == mjTRN_SITE ? model::Transmission::site
                                                 : model::Transmission::joint;
    CHECK(a.transmission == transmission);
    CHECK(a.target == m.actuator_trnid[2 * i]);
    for (int k = 0; k < 6; ++k) check_same(a.gear[std::size_t(k)], m.actuator_gear[6 * i + k]);
    check_same(a.gain, m.actuator_gainprm[mjNGAIN * i]);
    const bool is_affine = m.actuator_biastype[i] == mjBIAS_AFFINE;
    for (int k = 0; k < 3; ++k)
      check_same(a.bias[std::size_t(k)], is_affine ? m.actuator_biasprm[mjNBIAS * i + k] : 0);
    check_same(a.time_constant, m.actuator_dyntype[i] == mjDYN_FILTER ? m.actuator_dynprm[mjNDYN * i] : 0);
    CHECK(a.control_is_limited == bool(m.actuator_ctrllimited[i]));
    CHECK(a.force_is_limited == bool(m.actuator_forcelimited[i]));
    if (a.control_is_limited) {
      check_same(a.control_lower, m.actuator_ctrlrange[2 * i]);
      check_same(a.control_upper, m.actuator_ctrlrange[2 * i + 1]);
    }
    if (a.force_is_limited) {
      check_same(a.force_lower, m.actuator_forcerange[2 * i]);
      check_same(a.force_upper, m.actuator_forcerange[2 * i + 1]);
    }
  }
  CHECK(next == model.actuators.size());
}

namespace {

void check_equalities(const Model& model, const mjModel& m) {
  std::size_t coupling = 0, connect = 0, weld = 0;
  for (int i = 0; i < m.neq; ++i) {
    const mjtNum* data = &m.eq_data[mjNEQDATA * i];
    CAPTURE(i);
    if (m.eq_type[i] == mjEQ_JOINT || m.eq_type[i] == mjEQ_TENDON) {
      REQUIRE(coupling < model.couplings.size());
      const model::Coupling& c = model.couplings[coupling++];
      CHECK(c.of_tendons == (m.eq_type[i] == mjEQ_TENDON));
      CHECK(c.joint == m.eq_obj1id[i]);
      CHECK(c.other == m.eq_obj2id[i]);
      for (int k = 0; k < 5; ++k) check_same(c.coefficients[std::size_t(k)], data[k]);
    } else if (m.eq_type[i] == mjEQ_CONNECT) {
      REQUIRE(connect < model.connects.size());
      const model::Connect& c = model.connects[connect++];
      CHECK(c.body == m.eq_obj1id[i] - 1);
      CHECK(c.other == m.eq_obj2id[i] - 1);
      check_same(c.point, vector_at(data, 0), 1e-3);
      check_same(c.other_point, vector_at(data, 1), 1e-3);
    } else if (m.eq_type[i] == mjEQ_WELD) {
      REQUIRE(weld < model.welds.size());
      const model::Weld& w = model.welds[weld++];
      CHECK(w.body == m.eq_obj1id[i] - 1);
      CHECK(w.other == m.eq_obj2id[i] - 1);
      const Mat3 turn = rotation_matrix(unit(Quat(data[6], data[7], data[8], data[9])));
      check_same(w.pose.rotation, turn);
      // MuJoCo keeps the anchor in the other body, and where it lies in this one.
      check_same(w.pose.position, Vec3(vector_at(data, 1) - turn * vector_at(data, 0)), 1e-3);
    }
  }
  CHECK(coupling == model.couplings.size());
  CHECK(connect == model.connects.size());
  CHECK(weld == model.welds.size());
}

}  // namespace

void check_rest(const Model& model, const mjModel& m) {
  check_equalities(model, m);
  check_same(model.time_step, m.opt.timestep);
  for (int k = 0; k < 3; ++k)
    CHECK(model.gravity[k] == (m.opt.disableflags & mjDSBL_GRAVITY ? 0 : m.opt.gravity[k]));
  CHECK(model.contacts == !(m.opt.disableflags & (mjDSBL_CONTACT | mjDSBL_CONSTRAINT)));
  REQUIRE(Index(model.keyframes.size()) == m.nkey);
  for (int i = 0; i < m.nkey; ++i) {
    const model::Keyframe& key = model.keyframes[std::size_t(i)];
    CHECK(key.name == name_of(m, mjOBJ_KEY, i));
    check_same(key.time, m.key_time[i]);
    REQUIRE(int(key.q.size()) == m.nq);
    REQUIRE(int(key.v.size()) == m.nv);
    // MuJoCo makes unit quaternions of those of a key.
    for (int k = 0; k < m.nq; ++k) CHECK(std::abs(key.q[std::size_t(k)] - m.key_qpos[m.nq * i + k]) < 1e-5);
    for (int k = 0; k < m.nv; ++k) check_same(key.v[std::size_t(k)], m.key_qvel[m.nv * i + k]);
  }
  REQUIRE(Index(model.excludes.size()) == m.nexclude);
  for (int i = 0; i < m.nexclude; ++i) {
    const int a = model.excludes[std::size_t(i)].body + 1, b = model.excludes[std::size_t(i)].other + 1;
    CHECK(((std::min(a, b) + 1) << 16) + std::max(a, b) + 1 ==
          m.exclude_signature[i]);  // each one more, up to MuJoCo 2
  }
  REQUIRE(Index(model.pairs.size()) == m.npair);
  for (int i = 0; i < m.npair; ++i) {
    const model::Pair& p = model.pairs[std::size_t(i)];
    CHECK(std::min(p.geometry, p.other) == std::min(m.pair_geom1[i], m.pair_geom2[i]));
    CHECK(std::max(p.geometry, p.other) == std::max(m.pair_geom1[i], m.pair_geom2[i]));
    CHECK(p.contact_freedoms == m.pair_dim[i]);
    check_same(p.friction, m.pair_friction[5 * i]);
    check_same(p.spinning_friction, m.pair_friction[5 * i + 2]);
    check_same(p.rolling_friction, m.pair_friction[5 * i + 3]);
  }
}

}  // namespace delassus
