/// Scenes out of bytes: bodies, joints, forces, removals and steps in any order, and what must hold after
/// every step.
#pragma once

#include "shapes.hpp"

#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/rows/anchor.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fuzz {

/// Whatever a scene is told, it takes or refuses with a sentence; a step takes what is there, and leaves no
/// number that is not finite in a body, a contact or an impulse. `AddJoint` is called with (loop, bytes, a,
/// b) and adds one constraint.
template <class Loop, class AddJoint>
class Scene {
 public:
  using Set = RigidBodies;
  using Handle = Set::Handle;

  Scene(Loop loop, AddJoint add_joint, const std::uint8_t* data, std::size_t size)
      : empty_(loop), loop_(std::move(loop)), add_joint_(add_joint), bytes_(data, size) {
    is_wild_ = bytes_.chance(100);
    unit_ = bytes_.magnitude(-3, 3);
    h_ = bytes_.magnitude(-4, -1);
    if (bytes_.chance(64))
      set().gravity.setZero();
    else
      set().gravity *= unit_;
  }

  void run() {
    while (!bytes_.is_empty() && steps_ < 24) act();
    for (int n = 0; n < 3; ++n) step();
  }

 private:
  Set& set() { return bodies<Set>(loop_.world()); }
  bool odd_number() { return is_wild_ && bytes_.chance(64); }

  void act() {
    const int what = bytes_.below(13);
    try {
      if (what < 3)
        add_body();
      else if (what < 6 && !bodies_.empty())
        add_joint_(loop_, bytes_, end(), end());
      else if (what == 6 && !bodies_.empty())
        push();
      else if (what == 7 && !bodies_.empty())
        set().place(any(), place(), rotation(bytes_));
      else if (what == 8 && !bodies_.empty())
        remove();
      else if (what == 9 && !bodies_.empty())
        set().set_velocity(any(), unit_ * vector(bytes_, 10, odd_number()),
                           vector(bytes_, 100, odd_number()));
    } catch (const InvalidArgument& refused) {
      expect(std::string(refused.what()).size() > 10, "a refusal says nothing");
    }
    if (what > 9) step();
    if (what == 12) go_on_from_checkpoint();
  }

  Vec3 place() { return unit_ * vector(bytes_, 2, odd_number()); }
  Handle any() { return bodies_[std::size_t(bytes_.below(int(bodies_.size())))]; }
  Anchor end() {
    const Vec3 local = unit_ * vector(bytes_, 1, odd_number());
    if (bytes_.chance(40)) return world_anchor(local);
    return anchor(set(), any(), local, rotation(bytes_));
  }

  void add_body() {
    if (bodies_.size() >= 7) return;
    RigidBody body;
    body.shape = shapes_.any(bytes_, unit_, bytes_.below(3), bytes_.chance(64));
    body.position = place();
    body.orientation = rotation(bytes_);
    body.velocity = unit_ * vector(bytes_, 3, odd_number());
    body.angular_velocity = vector(bytes_, 10, odd_number());
    body.motion = Motion(bytes_.chance(200) ? 0 : bytes_.below(3));
    if (bytes_.chance(128))
      body.mass = odd_number() ? bytes_.odd() : bytes_.magnitude(-3, 3);
    else
      body.density = odd_number() ? bytes_.odd() : bytes_.magnitude(1, 4);
    bodies_.push_back(set().add(body));
  }

  void push() {
    const Handle body = any();
    const double scale = unit_ * set().mass(body);
    set().apply_force(body, scale * vector(bytes_, 100, odd_number()), place());
    set().apply_torque(body, scale * unit_ * vector(bytes_, 10, odd_number()));
  }

  void remove() {
    const std::size_t k = std::size_t(bytes_.below(int(bodies_.size())));
    loop_.remove(bodies_[k]);
    bodies_.erase(bodies_.begin() + std::ptrdiff_t(k));
  }

  void step() {
    ++steps_;
    const StepReport report = loop_.step(h_);
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
    Loop other = empty_;
    restore(other, kept);
    expect(state_hash(other) == state_hash(loop_), "a loop that was restored is not where it was");
    loop_.step(h_), other.step(h_);
    expect(state_hash(other) == state_hash(loop_), "a loop that was restored does not go on to the bit");
    kept[(256 * std::size_t(bytes_.byte()) + bytes_.byte()) % kept.size()] ^= char(1 + bytes_.below(255));
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

  Loop empty_, loop_;
  AddJoint add_joint_;
  Bytes bytes_;
  Shapes shapes_;
  std::vector<Handle> bodies_;
  double unit_ = 1, h_ = 1;
  bool is_wild_ = false;
  int steps_ = 0;
};

/// The force, moment or speed of an item, or an odd number where the scene asks for one.
inline double amount(Bytes& bytes) { return bytes.chance(16) ? bytes.odd() : bytes.magnitude(-2, 4); }

}  // namespace fuzz
