// A machine of a file, as Python sees it.
#include "machine.hpp"

#include "../delassus_run/joint_numbers.hpp"
#include "../delassus_run/read.hpp"
#include "keywords.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <utility>

namespace py = pybind11;

namespace delassus_run {

namespace {

/// An array that does not own its numbers, so that Python cannot resize it.
PythonMachine::Numbers new_array(std::vector<py::ssize_t> shape, bool is_read_only) {
  py::ssize_t size = 1;
  for (const py::ssize_t n : shape) size *= n;
  auto* const numbers = new double[std::size_t(size) + 1]();
  PythonMachine::Numbers array(std::move(shape), numbers, py::capsule(numbers, [](void* all) { delete[] static_cast<double*>(all); }));
  if (is_read_only) array.attr("setflags")(py::arg("write") = false);
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
  DELASSUS_EXPECT(array.ndim() == 1 && array.size() == size, "set_state: " + std::string(name) + " must have " + std::to_string(size) + " numbers in one row, not " + std::to_string(array.size()));
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
  options_.seconds = Options::most_steps;  // a run has no end here
  dt = options_.caller_step();
  model_ = read(path, options_);
  start_ = std::make_unique<Start>(model_, options_);
  for (model::Joint& joint : model_.joints)
    if (!has_number(joint)) joint.stiffness = joint.damping = joint.armature = 0;  // these do not act in a loop
  reader_ = std::make_unique<JointReader>(model_, options_.base, start_->pose());
  JointSpace& space = reader_->space();
  Index roots = 0;
  for (const model::Body& body : model_.bodies) {
    // As JointSpace numbers them: such roots are ahead of all others.
    if (options_.base == Base::free && body.parent < 0 && body.joints.empty() && !body.is_kinematic)
      freedoms_.push_back({model::JointKind::free, Index(links.size()), -1, 7 * roots, 6 * roots}), ++roots;
    for (const Index j : body.joints)
      if (space.v_of(j) >= 0) freedoms_.push_back({model_.joints[std::size_t(j)].kind, Index(links.size()), j, space.q_of(j), space.v_of(j)});
    links.push_back(body.name);
  }
  std::sort(freedoms_.begin(), freedoms_.end(), [](const Freedom& a, const Freedom& b) { return a.v < b.v; });
  for (const Freedom& of : freedoms_) {
    std::string name = of.joint < 0 ? links[std::size_t(of.link)] : model_.joints[std::size_t(of.joint)].name;
    if (name.empty()) name = "joint " + std::to_string(joints.size());
    while (q_index.contains(name)) name += "_";
    joints.push_back(name);
    q_index[py::str(joints.back())] = of.q, v_index[py::str(joints.back())] = of.v;
  }
  const py::ssize_t n = py::ssize_t(links.size());
  q = new_array({space.q_size()}, true), v = new_array({space.v_size()}, true), forces = new_array({space.v_size()}, false);
  positions = new_array({n, 3}, true), orientations = new_array({n, 4}, true), velocities = new_array({n, 3}, true), angular_velocities = new_array({n, 3}, true);
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
  if (controls.size() != py::ssize_t(machine.controls.size())) controls = new_array({py::ssize_t(machine.controls.size())}, false);
  std::copy(machine.controls.begin(), machine.controls.end(), data(controls)), std::fill_n(data(forces), forces.size(), 0.);
  JointSpace& space = reader_->space();
  q_.resize(std::size_t(space.q_size())), v_.resize(std::size_t(space.v_size())), tau_.assign(v_.size(), 0);
  space.reference(q_);
  for (std::size_t j = 0; j < model_.joints.size(); ++j)
    if (has_number(model_.joints[j]) && space.q_of(Index(j)) >= 0) q_[std::size_t(space.q_of(Index(j)))] = motion_->joints[j];
  write_arrays();
}

Steps PythonMachine::step(long count) {
  DELASSUS_EXPECT(count >= 1, "step: the number of steps must be 1 or more, not " + std::to_string(count));
  const Turn turn(*this);
  expect_finite(controls, "controls"), expect_finite(forces, "forces");
  std::copy_n(controls.data(), controls.size(), motion_->machine.controls.begin()), std::copy_n(forces.data(), forces.size(), tau_.begin());
  Steps steps;
  std::exception_ptr error;
  while (steps.count < count && !error) {
    PyThreadState* const thread = PyEval_SaveThread();
    try {
      run(count - steps.count, steps);
    } catch (...) {
      error = std::current_exception();
    }
    PyEval_RestoreThread(thread);  // does not come back where the program ends meanwhile: no destructor may do it
    if (!error && PyErr_CheckSignals() != 0) error = std::make_exception_ptr(py::error_already_set());
  }
  write_arrays();
  if (error) std::rethrow_exception(error);
  return steps;
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
    reader_->read_q(motion_->set(), motion_->machine, q_);
    if (report.quarantined > 0) inner::refuse("step: bodies were held since their motion was not finite; see forces and controls, and reset()");
  }
}

/// τ acts as a motor of each joint does: between its two bodies, along the axes halfway through the step.
void PythonMachine::push() {
  RigidBodies& set = motion_->set();
  for (const Freedom& of : freedoms_) {
    const double* tau = &tau_[std::size_t(of.v)];
    const model::Part& part = motion_->machine.parts[std::size_t(of.link)];
    const bool is_free = of.kind == model::JointKind::free;
    if (part.is_world) continue;
    if (!is_free && of.kind != model::JointKind::ball) {
      const model::Axis& axis = motion_->machine.axes[std::size_t(of.joint)];
      if (*tau != 0) inner::push_between(motion_->world(), axis.kind, axis.a, axis.b, axis.sign * *tau, dt / 2);
      continue;
    }
    const Pose& at = reader_->poses()[std::size_t(of.link)];
    const Mat3 half = rotation_matrix(exponential<double>(dt / 2 * set.angular_velocity(part.body)));
    const Vec3 force(tau[0], tau[1], tau[2]), moment = half * Vec3(at.rotation * (is_free ? Vec3(tau[3], tau[4], tau[5]) : force));
    const Index parent = model_.bodies[std::size_t(of.link)].parent;
    if (is_free) set.apply_force(part.body, force), set.apply_torque(part.body, cross(Vec3(half * Vec3(at.position - set.position(part.body))), force));
    set.apply_torque(part.body, moment);
    if (!is_free && parent >= 0 && !motion_->machine.parts[std::size_t(parent)].is_world) set.apply_torque(motion_->machine.parts[std::size_t(parent)].body, Vec3(-1.0 * moment));
  }
}

void PythonMachine::write_arrays() {
  motion_->read_joints(*reader_, q_, v_);
  time = motion_->time();
  std::copy(q_.begin(), q_.end(), data(q)), std::copy(v_.begin(), v_.end(), data(v));
  for (std::size_t b = 0; b < links.size(); ++b) {
    const Quat turn = unit(Quat(reader_->poses()[b].rotation));
    std::copy_n(std::array{turn.w(), turn.x(), turn.y(), turn.z()}.data(), 4, data(orientations) + 4 * b);
    put(positions, b, reader_->poses()[b].position), put(velocities, b, linear_part(reader_->velocities()[b])), put(angular_velocities, b, angular_part(reader_->velocities()[b]));
  }
  const std::span<const ContactResult> contacts = motion_->contacts();
  const py::ssize_t n = py::ssize_t(contacts.size());
  contact_points = Numbers({n, py::ssize_t(3)}), contact_normals = Numbers({n, py::ssize_t(3)}), contact_forces = Numbers({n, py::ssize_t(3)});
  contact_gaps = Numbers(n), contact_links = py::array_t<int>({n, py::ssize_t(2)});
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const ContactResult& c = contacts[k];
    const Index a = link_of(motion_->machine, c.record.a), b = link_of(motion_->machine, c.record.b);
    const double sign = b < 0 ? -1 : 1;  // what is no link comes first
    put(contact_points, k, c.record.point()), put(contact_normals, k, Vec3(sign * c.record.normal)), put(contact_forces, k, Vec3((sign / dt) * c.impulse));
    data(contact_gaps)[k] = c.record.gap;
    contact_links.mutable_data()[2 * k] = b < 0 ? b : a, contact_links.mutable_data()[2 * k + 1] = b < 0 ? a : b;
  }
}

void PythonMachine::set_state(const Numbers& to_q, const Numbers& to_v) {
  const Turn turn(*this);
  const auto new_q = list_of(to_q, reader_->space().q_size(), "q"), new_v = list_of(to_v, reader_->space().v_size(), "v");
  motion_->set_joints(reader_->space(), new_q, new_v);
  std::copy(new_q.begin(), new_q.end(), q_.begin()), write_arrays();
}

PythonMachine::Numbers PythonMachine::gravity_compensation() {
  const Turn turn(*this);
  Numbers tau(reader_->space().v_size());
  reader_->space().gravity_compensation(q_, {tau.mutable_data(), std::size_t(tau.size())});
  return tau;
}

}  // namespace delassus_run
