/// What an engine is asked: to make a scene its own, to step, and to say where the bodies are.
#pragma once

#include "scene.hpp"

#include <memory>
#include <span>
#include <string>

namespace ladders::peers {

/// An engine with a scene in it. Only step() is timed.
class Engine {
 public:
  virtual ~Engine() = default;
  /// A force (N) at the centre of mass and a torque (N·m), for the next step only.
  virtual void push(int body, const Triple& force, const Triple& torque) = 0;
  virtual void step(double h) = 0;
  virtual State state(int body) const = 0;
};

/// One engine with one set of settings. `make` throws Unsayable for a scene that the engine cannot have.
struct EngineKind {
  const char* name;      ///< a word, for the command line and file names
  const char* title;     ///< with its version
  const char* settings;  ///< what is not the engine's default
  std::unique_ptr<Engine> (*make)(const Scene&, double h);
};

/// Those that were found when this was built; each adapter says its own.
std::span<const EngineKind> bullet_kinds();
std::span<const EngineKind> ode_kinds();
std::span<const EngineKind> dart_kinds();
std::span<const EngineKind> mujoco_kinds();

}  // namespace ladders::peers
