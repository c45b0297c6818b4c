/// Scenes out of bytes: bodies, joints, forces, removals and steps in any order, and what must hold after
/// every step.
#pragma once

#include "shapes.hpp"
#include "step_times.hpp"

#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/rows/anchor.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fuzz {

/// Whatever a scene is told, it takes or refuses with a sentence, and NaN it refuses; a step takes what is
/// there, leaves no number that is not finite in a body, a contact or an impulse, and puts no body aside as
/// long as no odd number was given. A fifth of the scenes is given odd numbers now and then, a fifth always
/// three of ten. `AddJoint` is called with (loop, bytes, a, b) and adds one constraint, or refuses.
template <class Loop, class AddJoint>
class Scene {
 public:
  using Set = RigidBodies;
  using Handle = Set::Handle;

  Scene(Loop loop, AddJoint add_joint, const std::uint8_t* data, std::size_t size)
      : empty_(loop.clone()), loop_(std::move(loop)), add_joint_(add_joint), bytes_(data, size) {
    wild_ = bytes_.chance(100) ? (bytes_.chance(128) ? 64 : 256) : 0;
    unit_ = bytes_.magnitude(-3, 3);
    h_ = bytes_.magnitude(-4, -1);
    if (bytes_.chance(64))
      set().gravity.setZero();
    else
      set().gravity *= unit_;
  }

  /// Which step took too many times the median of those that had as much to do; nothing if none did.
  std::string run() {
    while (!bytes_.is_empty() && steps_ < 24) act();
    for (int n = 0; n < 3; ++n) step();
    return slow_step_;
  }

 private:
  Set& set() { return bodies<Set>(loop_.world()); }
  bool is_wild() { return wild_ > 0 && bytes_.chance(wild_); }

  void act() {
    const int what = bytes_.below(16);
    bytes_.forget_nan();
    try {
      if (what < 3)
        add_body();
      else if (what < 6 && !bodies_.empty())
        join();
      else if (what == 6 && !bodies_.empty())
        push();
      else if (what == 7 && !bodies_.empty())
        move();
      else if (what == 8 && !bodies_.empty())
        remove();
      else if (what == 9 && !bodies_.empty())
        throw_one();
      else if (what == 13 && !bodies_.empty())
        add_twin();
      else if (what == 14 && !bodies_.empty())
        close_ring();
      else if (what == 15)
        step_by_odd();
      expect(!bytes_.gave_nan(), "NaN was taken");
    } catch (const InvalidArgument& refused) {
      expect(std::string(refused.what()).size() > 10, "a refusal says nothing");
    }
    if (what > 9 && what < 13) step();
    if (what == 12) go_on_from_checkpoint();
  }

  // One number after the other: the order in which arguments are evaluated is the compiler's.
  Vec3 place() { return unit_ * vector(bytes_, 2, is_wild()); }
  Handle any() { return bodies_[std::size_t(bytes_.below(int(bodies_.size())))]; }
  Anchor end() {
    const Vec3 local = unit_ * vector(bytes_, 1, is_wild());
    if (bytes_.chance(40)) return world_anchor(local);
    const Handle body = any();
    return anchor(set(), body, local, rotation(bytes_));
  }

  /// The second end may be on the same body, at the same point, or of the world as the first.
  void join() {
    const Anchor a = end(), b = end();
    add_joint_(loop_, bytes_, a, b);
  }

  void add_body() {
    RigidBody body;
    const int stretch = bytes_.below(3);
    const bool with_half_spaces = bytes_.chance(64), with_odd = is_wild();
    body.shape = shapes_.any(bytes_, unit_, stretch, with_half_spaces, with_odd);
    body.position = place();
    body.orientation = rotation(bytes_, is_wild());
    body.velocity = unit_ * vector(bytes_, 3, is_wild());
    body.angular_velocity = vector(bytes_, 10, is_wild());
    body.motion = Motion(bytes_.chance(200) ? 0 : bytes_.below(3));
    if (body.motion == Motion::dynamic) {
      if (bytes_.chance(128))
        body.mass = is_wild() ? bytes_.odd() : bytes_.magnitude(-3, 3);
      else
        body.density = is_wild() ? bytes_.odd() : bytes_.magnitude(1, 4);
    }
    add(body);
  }
  void add(const RigidBody& body) {
    if (bodies_.size() >= 7) return bytes_.forget_nan();
    bodies_.push_back(set().add(body));
    last_ = body;
  }
  /// The same body once more, where the first one was put.
  void add_twin() { add(last_); }

  /// Each body is joined to the next and the last to the first, at one point of the world with one frame: the
  /// joints fit, and those that close the ring are redundant. One body is joined to itself.
  void close_ring() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const Handle a = bodies_[k], b = bodies_[(k + 1) % bodies_.size()];
      const Vec3 point = 0.5 * (set().position(a) + set().position(b));
      add_joint_(loop_, bytes_, holding(a, point), holding(b, point));
    }
  }
  Anchor holding(Handle body, const Vec3& point) {
    const Quat back = set().orientation(body).conjugate();
    return anchor(set(), body, back * (point - set().position(body)), back);
  }

  /// What is pushed by a number that is not finite stays where it is, and the step says so.
  void push() {
    const Handle body = any();
    const double scale = unit_ * set().mass(body);
    const Vec3 force = scale * vector(bytes_, 100, is_wild());
    set().apply_force(body, force, place());
    set().apply_torque(body, scale * unit_ * vector(bytes_, 10, is_wild()));
    bytes_.forget_nan();
  }
  void move() {
    const Handle body = any();
    const Vec3 to = place();
    set().place(body, to, rotation(bytes_, is_wild()));
  }
  void throw_one() {
    const Handle body = any();
    const Vec3 velocity = unit_ * vector(bytes_, 10, is_wild());
    set().set_velocity(body, velocity, vector(bytes_, 100, is_wild()));
  }
  /// What h is refused changes nothing.
  void step_by_odd() {
    const double h = bytes_.odd();
    if (h > 0 && std::isfinite(h)) return;
    const auto before = state_hash(loop_);
    try {
      loop_.step(h);
    } catch (const InvalidArgument&) {
      expect(state_hash(loop_) == before, "a step that was refused changes the loop");
      throw;
    }
    expect(false, "a step of no length was taken");
  }

  void remove() {
    const std::size_t k = std::size_t(bytes_.below(int(bodies_.size())));
    loop_.remove(bodies_[k]);
    bodies_.erase(bodies_.begin() + std::ptrdiff_t(k));
  }

  void step() {
    ++steps_;
    const double start = thread_seconds();
    const StepReport report = loop_.step(h_);
    const double seconds = thread_seconds() - start;
    const int much = int(report.rows + report.pairs) + int(bodies_.size());
    // Two that are apart take 200 looks on their way, before and after the solve, and each takes up to 240 points of the
    // native kernel for the usual ten: 9600 times, where they turn beside each other without meeting. One that turns by a
    // thousand radians a step is turned in up to 127 parts, each of 20 iterations of eight trials for the usual three.
    const double most = 10000;
    if (times().share(much, seconds) > most)
      slow_step_ = "step " + std::to_string(steps_) + " of " + std::to_string(bodies_.size()) + " bodies, " +
                   std::to_string(report.pairs) + " pairs, " + std::to_string(report.rows) + " rows and " +
                   std::to_string(report.sweeps) + " sweeps takes " + std::to_string(1e6 * seconds) +
                   " us, over " + std::to_string(int(most)) + " times the median of its size";
    expect(report.quarantined == 0 || bytes_.odd_count() > 0,
           "a body is put aside though every number was sound");
    expect(!std::isnan(report.residual) && !std::isnan(report.max_penetration) && std::isfinite(report.time),
           "a number of the report is NaN");
    for (const Handle body : bodies_) {
      expect(is_finite(set().position(body)) && is_finite(set().velocity(body)) &&
                 is_finite(set().angular_velocity(body)),
             "the state of a body is not finite");
      // Squares, sum, root and quotient round once each.
      const double off = std::abs(set().orientation(body).coeffs().norm() - 1);
      expect(off <= 8 * std::numeric_limits<double>::epsilon(),
             "the quaternion of a body is not of unit length");
    }
    if constexpr (requires { loop_.contacts(); })
      for (const ContactResult& c : loop_.contacts()) check(c, report);
    loop_.each_impulse([&](const auto& impulse) {
      expect(is_finite(impulse) || report.quarantined > 0, "the impulse of a joint is not finite");
    });
  }

  static void check(const ContactResult& c, const StepReport& report) {
    expect(is_finite(c.record.normal) && std::abs(c.record.normal.norm() - 1) < 1e-9,
           "the normal of a contact is no unit vector");
    expect(std::isfinite(c.record.gap) && is_finite(c.record.point()), "a contact is not finite");
    expect(is_finite(c.impulse) || report.quarantined > 0, "the impulse of a contact is not finite");
  }

  /// What a checkpoint gives goes on to the bit; with one byte changed it is refused, and changes nothing.
  void go_on_from_checkpoint() {
    std::vector<char> kept = checkpoint(loop_);
    Loop other = empty_.clone();
    restore(other, kept);
    expect(state_hash(other) == state_hash(loop_), "a loop that was restored is not where it was");
    loop_.step(h_), other.step(h_);
    expect(state_hash(other) == state_hash(loop_), "a loop that was restored does not go on to the bit");
    const std::size_t page = bytes_.byte(), place = 256 * page + bytes_.byte();
    kept[place % kept.size()] ^= char(1 + bytes_.below(255));
    const auto before = state_hash(other);
    bool is_refused = false;
    try {
      restore(other, kept);
    } catch (const InvalidArgument&) {
      is_refused = true;
    }
    expect(is_refused, "a damaged checkpoint is not refused");
    expect(state_hash(other) == before, "a refused checkpoint changes the loop");
  }

  static StepTimes& times() {
    static StepTimes all;
    return all;
  }

  Loop empty_, loop_;
  AddJoint add_joint_;
  Bytes bytes_;
  Shapes shapes_;
  std::vector<Handle> bodies_;
  double unit_ = 1, h_ = 1;
  RigidBody last_;
  int wild_ = 0;  ///< of 256: how often an odd number may be given
  int steps_ = 0;
  std::string slow_step_;
};

/// A step that is slow once met a cold cache or another program: it is slow if it is so three times.
template <class Loop, class AddJoint>
int play(const Loop& loop, AddJoint add_joint, const std::uint8_t* data, std::size_t size) {
  for (int tries = 0; tries < 3; ++tries) {
    const std::string slow = Scene(loop.clone(), add_joint, data, size).run();
    if (slow.empty()) break;
    expect(tries < 2, slow);
  }
  return 0;
}

/// The force, moment or speed of an item, or an odd number where the scene asks for one.
inline double amount(Bytes& bytes) { return bytes.chance(16) ? bytes.odd() : bytes.magnitude(-2, 4); }

}  // namespace fuzz
