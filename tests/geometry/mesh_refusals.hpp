/// What `check_mesh` says of a mesh.
#pragma once

#include <delassus/core/expect.hpp>

#include <string>

/// The sentence by which a mesh is refused; empty where it is taken.
template <class Mesh>
std::string refusal(const Mesh& mesh) {
  try {
    check_mesh(mesh, "soft body #0");
  } catch (const delassus::InvalidArgument& e) {
    return e.what();
  }
  return {};
}

inline bool says(const std::string& sentence, const char* words) {
  return sentence.find(words) != std::string::npos;
}
