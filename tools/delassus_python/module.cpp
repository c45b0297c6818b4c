// The names of the Python module delassus.
#include "../delassus_run/read.hpp"
#include "machine.hpp"

#include <pybind11/stl.h>

namespace py = pybind11;
using namespace delassus_run;

PYBIND11_MODULE(delassus, module) {
  module.doc() = "Simulates robots of URDF and MJCF files.";

  py::class_<Steps>(module, "Steps", "What a call of step() did.")
      .def_readonly("count", &Steps::count)
      .def_readonly("unconverged", &Steps::unconverged, "steps whose solve did not reach the tolerance")
      .def_readonly("residual", &Steps::residual, "largest of the solves")
      .def_readonly("joint_gap", &Steps::joint_gap, "largest, m or rad")
      .def_readonly("overlap", &Steps::overlap, "largest of contacts, m")
      .def("__repr__", [](const Steps& s) {
        return py::str("<{} steps, {} not converged, residual {:.2g}, gaps {:.2g} m, overlaps {:.2g} m>").format(s.count, s.unconverged, s.residual, s.joint_gap, s.overlap);
      });

  using M = PythonMachine;
  py::class_<M>(module, "Machine", "A robot in a loop of its own.\n\n"
                                   "Machine(path, **options): the options of delassus_run as keywords, such as dt=1e-3, accuracy=1e-3, base=\"fixed\",\n"
                                   "ground=True, height=0.1, at={\"knee\": 0.3}, hold=[200, 5], key=\"home\". What is wrong with them or with the file is a ValueError.\n"
                                   "Arrays are NumPy's. Those of joints and links change in place with each step; those of contacts are new.")
      .def(py::init([](const py::object& path, const py::kwargs& options) {
        try {
          return std::make_unique<M>(py::str(path), options);
        } catch (const py::error_already_set&) {
          throw;
        } catch (const std::exception& error) {
          throw py::value_error(in_words_of_options(error.what()));
        }
      }), py::arg("path"))
      .def("__repr__", [](const M& m) { return py::str("<delassus.Machine: {} links, {} joints, at {:.6g} s>").format(m.links.size(), m.joints.size(), m.time); })
      .def("step", &M::step, py::arg("count") = 1, "Goes on by count steps of dt. Other threads of Python run meanwhile.")
      .def("reset", &M::reset, "Back to the start, at time 0; forces are 0.")
      .def("set_state", &M::set_state, py::arg("q"), py::arg("v"), "Places the joints; time goes on.")
      .def("gravity_compensation", &M::gravity_compensation, "Forces that hold the machine at rest where it is, in the layout of v.")
      .def_readonly("links", &M::links).def_readonly("joints", &M::joints)
      .def_readonly("actuators", &M::actuators)
      .def_readonly("q_index", &M::q_index, "where in q the numbers of one of the joints begin")
      .def_readonly("v_index", &M::v_index, "likewise in v and forces")
      .def_readonly("notes", &M::notes, "what was not read, is not done, or is odd")
      .def_readonly("time", &M::time, "s")
      .def_readonly("dt", &M::dt, "s, of a step")
      .def_readonly("q", &M::q, "of the joints in their order: hinge: rad, slide: m, ball: quaternion w x y z, free: position and quaternion")
      .def_readonly("v", &M::v, "their rates; free: velocity in the world's axes, angular velocity in the body's")
      .def_readonly("positions", &M::positions, "of the links, world, m")
      .def_readonly("orientations", &M::orientations, "w x y z")
      .def_readonly("velocities", &M::velocities, "of the origins of the links, world, m/s")
      .def_readonly("angular_velocities", &M::angular_velocities, "world, rad/s")
      .def_property("controls", [](M& m) { return m.controls; }, [](M& m, const py::object& x) { m.controls.attr("__setitem__")(py::ellipsis(), x); }, "of the actuators; write into it")
      .def_property("forces", [](M& m) { return m.forces; }, [](M& m, const py::object& x) { m.forces.attr("__setitem__")(py::ellipsis(), x); }, "of the joints, in the layout of v, N·m or N; write into it, it holds until changed")
      .def_readonly("contact_points", &M::contact_points, "of the last step, world, m")
      .def_readonly("contact_normals", &M::contact_normals, "from the first link to the second")
      .def_readonly("contact_forces", &M::contact_forces, "on the second link, world, N: impulse of the step over its time")
      .def_readonly("contact_gaps", &M::contact_gaps, "m; negative where they overlap")
      .def_readonly("contact_links", &M::contact_links, "numbers of the two links; -1, which stands first: the world. Links that no joint parts have the number of the first");
}
