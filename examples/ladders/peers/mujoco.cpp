// MuJoCo, through its XML.
#include "engine.hpp"
#include "tree.hpp"

#include <mujoco/mujoco.h>

#include <unistd.h>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <sstream>

namespace ladders::peers {

namespace {

/// Writes a scene as MJCF: trees of bodies in joint coordinates, equality constraints where joints close
/// loops.
class Writer {
 public:
  Writer(const Scene& scene, double h, bool is_stiff)
      : scene_(scene), tree_(scene), h_(h), is_stiff_(is_stiff) {
    out_.precision(17);
  }

  std::string text() {
    // Its matrices of rows are dense: room for what bodies that lie on each other have, no more.
    const std::size_t n = scene_.bodies.size(), contacts = scene_.touches ? contacts_of_a_body() * n + 50 : 0;
    out_ << "<mujoco><compiler autolimits='false' angle='radian'/><size nconmax='" << contacts << "' njmax='"
         << 4 * contacts + 6 * tree_.closures.size() + 20 << "'/><option timestep='" << h_ << "' gravity='"
         << scene_.gravity << "'"
         << (is_stiff_ ? " cone='elliptic'><flag multiccd='enable'/></option>" : "/>") << "<asset>";
    for (std::size_t b = 0; b < n; ++b)
      if (scene_.bodies[b].geometry.form == Form::convex) {
        out_ << "<mesh name='m" << b << "' vertex='";
        for (const Triple& x : scene_.bodies[b].geometry.corners) out_ << x << " ";
        out_ << "'/>";
      }
    out_ << "</asset><worldbody>";
    for (std::size_t b = 0; b < n; ++b)
      if (scene_.bodies[b].is_fixed) add_geom(int(b));
    for (const int b : tree_.order)
      if (tree_.parent[std::size_t(b)] < 0) add_body(b);
    out_ << "</worldbody><equality>";
    for (const int k : tree_.closures) add_closure(scene_.joints[std::size_t(k)]);
    out_ << "</equality></mujoco>";
    return out_.str();
  }
  const Tree& tree() const { return tree_; }

 private:
  struct Words {
    std::ostringstream stream;
    void precision(int digits) { stream.precision(digits); }
    std::string str() const { return stream.str(); }
    template <class T>
    Words& operator<<(const T& x) {
      stream << x;
      return *this;
    }
    template <std::size_t n>
    Words& operator<<(const std::array<double, n>& x) {
      for (std::size_t k = 0; k < n; ++k) stream << (k ? " " : "") << x[k];
      return *this;
    }
  };

  std::size_t contacts_of_a_body() const {
    for (const Body& body : scene_.bodies)
      if (body.geometry.form != Form::sphere && body.geometry.form != Form::half_space) return 12;
    return 6;
  }

  void add_geom(int b) {
    const Body& body = scene_.bodies[std::size_t(b)];
    if (!scene_.touches || body.geometry.form == Form::none) return;
    const auto& s = body.geometry.size;
    switch (body.geometry.form) {
      case Form::none:
        return;
      case Form::half_space: {
        const Plane plane = plane_of(body);
        out_ << "<geom type='plane' size='0 0 1' pos='" << plane.offset * plane.normal << "' zaxis='"
             << plane.normal << "'";
        break;
      }
      case Form::box:
        out_ << "<geom type='box' size='" << Triple{s[0], s[1], s[2]} << "'";
        break;
      case Form::sphere:
        out_ << "<geom type='sphere' size='" << s[0] << "'";
        break;
      case Form::capsule:
        out_ << "<geom type='capsule' size='" << s[0] << " " << s[1] << "'";
        break;
      case Form::cylinder:
        out_ << "<geom type='cylinder' size='" << s[0] << " " << s[1] << "'";
        break;
      case Form::convex:
        out_ << "<geom type='mesh' mesh='m" << b << "'";
        break;
    }
    if (body.is_fixed && body.geometry.form != Form::half_space)
      out_ << " pos='" << body.start.position << "' quat='" << body.start.turn << "'";
    if (scene_.friction > 0)
      out_ << " friction='" << scene_.friction << " 0.005 0.0001'";
    else
      out_ << " condim='1'";
    // The documentation's least time constant is two steps.
    if (is_stiff_) out_ << " solref='" << 2 * h_ << " 1' solimp='0.99 0.9999 0.001 0.5 2'";
    out_ << "/>";
  }

  void add_body(int b) {
    const Body& body = scene_.bodies[std::size_t(b)];
    State at = body.start;
    if (const int parent = tree_.parent[std::size_t(b)]; parent >= 0) {
      const State& p = scene_.bodies[std::size_t(parent)].start;
      at.position = turned(inverse(p.turn), at.position - p.position);
      at.turn = times(inverse(p.turn), at.turn);
    }
    out_ << "<body name='b" << b << "' pos='" << at.position << "' quat='" << at.turn << "'>"
         << "<inertial pos='0 0 0' mass='" << body.mass << "' diaginertia='" << body.moments << "'/>";
    if (const int k = tree_.joint[std::size_t(b)]; k < 0) {
      out_ << "<freejoint/>";
    } else {
      const Joint& joint = scene_.joints[std::size_t(k)];
      const bool is_b = joint.b == b;
      const Triple point = is_b ? joint.on_b : joint.on_a,
                   axis = z_axis(is_b ? joint.frame_b : joint.frame_a);
      if (joint.hold == Hold::ball) out_ << "<joint type='ball' pos='" << point << "'/>";
      if (joint.hold == Hold::hinge)
        out_ << "<joint type='hinge' pos='" << point << "' axis='" << axis << "'/>";
      if (joint.hold == Hold::slider)
        out_ << "<joint type='slide' pos='" << point << "' axis='" << axis << "'/>";
    }
    add_geom(b);
    for (const int child : tree_.children[std::size_t(b)]) add_body(child);
    out_ << "</body>";
  }

  /// A hinge is two points that are held; what is fixed is the world.
  void add_closure(const Joint& joint) {
    const auto is_still = [&](int b) { return b < 0 || scene_.bodies[std::size_t(b)].is_fixed; };
    const bool is_b = is_still(joint.a);
    const int one = is_b ? joint.b : joint.a, other = is_b ? joint.a : joint.b;
    const Triple point = is_b ? joint.on_b : joint.on_a, axis = z_axis(is_b ? joint.frame_b : joint.frame_a);
    const std::string bodies =
        numbered(" body1='b", one) + "'" + (is_still(other) ? "" : numbered(" body2='b", other) + "'");
    if (joint.hold == Hold::ball) out_ << "<connect" << bodies << " anchor='" << point << "'/>";
    if (joint.hold == Hold::hinge)
      for (const double side : {-0.5, 0.5})
        out_ << "<connect" << bodies << " anchor='" << point + side * axis << "'/>";
    if (joint.hold == Hold::weld) out_ << "<weld" << bodies << "/>";
    if (joint.hold == Hold::slider) throw Unsayable("a slider that closes a loop was not tried");
  }

  const Scene& scene_;
  Tree tree_;
  double h_;
  bool is_stiff_;
  Words out_;
};

/// Left as they are: Newton's method, Euler's integrator, pyramidal cone, solref 0.02 s, solimp. `is_stiff`:
/// elliptic cone, solref of two steps and a solimp near 1, as its documentation advises for hard contacts.
class MuJoCo : public Engine {
 public:
  MuJoCo(const Scene& scene, double h, bool is_stiff) : scene_(scene), ids_(scene.bodies.size(), -1) {
    if (scene.restitution > 0) throw Unsayable("it has no coefficient of restitution");
    expect_together(scene);
    mju_user_error = [](const char* what) {
      std::fprintf(stderr, "MuJoCo: %s\n", what);
      _exit(3);
    };
    mju_user_warning = [](const char* what) { std::fprintf(stderr, "MuJoCo warns: %s\n", what); };
    Writer writer(scene_, h, is_stiff);
    load(writer.text());
    mj_resetData(model_, data_);
    for (std::size_t b = 0; b < ids_.size(); ++b)
      if (!scene_.bodies[b].is_fixed) start(int(b), writer.tree(), h);
  }
  ~MuJoCo() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void push(int body, const Triple& force, const Triple& torque) override {
    mjtNum* to = data_->xfrc_applied + 6 * ids_[std::size_t(body)];
    for (int k = 0; k < 3; ++k) to[k] += force[std::size_t(k)], to[3 + k] += torque[std::size_t(k)];
  }
  void step(double) override {
    mj_step(model_, data_);
    mju_zero(data_->xfrc_applied, 6 * model_->nbody);
    is_fresh_ = false;
  }
  State state(int body) const override {
    if (!is_fresh_) mj_kinematics(model_, data_), mj_comPos(model_, data_), mj_comVel(model_, data_);
    is_fresh_ = true;
    const int id = ids_[std::size_t(body)];
    const mjtNum *x = data_->xpos + 3 * id, *q = data_->xquat + 4 * id;
    mjtNum v[6];
    mj_objectVelocity(model_, data_, mjOBJ_BODY, id, v, 0);
    return {{x[0], x[1], x[2]}, {q[0], q[1], q[2], q[3]}, {v[3], v[4], v[5]}, {v[0], v[1], v[2]}};
  }

 private:
  void load(const std::string& text) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    const char* name = "scene.xml";
    mj_makeEmptyFileVFS(files.get(), name, int(text.size()) + 1);
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), name)], text.c_str(), text.size() + 1);
    char why[500] = "";
    model_ = mj_loadXML(name, files.get(), why, sizeof why);
    mj_deleteVFS(files.get());
    if (!model_) {
      std::string sentence(why);
      std::replace(sentence.begin(), sentence.end(), '\n', ' ');
      throw Unsayable("its compiler refuses it: " + sentence);
    }
    data_ = mj_makeData(model_);
    if (!data_) {
      mj_deleteModel(model_);
      throw std::runtime_error("it cannot allocate its data");
    }
  }

  /// A free body has its velocity; one of a tree is given it by an impulse in the first step, as its joints
  /// let it.
  void start(int b, const Tree& tree, double h) {
    const Body& body = scene_.bodies[std::size_t(b)];
    const int id = ids_[std::size_t(b)] = mj_name2id(model_, mjOBJ_BODY, numbered("b", b).c_str());
    if (!tree.is_free(b)) {
      const auto [p, l] = starting_impulse(body);
      if (dot(p, p) + dot(l, l) > 0) push(b, 1 / h * p, 1 / h * l);
      return;
    }
    const Triple w = turned(inverse(body.start.turn), body.start.spin);
    mjtNum* v = data_->qvel + model_->jnt_dofadr[model_->body_jntadr[id]];
    for (int k = 0; k < 3; ++k) v[k] = body.start.velocity[std::size_t(k)], v[3 + k] = w[std::size_t(k)];
  }

  Scene scene_;
  std::vector<int> ids_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  mutable bool is_fresh_ = false;
};

template <bool is_stiff>
std::unique_ptr<Engine> make(const Scene& scene, double h) {
  return std::make_unique<MuJoCo>(scene, h, is_stiff);
}

}  // namespace

std::span<const EngineKind> mujoco_kinds() {
  static const std::string version = std::string("MuJoCo ") + mj_versionString(), stiff = version + " stiff";
  static const EngineKind kinds[] = {
      {"mujoco", version.c_str(), "room for contacts", &make<false>},
      {"mujoco-stiff", stiff.c_str(), "elliptic cone, solref 2h, solimp 0.99 0.9999 0.001, multiccd",
       &make<true>}};
  return kinds;
}

}  // namespace ladders::peers
