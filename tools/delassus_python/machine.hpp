/// A machine of a file, as Python sees it.
#pragma once

#include "../delassus_run/start.hpp"

#include <delassus/model/joint_reader.hpp>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace delassus_run {

/// What a call of `step` did.
struct Steps {
  long count = 0, unconverged = 0;
  double residual = 0, joint_gap = 0, overlap = 0;  ///< the largest; m for the last two
};

/// Its arrays are written while the lock of the interpreter is held. They keep their size, and live as long as somebody has them.
class PythonMachine {
 public:
  using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

  PythonMachine(const std::string& path, const pybind11::dict& keywords);

  /// The start of the file and its keywords, at time 0.
  void reset();
  /// Without the lock of the interpreter; Ctrl-C ends it between two steps.
  Steps step(long count);
  /// As `set_joint_state`; the arrays follow.
  void set_state(const Numbers& q, const Numbers& v);
  Numbers gravity_compensation();

  std::vector<std::string> links, joints, actuators;  ///< joints that move, and free roots without one
  pybind11::dict q_index, v_index;  ///< where the numbers of one of `joints` begin
  std::vector<std::string> notes;   ///< what was not read or is not done, and what the user should know of the start
  Numbers q, v;                    ///< see `JointSpace`
  Numbers positions, orientations, velocities, angular_velocities;  ///< of the frames of links, world: n × 3, n × 4 (w x y z)
  Numbers controls, forces;        ///< Python writes them: of the actuators; τ of the joints, to v
  Numbers contact_points, contact_normals, contact_forces, contact_gaps;  ///< of the last step, new ones each time
  pybind11::array_t<int> contact_links;  ///< n × 2; −1, which stands first: the world
  double time = 0, dt;             ///< s; `dt` is what `step` goes on by

 private:
  class Turn;
  struct Freedom {
    model::JointKind kind;
    Index link, joint;  ///< −1: no joint
    Index q, v;         ///< where its numbers begin
  };

  void run(long most, Steps& steps);
  void push();
  void write_arrays();

  Model model_;
  Options options_;
  std::unique_ptr<Start> start_;
  std::unique_ptr<Motion> motion_;
  std::unique_ptr<JointReader> reader_;
  std::vector<Freedom> freedoms_;
  std::vector<double> q_, v_, tau_;
  bool is_busy_ = false;  ///< read and written with the lock
};

}  // namespace delassus_run
