// Masses and counts as MuJoCo 3.3.8 has them: models that 2.2.2 does not read, shells, meshes, fitted shapes.
#include <delassus/adapters/mjcf.hpp>

#include "catch.hpp"
#include "mjcf_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace mjcf_later_mujoco_tests {

using namespace delassus;

namespace {

struct Row {
  std::string kind;
  std::vector<double> numbers;
};

/// The rows under each line "model …" or "text …".
std::map<std::string, std::vector<Row>> read_table() {
  std::map<std::string, std::vector<Row>> table;
  std::string what;
  for (const char* piece : mujoco_table) {
    std::istringstream lines(piece);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("model ") || line.starts_with("text ")) {
        what = line;
        continue;
      }
      std::istringstream words(line);
      Row row;
      words >> row.kind;
      for (double x; words >> x;) row.numbers.push_back(x);
      table[what].push_back(row);
    }
  }
  return table;
}

/// Equal to `relative` of `size`.
void check_close(double a, double b, double size, double relative) {
  CAPTURE(a, b);
  CHECK(std::abs(a - b) <= relative * std::max(size, std::abs(b)));
}

void check_body(const model::Body& body, const std::vector<double>& x, double relative) {
  CHECK(body.parent == Index(x[0]));
  check_close(body.mass, x[1], 0, relative);
  if (body.mass == 0) return;
  for (int k = 0; k < 3; ++k)
    check_close(body.centre[k], x[2 + std::size_t(k)], norm(body.centre) + 1e-3, relative);
  const double moment = std::max(std::max(x[5], x[6]), x[7]);
  constexpr int places[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (std::size_t k = 0; k < 6; ++k)
    check_close(body.inertia(places[k][0], places[k][1]), x[5 + k], moment, relative);
}

/// The half sizes of a shape that was fitted.
struct SizeOf {
  std::vector<double> operator()(const Sphere& s) const { return {s.radius}; }
  std::vector<double> operator()(const Box& b) const { return {b.x / 2, b.y / 2, b.z / 2}; }
  std::vector<double> operator()(const Capsule& c) const { return {c.radius, c.height / 2}; }
  std::vector<double> operator()(const Cylinder& c) const { return {c.radius, c.height / 2}; }
  std::vector<double> operator()(const Ellipsoid& e) const { return {e.a, e.b, e.c}; }
  std::vector<double> operator()(const auto&) const { return {}; }
};

void check_rows(const Model& m, const std::vector<Row>& rows, double relative) {
  std::size_t body = 0, geometry = 0;
  for (const Row& row : rows) {
    const std::vector<double>& x = row.numbers;
    CAPTURE(row.kind, body, geometry);
    if (row.kind == "counts") {
      std::vector<double> counts{double(m.bodies.size()),
                                 0,
                                 0,
                                 0,
                                 0,
                                 double(m.geometries.size()),
                                 double(m.sites.size()),
                                 double(m.tendons.size()),
                                 double(m.actuators.size())};
      using enum model::JointKind;
      for (const model::Joint& j : m.joints)
        counts[j.kind == free ? 1 : j.kind == ball ? 2 : j.kind == slide ? 3 : 4] += 1;
      REQUIRE(counts == x);
    } else if (row.kind == "body") {
      check_body(m.bodies[body++], x, relative);
    } else {
      const std::vector<double> size = std::visit(SizeOf{}, m.geometries[geometry++].shape);
      for (std::size_t k = 0; k < size.size(); ++k) check_close(size[k], x[k], 0, relative);
    }
  }
}

}  // namespace

TEST_CASE("small texts weigh what they do in MuJoCo 3.3.8") {
  std::size_t count = 0;
  for (const auto& [what, rows] : read_table()) {
    if (!what.starts_with("text ")) continue;
    CAPTURE(what);
    // It makes built-in meshes in single precision.
    const bool is_single = what.find("builtin") != std::string::npos;
    check_rows(parse_mjcf(what.substr(5), "text.xml"), rows, is_single ? 1e-6 : 1e-9);
    ++count;
  }
  CHECK(count > 30);
}

TEST_CASE("car, dominos and treadmill weigh what they do in MuJoCo 3.3.8") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS is not set: no models of other projects are read");
    return;
  }
  std::size_t count = 0;
  for (const auto& [what, rows] : read_table()) {
    if (!what.starts_with("model ")) continue;
    CAPTURE(what);
    check_rows(read_mjcf(std::string(folder) + "/mjcf/" + what.substr(6) + ".xml",
                         {.files = {std::string(folder) + "/mjcf/mujoco"}}),
               rows, 1e-9);
    ++count;
  }
  CHECK(count == 3);
}

}  // namespace mjcf_later_mujoco_tests
