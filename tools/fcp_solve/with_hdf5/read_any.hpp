/// A problem as text or in FCLIB's form, told by the file's name.
#pragma once

#include <delassus/adapters/hdf5.hpp>
#include <delassus/io/problem_file.hpp>

#include <string>

inline bool is_fclib(const std::string& path) { return path.ends_with(".hdf5") || path.ends_with(".h5"); }

/// FCLIB's first guess, where there is one, is the λ it starts from.
inline delassus::FrictionProblem read_any(const std::string& path) {
  return is_fclib(path) ? delassus::read_fclib(path) : delassus::read_problem(path);
}

inline void write_any(const std::string& path, const delassus::FrictionProblem& p) {
  is_fclib(path) ? delassus::write_fclib(path, p) : delassus::write_problem(path, p);
}
