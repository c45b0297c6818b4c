/// A scene in words of no engine: plain numbers, SI units, the world's frame where nothing else is said.
#pragma once

#include <array>
#include <stdexcept>
#include <vector>

namespace ladders::peers {

using Triple = std::array<double, 3>;
using Quadruple = std::array<double, 4>;  ///< a unit quaternion w, x, y, z

/// A scene that a description, or an engine, has no words for; what() says what it needs, "needs a gear".
struct Unsayable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class Form { none, half_space, box, sphere, capsule, cylinder, convex };

/// In the body's frame. `size`: half-space: outward unit normal, offset along it; box: half edges; sphere:
/// radius; capsule and cylinder along z: radius, half height (of a capsule without its caps). m.
struct Geometry {
  Form form = Form::none;
  std::array<double, 4> size{};
  std::vector<Triple> corners{};  ///< of a convex hull
};

/// Where a body is and how it moves, at its centre of mass.
struct State {
  Triple position{};
  Quadruple turn{1, 0, 0, 0};
  Triple velocity{}, spin{};  ///< m/s and rad/s
};

/// The frame of a body that moves is at its centre of mass and along its principal axes.
struct Body {
  Geometry geometry{};
  bool is_fixed = false;
  double mass = 0;   ///< kg
  Triple moments{};  ///< principal, kg·m²
  State start{};
};

enum class Hold { ball, hinge, slider, weld };

/// Two frames, one on each end, each in its body's frame; a negative body is the world. Ball: their origins
/// coincide; hinge: and their z axes; slider: b moves along z of a and does not turn; weld: all coincides.
struct Joint {
  Hold hold = Hold::ball;
  int a = -1, b = -1;
  Triple on_a{}, on_b{};
  Quadruple frame_a{1, 0, 0, 0}, frame_b{1, 0, 0, 0};
};

/// One friction and one restitution for all pairs, Coulomb's and Newton's. Bodies touch each other only if
/// `touches`.
struct Scene {
  std::vector<Body> bodies{};
  std::vector<Joint> joints{};
  Triple gravity{};
  double friction = 0, restitution = 0;
  bool touches = false;
};

}  // namespace ladders::peers
