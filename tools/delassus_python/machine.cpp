// A machine of a file, as Python sees it.
#include "machine.hpp"

#include "../delassus_run/joint_numbers.hpp"
#include "../delassus_run/read.hpp"
#include "keywords.hpp"

#include <delassus/math/twist.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace py = pybind11;

namespace delassus_run {

namespace {

/// An array that Python may not write.
PythonMachine::Numbers read_only(PythonMachine::Numbers array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}
double* data(PythonMachine::Numbers& array) { return const_cast<double*>(array.data()); }

template <class V>
void put(PythonMachine::Numbers& array, std::size_t row, const V& x) {
  for (int k = 0; k < 3; ++k) data(array)[3 * row + std::size_t(k)] = x[k];
}

void expect_finite(const PythonMachine::Numbers& array, const char* name) {
  for (py::ssize_t k = 0; k < array.size(); ++k)
    DELASSUS_EXPECT(std::isfinite(array.data()[k]), "step: " + std::string(name) + "[" + std::to_string(k) + "] is not finite; write a number there");
}

/// A size that Python gave, against the one it must have.
std::span<const double> list_of(const PythonMachine::Numbers& array, Index size, const char* name) {
  DELASSUS_EXPECT(array.ndim() == 1 && array.size() == size, "set_state: " + std::string(name) + " must have " + std::to_string(size) + " numbers in one row");
  return {array.data(), std::size_t(size)};
}

}  // namespace

/// The turn of one thread to use a loop.
class PythonMachine::Turn {
 public:
  explicit Turn(PythonMachine& machine) : is_busy_(machine.is_busy_) {
    DELASSUS_EXPECT(!is_busy_, "another thread uses this machine; wait for its step, or make a machine for each thread");
    is_busy_ = true;
  }
  ~Turn() { is_busy_ = false; }

 private:
  bool& is_busy_;
};

PythonMachine::PythonMachine(const std::string& path, const py::dict& keywords) : options_(options_of(keywords)) {
  DELASSUS_EXPECT(std::filesystem::is_regular_file(path), "Machine: there is no file '" + path + "'");
  options_.seconds = Options::most_steps;  // a run has no end here
  dt = options_.caller_step();
  model_ = read(path, options_);
  start_ = std::make_unique<Start>(model_, options_);
  space_ = std::make_unique<JointSpace>(model_, options_.base, start_->pose());
  for (const model::Joint& joint : model_.joints) joints.push_back(joint.name);
  Index q_next = 0, v_next = 0;
  for (const model::Body& body : model_.bodies) {
    if (options_.base == Base::free && body.parent < 0 && body.joints.empty() && !body.is_kinematic)  // as `JointSpace` says, ahead of all others
      freedoms_.push_back({model::JointKind::free, Index(links.size()), -1, v_next}), q_index[body.name] = q_next, v_index[body.name] = v_next, q_next += 7, v_next += 6;
    for (const Index j : body.joints)
      if (const Index at = space_->v_of(j); at >= 0)
        freedoms_.push_back({model_.joints[std::size_t(j)].kind, Index(links.size()), j, at}), q_index[joints[std::size_t(j)]] = space_->q_of(j), v_index[joints[std::size_t(j)]] = at;
    links.push_back(body.name);
  }
  const py::ssize_t n = py::ssize_t(links.size());
  q = read_only(Numbers(space_->q_size())), v = read_only(Numbers(space_->v_size())), forces = Numbers(space_->v_size());
  positions = read_only(Numbers({n, py::ssize_t(3)})), orientations = read_only(Numbers({n, py::ssize_t(4)}));
  velocities = read_only(Numbers({n, py::ssize_t(3)})), angular_velocities = read_only(Numbers({n, py::ssize_t(3)}));
  reset();
  for (const auto* list : {&model_.skipped, &start_->notes, &motion_->machine.left_out})
    for (const std::string& sentence : *list) notes.push_back(in_words_of_options(sentence));
}

void PythonMachine::reset() {
  const Turn turn(*this);
  motion_ = start_->put(options_.asked());
  const Machine& machine = motion_->machine;
  if (actuators.empty())
    for (const model::Actuation& act : machine.actuators) actuators.push_back(act.actuator.name);
  if (controls.size() != py::ssize_t(machine.controls.size())) controls = Numbers(py::ssize_t(machine.controls.size()));
  std::copy(machine.controls.begin(), machine.controls.end(), controls.mutable_data());
  std::fill_n(forces.mutable_data(), forces.size(), 0.);
  poses_.assign(links.size() + 1, {}), twists_.assign(links.size() + 1, zero<Vec<6>>());
  q_.resize(std::size_t(space_->q_size())), v_.resize(std::size_t(space_->v_size())), tau_.assign(v_.size(), 0);
  space_->reference(q_);
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (has_number(model_.joints[j]) && space_->q_of(Index(j)) >= 0) q_[std::size_t(space_->q_of(Index(j)))] = motion_->joints[j];
  read_places(), write_arrays();
}

Steps PythonMachine::step(long count) {
  DELASSUS_EXPECT(count >= 1, "step: the number of steps must be 1 or more, not " + std::to_string(count));
  const Turn turn(*this);
  DELASSUS_EXPECT(controls.size() == py::ssize_t(actuators.size()) && forces.size() == py::ssize_t(tau_.size()), "step: controls and forces must keep their sizes");
  expect_finite(controls, "controls"), expect_finite(forces, "forces");
  std::copy_n(controls.data(), controls.size(), motion_->machine.controls.begin());
  std::copy_n(forces.data(), forces.size(), tau_.begin());
  Steps steps;
  try {
    while (steps.count < count) {
      {
        const py::gil_scoped_release release;
        run(count - steps.count, steps);
      }
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  } catch (...) {
    write_arrays();
    throw;
  }
  return write_arrays(), steps;
}

/// Some steps, as many as a moment takes.
void PythonMachine::run(long most, Steps& steps) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  for (long n = 0; n < most && (n == 0 || std::chrono::steady_clock::now() < end); ++n) {
    push();
    const StepReport report = motion_->step(dt);
    ++steps.count;
    steps.unconverged += report.status != Status::converged && report.status != Status::stalled;
    steps.residual = std::max(steps.residual, report.residual);
    steps.joint_gap = std::max(steps.joint_gap, report.max_joint_violation), steps.overlap = std::max(steps.overlap, report.max_penetration);
    read_places();
    if (report.quarantined > 0) inner::refuse("step: bodies were held since their motion was not finite; see forces and controls, and reset()");
  }
}

/// τ acts as a motor of each joint does: between its two bodies.
void PythonMachine::push() {
  RigidBodies& set = motion_->set();
  for (const Freedom& of : freedoms_) {
    const double* tau = &tau_[std::size_t(of.at)];
    const model::Part& part = motion_->machine.parts[std::size_t(of.link)];
    const bool is_free = of.kind == model::JointKind::free;
    if (part.is_world) continue;
    if (!is_free && of.kind != model::JointKind::ball) {
      if (*tau != 0) push_joint(*motion_, motion_->machine, of.joint, *tau);
      continue;
    }
    const Pose& at = poses_[std::size_t(of.link) + 1];
    const Vec3 moment = at.rotation * (is_free ? Vec3(tau[3], tau[4], tau[5]) : Vec3(tau[0], tau[1], tau[2]));
    const Index parent = model_.bodies[std::size_t(of.link)].parent;
    if (is_free) set.apply_force(part.body, Vec3(tau[0], tau[1], tau[2]), at.position);
    set.apply_torque(part.body, moment);
    if (!is_free && parent >= 0 && !motion_->machine.parts[std::size_t(parent)].is_world) set.apply_torque(motion_->machine.parts[std::size_t(parent)].body, Vec3(-1.0 * moment));
  }
}

/// q goes on from the last one, so that turns are counted.
void PythonMachine::read_places() {
  for (std::size_t b = 0; b < links.size(); ++b) {
    poses_[b + 1] = pose_of(motion_->set(), motion_->machine, Index(b));
    space_->read_q(Index(b), poses_[std::size_t(model_.bodies[b].parent + 1)], poses_[b + 1], q_);
  }
}

void PythonMachine::read_rates() {
  const RigidBodies& set = motion_->set();
  for (std::size_t b = 0; b < links.size(); ++b) {
    if (const model::Part& part = motion_->machine.parts[b]; !part.is_world) {
      const Vec3 spin = set.angular_velocity(part.body);
      twists_[b + 1] = twist<double>(Vec3(set.velocity(part.body) + cross(spin, Vec3(poses_[b + 1].position - set.position(part.body)))), spin);
    }
    const std::size_t parent = std::size_t(model_.bodies[b].parent + 1);
    space_->read_v(Index(b), q_, poses_[parent], poses_[b + 1], twists_[parent], twists_[b + 1], v_);
  }
}

void PythonMachine::write_arrays() {
  read_rates();
  time = motion_->time();
  std::copy(q_.begin(), q_.end(), data(q));
  std::copy(v_.begin(), v_.end(), data(v));
  for (std::size_t b = 0; b < links.size(); ++b) {
    const Quat turn = unit(Quat(poses_[b + 1].rotation));
    std::copy_n(std::array{turn.w(), turn.x(), turn.y(), turn.z()}.data(), 4, data(orientations) + 4 * b);
    put(positions, b, poses_[b + 1].position), put(velocities, b, linear_part(twists_[b + 1])), put(angular_velocities, b, angular_part(twists_[b + 1]));
  }
  const std::span<const ContactResult> contacts = motion_->contacts();
  const py::ssize_t n = py::ssize_t(contacts.size());
  const double last = motion_->error_report().last_step, h = last > 0 ? last : dt;
  contact_points = Numbers({n, py::ssize_t(3)}), contact_normals = Numbers({n, py::ssize_t(3)}), contact_forces = Numbers({n, py::ssize_t(3)});
  contact_gaps = Numbers(n), contact_links = py::array_t<int>({n, py::ssize_t(2)});
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const ContactResult& c = contacts[k];
    put(contact_points, k, c.record.point()), put(contact_normals, k, c.record.normal), put(contact_forces, k, Vec3((1 / h) * c.impulse));
    data(contact_gaps)[k] = c.record.gap;
    contact_links.mutable_data()[2 * k] = link_of(motion_->machine, c.record.a), contact_links.mutable_data()[2 * k + 1] = link_of(motion_->machine, c.record.b);
  }
}

void PythonMachine::set_state(const Numbers& to_q, const Numbers& to_v) {
  const Turn turn(*this);
  const auto new_q = list_of(to_q, space_->q_size(), "q"), new_v = list_of(to_v, space_->v_size(), "v");
  motion_->set_joints(*space_, new_q, new_v);
  std::copy(new_q.begin(), new_q.end(), q_.begin());
  read_places(), write_arrays();
}

PythonMachine::Numbers PythonMachine::gravity_compensation() {
  const Turn turn(*this);
  Numbers tau(space_->v_size());
  space_->gravity_compensation(q_, {tau.mutable_data(), std::size_t(tau.size())});
  return tau;
}

}  // namespace delassus_run
