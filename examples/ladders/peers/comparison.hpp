/// Another engine in the loop's place: the rungs stay as they are, their bodies go where that engine moves
/// them.
#pragma once

#include "engine.hpp"
#include "gauge.hpp"

#include <cmath>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace ladders {

struct Mark;
struct Rung;

namespace peers {

/// What a ladder asks when its rungs are compared.
class Comparison {
 public:
  virtual ~Comparison() = default;
  virtual void begin(const std::string& difficulty) = 0;
  /// Leaves the marks that poses and velocities alone can give.
  virtual void judge(std::vector<Mark>& marks) = 0;
  /// Whether the row goes on after this rung.
  virtual bool end(const Rung& rung) = 0;
  /// The engine that steps in the loop's place; null when the loop itself is measured.
  virtual std::unique_ptr<Engine> engine(const Scene& scene, double h) = 0;
  /// Of one step: seconds of the processor, and what was seen after it.
  virtual void note(double seconds, const Reading& reading) = 0;
};

/// Seconds of the processor that this thread has had.
inline double thread_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// A loop whose steps are another engine's, or its own when there is none.
template <class Loop>
class Course {
 public:
  Course(Comparison& comparison, Loop& loop, double h)
      : comparison_(comparison), loop_(loop), told_(scene_of(loop)), gauge_(told_.scene) {
    engine_ = comparison.engine(told_.scene, h);
    read_states(loop, told_, states_);
    start_ = gauge_.read(states_, 0);
  }

  const Reading& start() const { return start_; }

  /// One step, after which the loop's bodies are where the engine has them.
  Reading step(double h) {
    if (engine_)
      take_loads(loop_, told_, [&](int body, const Triple& force, const Triple& torque) {
        engine_->push(body, force, torque);
      });
    const double before = thread_seconds();
    engine_ ? engine_->step(h) : void(loop_.step(h));
    const double spent = thread_seconds() - before;
    time_ += h;
    if (engine_) {
      for (std::size_t k = 0; k < states_.size(); ++k)
        if (!told_.scene.bodies[k].is_fixed) states_[k] = engine_->state(int(k));
      for (const State& s : states_) expect_sound(s);
      write_states(loop_, told_, states_);
    } else {
      read_states(loop_, told_, states_);
    }
    const Reading reading = gauge_.read(states_, h);
    comparison_.note(spent, reading);
    return reading;
  }

 private:
  /// What is beyond 1e12 m or m/s will not come back.
  void expect_sound(const State& s) const {
    double size = 0;
    for (const Triple* x : {&s.position, &s.velocity, &s.spin})
      for (const double c : *x) size += std::abs(c);
    for (const double c : s.turn) size += std::abs(c);
    if (!(size < 1e12)) throw std::runtime_error("diverged at t = " + std::to_string(time_) + " s");
  }

  Comparison& comparison_;
  Loop& loop_;
  Told told_;
  Gauge gauge_;
  std::unique_ptr<Engine> engine_;
  std::vector<State> states_;
  Reading start_;
  double time_ = 0;
};

}  // namespace peers
}  // namespace ladders
