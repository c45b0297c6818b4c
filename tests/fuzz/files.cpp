// Every reader of text: it returns what is sound, or refuses it with a sentence, whatever it is given. The
// first byte chooses the reader.
#include "bytes.hpp"

#include <delassus/io/mesh_file.hpp>
#include <delassus/io/obj.hpp>
#include <delassus/io/problem_file.hpp>
#include <delassus/io/stl.hpp>

#include <algorithm>
#include <string>
#include <string_view>

using namespace delassus;
using fuzz::expect;

namespace {

void check_places(const auto& points) {
  for (const Vec3& x : points) expect(is_finite(x), "a point that was read is not finite");
}

void read_tetrahedra(std::string_view text, auto parse) {
  const TetrahedralMesh mesh = parse(text, "input");
  check_places(mesh.points);
  expect(!mesh.tetrahedra.empty(), "a mesh without tetrahedra was read");
  for (const auto& t : mesh.tetrahedra)
    for (const Index i : t)
      expect(i >= 0 && i < Index(mesh.points.size()), "a corner is not among the points");
}

void read_triangles(std::string_view text) {
  const TriangleMesh mesh = parse_obj(text, "input");
  check_places(mesh.vertices());
  expect(mesh.triangle_count() > 0, "a mesh without triangles was read");
  for (Index t = 0; t < mesh.triangle_count(); ++t)
    expect(is_finite(mesh.triangle(t).normal), "the normal of a triangle that was read is not finite");
}

void read_triangle_list(std::string_view bytes) {
  const TriangleList list = parse_stl(bytes, "input");
  check_places(list.vertices);
  expect(!list.triangles.empty(), "a list without triangles was read");
  for (const auto& t : list.triangles)
    for (const Index i : t)
      expect(i >= 0 && i < Index(list.vertices.size()), "a corner is not among the vertices");
}

/// What was read and is written reads as the same to the bit.
void read_friction_problem(std::string_view text) {
  const std::string once = problem_text(parse_problem(text, "input"));
  expect(problem_text(parse_problem(once, "its text")) == once,
         "a problem changes when it is written and read");
}

void read_lambda(std::string_view text) {
  const Index contacts = text.empty() ? 0 : Index(std::uint8_t(text[0]));
  const auto lambda = parse_impulses(text.substr(std::min<std::size_t>(1, text.size())), "input", contacts);
  check_places(lambda);
  expect(Index(lambda.size()) == contacts, "not as many impulses as were asked for");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    switch (data[0] >= 240 ? 5 : data[0] % 5) {
      case 0:
        read_triangles(text);
        break;
      case 1:
        read_tetrahedra(text, parse_gmsh);
        break;
      case 2:
        read_tetrahedra(text, parse_vtk);
        break;
      case 3:
        read_friction_problem(text);
        break;
      case 4:
        read_lambda(text);
        break;
      case 5:
        read_triangle_list(text);
        break;
    }
  } catch (const InvalidArgument& refused) {
    expect(std::string(refused.what()).size() > 10, "a refusal says nothing");
  }
  return 0;
}
