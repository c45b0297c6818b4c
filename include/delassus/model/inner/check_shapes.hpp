/// Whether the shapes of a description can be built, and who collides with whom can be looked up.
#pragma once

#include <delassus/model/inner/check_numbers.hpp>

namespace delassus::inner {

/// Its numbers, and the lists that it names.
struct ShapeCheck {
  const Model& model;
  const ModelElement& who;

  void operator()(const Sphere& s) const { who.expect_positive(s.radius, "its radius"); }
  void operator()(const Box& b) const {
    for (const double edge : {b.x, b.y, b.z}) who.expect_positive(edge, "an edge");
  }
  void operator()(const Capsule& c) const { round(c.radius, c.height); }
  void operator()(const Cylinder& c) const { round(c.radius, c.height); }
  void operator()(const Ellipsoid& e) const {
    for (const double axis : {e.a, e.b, e.c}) who.expect_positive(axis, "a semi-axis");
  }
  void operator()(const model::Plane&) const {}
  void operator()(const model::HullOf& h) const {
    who.expect_index(h.mesh, model.meshes.size(), "the index of its mesh");
    who.expect(model.meshes[std::size_t(h.mesh)].vertices.size() >= 4,
               "the mesh of a hull needs four vertices");
  }
  void operator()(const model::TrianglesOf& t) const {
    who.expect_index(t.mesh, model.meshes.size(), "the index of its mesh");
    who.expect(!model.meshes[std::size_t(t.mesh)].triangles.empty(), "its mesh has no triangle");
  }
  void operator()(const model::FieldOf& f) const {
    who.expect_index(f.field, model.height_fields.size(), "the index of its height field");
  }

 private:
  void round(double radius, double height) const {
    who.expect_positive(radius, "its radius");
    who.expect_positive(height, "its height");
  }
};

inline void check_friction(const auto& with, const ModelElement& who) {
  const int d = with.contact_freedoms;
  who.expect(d == 1 || d == 3 || d == 4 || d == 6, "its contact freedoms must be 1, 3, 4 or 6");
  who.expect_at_least_zero(with.friction, "friction");
  who.expect_at_least_zero(with.spinning_friction, "spinning friction");
  who.expect_at_least_zero(with.rolling_friction, "rolling friction");
}

inline void check_geometries(const Model& model) {
  check_each(model, "geometry", model.geometries, [&](const model::Geometry& g, const ModelElement& who) {
    who.expect_index(g.body, model.bodies.size(), "the index of its body", -1);
    who.expect_pose(g.pose);
    std::visit(ShapeCheck{model, who}, g.shape);
    check_friction(g, who);
    who.expect(g.restitution >= 0 && g.restitution <= 1, "its restitution must be in [0, 1]");
    who.expect_sane(g.surface_velocity, "the velocity of its surface");
    who.expect_sane(g.surface_spin, "the spin of its surface");
  });
  const auto two = [&](const auto& pair, Index a, Index b, const ModelElement& who, std::size_t count,
                       const char* what) {
    who.expect_index(a, count, what);
    who.expect_index(b, count, what);
    who.expect(a != b, "it names one thing twice");
    if constexpr (requires { pair.friction; }) check_friction(pair, who);
  };
  check_each(model, "pair", model.pairs, [&](const model::Pair& p, const ModelElement& who) {
    two(p, p.geometry, p.other, who, model.geometries.size(), "the index of a geometry");
  });
  check_each(model, "exclude", model.excludes, [&](const model::Exclude& e, const ModelElement& who) {
    who.expect_index(e.body, model.bodies.size(), "the index of a body", -1);
    who.expect_index(e.other, model.bodies.size(), "the index of a body", -1);
    who.expect(e.body != e.other, "it names one thing twice");
  });
}

inline void check_surfaces(const Model& model) {
  check_each(model, "mesh", model.meshes, [](const model::Mesh& mesh, const ModelElement& who) {
    for (const Vec3& v : mesh.vertices) who.expect_sane(v, "a vertex");
    for (const auto& t : mesh.triangles)
      for (const Index v : t) who.expect_index(v, mesh.vertices.size(), "the corner of a triangle");
  });
  check_each(model, "height field", model.height_fields,
             [](const model::HeightField& field, const ModelElement& who) {
               who.expect(field.rows >= 2 && field.columns >= 2,
                          "it needs two rows and two columns at least");
               who.expect(std::size_t(field.rows) * std::size_t(field.columns) == field.heights.size(),
                          "it must have rows times columns heights");
               who.expect_positive(field.half_x, "its half length along x");
               who.expect_positive(field.half_y, "its half length along y");
               who.expect_at_least_zero(field.base, "its base");
               for (const double h : field.heights) who.expect_sane(h, "a height");
             });
}

}  // namespace delassus::inner
