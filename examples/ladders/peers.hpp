/// The best of other engines on the scene next to a row, as measured on one machine; docs/ladders.md says
/// how.
#pragma once

#include <string_view>

namespace ladders {

/// One figure of one engine. `figure` names scene, step, error and processor time of a step.
struct Peer {
  std::string_view id;     ///< of the row
  std::string_view title;  ///< its beginning, where only some rows of that id are meant
  std::string_view figure;
};

inline constexpr Peer peers[] = {
    {"HC-01", "",
     "ODE 0.16 direct: 1000 kg on 1 kg, 13 nm into each other at 6.5 µs a step; MuJoCo 3.12 stiff 2.2 mm at "
     "10 µs; the sweeps of "
     "Jolt, Bullet and ODE throw the light box out"},
    {"HC-03", "",
     "100 links, end 1000 ×, 5 s: none is right at 1/60 to 1/240 s; at 1/1000 s DART 6.12 in joint "
     "coordinates ends 0.8 mm off"},
    {"HC-04", "",
     "10 boxes, 10 s: MuJoCo 3.12 Newton 0.28 mm deep, top drifts 1e-14 m, 29 µs a step; DART 6.12 Dantzig "
     "18 µm, 446 µs; Jolt 5.5.1 "
     "2.4 mm, 12 mm, 11 µs"},
    {"HC-08", "",
     "a block on a slope of 0.95 μ, 5 s: Jolt 5.5.1 creeps 1e-8 m at any heading, 1.9 µs a step; MuJoCo 3.12 "
     "elliptic 0.6 mm"},
    {"HC-12", "",
     "100 s at 1/100 s: MuJoCo 2.2.2 with Runge-Kutta keeps energy to 1.5e-10 and the attitude to 3.5e-4 "
     "rad, 2.2 µs a step; "
     "first-order ones lose 18 to 25 % of the energy"},
    {"HC-24", "", "216 balls: ODE 0.16 keeps 0.9998 of the energy, 75 µs a step; Jolt 5.5.1 0.98"},
    {"HC-25", "",
     "cradle of touching balls: none gives the last more than 26 % of the energy; with gaps of 1 cm ODE 0.16 "
     "and DART 6.12 all of it"},
    {"HC-26", "",
     "two storeys, 10 s: Jolt 5.5.1 settles by 0.13 mm, 8.8 µs a step; DART 6.12 Dantzig by 16 µm, 200 µs"},
    {"HC-30", "",
     "1000 spheres: Jolt 5.5.1 with 0.5 mm of slop 2.1 mm deep, 2.0 ms a step; MuJoCo 3.12 CG 2.1 mm, 27 ms"},
    {"HC-41", "long pendulum",
     "a double one, 20 s at 1/100 s: MuJoCo with Runge-Kutta 2e-7 of the energy, 1.4 µs a step; ODE 0.16 and "
     "Bullet 3.24 3.8 %"},
};

inline constexpr std::string_view no_peer = "not measured";

constexpr std::string_view best_peer(std::string_view id, std::string_view title) {
  for (const Peer& peer : peers)
    if (peer.id == id && title.starts_with(peer.title)) return peer.figure;
  return no_peer;
}

}  // namespace ladders
