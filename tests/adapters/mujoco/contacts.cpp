// Contacts of random scenes beside MuJoCo: which shapes meet, and with what friction.
#include "adapters/mujoco/same_model.hpp"
#include "model/used_contacts.hpp"
#include "scratch_path.hpp"

#include <delassus/adapters/mjcf.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/model/add.hpp>

#include <fstream>
#include <map>
#include <random>
#include <string>
#include <utility>

namespace mujoco_contacts_tests {

using namespace delassus;

namespace {

using Pairs = std::map<std::pair<std::string, std::string>, UsedContact>;

std::pair<std::string, std::string> names(std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  return {a, b};
}

/// Balls of the world and free ones, crowded, each with types, affinities, friction, freedoms and a priority
/// of its own; two bodies are excluded.
std::string crowd(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  const auto number = [&](double size) {
    return std::to_string(std::uniform_real_distribution<double>(-size, size)(random));
  };
  std::string text = "<mujoco><option gravity=\"0 0 0\"/><worldbody>";
  const auto geom = [&](int k) {
    const int dims[] = {1, 3};
    return "<geom name=\"g" + std::to_string(k) + "\" size=\".5\" contype=\"" + std::to_string(below(4)) +
           "\" conaffinity=\"" + std::to_string(below(4)) + "\" condim=\"" + std::to_string(dims[below(2)]) +
           "\" priority=\"" + std::to_string(below(3)) + "\" friction=\"0." + std::to_string(1 + below(9)) +
           "\" ";
  };
  const auto place = [&] { return "pos=\"" + number(1) + " " + number(1) + " " + number(1) + "\""; };
  for (int k = 0; k < 4; ++k) text += geom(k) + place() + "/>";
  for (int k = 4; k < 12; ++k)
    text += "<body name=\"b" + std::to_string(k) + "\" " + place() + "><freejoint/>" + geom(k) + "/></body>";
  return text + "</worldbody><contact><exclude body1=\"b4\" body2=\"b5\"/></contact></mujoco>";
}

Pairs by_mujoco(const mjModel& m) {
  Pairs out;
  mjData* d = mj_makeData(&m);
  mj_forward(&m, d);
  for (int i = 0; i < d->ncon; ++i) {
    const mjContact& c = d->contact[i];
    const auto pair = names(name_of(m, mjOBJ_GEOM, c.geom1), name_of(m, mjOBJ_GEOM, c.geom2));
    if (const auto at = out.find(pair); at == out.end() || c.dist < at->second.gap)
      out[pair] = {c.dim == 1 ? 0 : c.friction[0], c.dist};
  }
  mj_deleteData(d);
  return out;
}

/// By the names of the only shape of each body.
Pairs by_ours(const Model& model) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.01}}},
                     WithFilter{WithMeshes{NativeCollision{}}}};
  add(loop, model, {}, Base::as_file, {.surfaces = false});
  bodies<RigidBodies>(loop.world()).gravity = zero<Vec3>();
  stage::begin(loop.data(), 1e-6);
  stage::detect(loop.data());
  // The world's shapes come first, then the bodies, as in the file; those that meet nothing are not there.
  std::vector<std::string> name;
  for (const bool of_world : {true, false})
    for (const model::Geometry& g : model.geometries)
      if ((g.body < 0) == of_world && (!of_world || g.type + g.affinity != 0)) name.push_back(g.name);
  Pairs out;
  for (const auto& [pair, contact] : used_contacts(loop))
    if (contact.gap <= 0) out[names(name[std::size_t(pair.first)], name[std::size_t(pair.second)])] = contact;
  return out;
}

int compare(const std::string& text) {
  const std::string path = scratch_path("contacts.xml");
  std::ofstream(path) << text;
  const MujocoModel m = load_in_mujoco(path);
  const Pairs want = by_mujoco(*m), have = by_ours(read_mjcf(path));
  CHECK(have.size() == want.size());
  for (const auto& [pair, contact] : want) {
    CAPTURE(pair.first, pair.second);
    REQUIRE(have.contains(pair));
    CHECK(have.at(pair).friction == Approx(contact.friction));
    CHECK(have.at(pair).gap == Approx(contact.gap).margin(1e-9));
  }
  return int(want.size());
}

}  // namespace

TEST_CASE("shapes of MJCF files meet as in MuJoCo, and with its friction") {
  int met = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    met += compare(crowd(seed));
  }
  CHECK(met > 200);
}

}  // namespace mujoco_contacts_tests
