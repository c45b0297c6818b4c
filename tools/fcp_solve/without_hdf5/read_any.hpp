/// A problem as text; FCLIB's form needs the component hdf5.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/io/problem_file.hpp>

#include <string>

inline void expect_text(const std::string& path) {
  DELASSUS_EXPECT(!path.ends_with(".hdf5") && !path.ends_with(".h5"),
                  path + ": this fcp_solve was built without HDF5 (apt-get install libhdf5-dev, then build it again)");
}

inline delassus::FrictionProblem read_any(const std::string& path) {
  expect_text(path);
  return delassus::read_problem(path);
}

inline void write_any(const std::string& path, const delassus::FrictionProblem& p) {
  expect_text(path);
  delassus::write_problem(path, p);
}
