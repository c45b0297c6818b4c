#include "same_model.hpp"

namespace delassus {
namespace {

/// Half sizes as MuJoCo has them.
struct SizeOf {
  Vec3 operator()(const Sphere& s) const { return {s.radius, 0, 0}; }
  Vec3 operator()(const Box& b) const { return Vec3(0.5 * Vec3(b.x, b.y, b.z)); }
  Vec3 operator()(const Capsule& c) const { return {c.radius, c.height / 2, 0}; }
  Vec3 operator()(const Cylinder& c) const { return {c.radius, c.height / 2, 0}; }
  Vec3 operator()(const Ellipsoid& e) const { return {e.a, e.b, e.c}; }
  Vec3 operator()(const model::Plane&) const { return zero<Vec3>(); }
  Vec3 operator()(const model::HullOf&) const { return zero<Vec3>(); }
  Vec3 operator()(const model::TrianglesOf&) const { return zero<Vec3>(); }
  Vec3 operator()(const model::FieldOf&) const { return zero<Vec3>(); }
};

/// Which of `GeometryShape` MuJoCo's type is, and how many sizes it has.
constexpr int alternatives[] = {5, 8, 0, 2, 4, 3, 1, 6}, counts[] = {0, 0, 1, 2, 3, 2, 3, 0};

}  // namespace

void check_geoms(const Model& model, const mjModel& m) {
  REQUIRE(Index(model.geometries.size()) == m.ngeom);
  for (int i = 0; i < m.ngeom; ++i) {
    const model::Geometry& g = model.geometries[std::size_t(i)];
    const int type = m.geom_type[i];
    CAPTURE(g.name, i);
    CHECK(g.name == name_of(m, mjOBJ_GEOM, i));
    CHECK(g.body == m.geom_bodyid[i] - 1);
    REQUIRE(int(g.shape.index()) == alternatives[type]);
    const Vec3 size = std::visit(SizeOf{}, g.shape);
    for (int k = 0; k < counts[type]; ++k) check_same(size[k], m.geom_size[3 * i + k]);
    if (type != mjGEOM_MESH) check_same(g.pose, m.geom_pos, m.geom_quat, i);
    CHECK(g.contact_freedoms == m.geom_condim[i]);
    check_same(g.friction, m.geom_friction[3 * i]);
    check_same(g.spinning_friction, m.geom_friction[3 * i + 1]);
    check_same(g.rolling_friction, m.geom_friction[3 * i + 2]);
    CHECK(int(g.type) == m.geom_contype[i]);
    CHECK(int(g.affinity) == m.geom_conaffinity[i]);
    CHECK(g.priority == m.geom_priority[i]);
  }
  REQUIRE(Index(model.sites.size()) == m.nsite);
  for (int i = 0; i < m.nsite; ++i) {
    const model::Site& site = model.sites[std::size_t(i)];
    CAPTURE(site.name, i);
    CHECK(site.name == name_of(m, mjOBJ_SITE, i));
    CHECK(site.body == m.site_bodyid[i] - 1);
    check_same(site.pose, m.site_pos, m.site_quat, i);
  }
}

}  // namespace delassus
