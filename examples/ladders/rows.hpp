/// The rows that delassus_ladders runs: one function a row, and what is known of those that cannot be run
/// yet.
#pragma once

#include "ladder.hpp"

namespace ladders {

void mass_ratio(Ladder&);
void mass_ratio_newton(Ladder&);
void big_on_small(Ladder&);
void big_on_small_newton(Ladder&);
void warm_start_energy(Ladder&);
void heavy_chain(Ladder&);
void heavy_chain_newton(Ladder&);
void heavy_chain_fine(Ladder&);
void stretched_chain(Ladder&);
void joint_grid(Ladder&);
void stack(Ladder&);
void stack_newton(Ladder&);
void card_house(Ladder&);
void dominoes(Ladder&);
void tower(Ladder&);
void stiffness(Ladder&);
void step_size(Ladder&);
void drives(Ladder&);
void friction_range(Ladder&);
void friction_range_newton(Ladder&);
void grip(Ladder&);
void duplicates(Ladder&);
void many_hinges(Ladder&);
void vanishing_mass(Ladder&);
void no_room(Ladder&);
void opposed_motors(Ladder&);
void free_spin(Ladder&);
void long_spin(Ladder&);
void long_pendulum(Ladder&);
void overlap(Ladder&);
void no_normal(Ladder&);
void bad_input(Ladder&);
void far_away(Ladder&);
void scale(Ladder&);
void seams(Ladder&);
void seams_left_out(Ladder&);
void bullet(Ladder&);
void bullet_watched(Ladder&);
void elastic_balls(Ladder&);
void simultaneous(Ladder&);
void heap(Ladder&);
void four_bars(Ladder&);
void gear_train(Ladder&);
void limits(Ladder&);

struct Row {
  const char* id;
  const char* title;
  const char* parts;  ///< of the loop, where they are not the defaults
  void (*climb)(Ladder&);
  Level at_least;  ///< what the first, easiest rung reaches: the tests hold it
};

inline constexpr Row rows[] = {
    {"HC-01", "mass ratio: r kg on 1 kg", "", mass_ratio, Level::gold},
    {"HC-01", "mass ratio: r kg on 1 kg", "ProximalNewton", mass_ratio_newton, Level::gold},
    {"HC-02", "big on small", "", big_on_small, Level::gold},
    {"HC-02", "big on small", "ProximalNewton", big_on_small_newton, Level::gold},
    {"HC-03", "chain with a heavy end, 60 steps a second", "", heavy_chain, Level::silver},
    {"HC-03", "chain with a heavy end, 60 steps a second", "ProximalNewton, WholeViolation",
     heavy_chain_newton, Level::silver},
    {"HC-03", "chain with a heavy end, 960 steps a second", "ProximalNewton, WholeViolation",
     heavy_chain_fine, Level::gold},
    {"HC-04", "stack", "", stack, Level::gold},
    {"HC-04", "stack", "ProximalNewton", stack_newton, Level::gold},
    {"HC-05", "heavy top taken away", "", warm_start_energy, Level::gold},
    {"HC-06", "soft joint", "", stiffness, Level::gold},
    {"HC-07", "step size", "PositionProjection", step_size, Level::gold},
    {"HC-08", "range of friction", "", friction_range, Level::gold},
    {"HC-08", "range of friction", "ProximalNewton", friction_range_newton, Level::gold},
    {"HC-09", "duplicate constraints", "", duplicates, Level::gold},
    {"HC-10", "redundant hinges", "WholeViolation", many_hinges, Level::silver},
    {"HC-11", "vanishing mass in a chain", "PositionProjection", vanishing_mass, Level::gold},
    {"HC-12", "free spin, 100 s at 60 steps a second", "", free_spin, Level::gold},
    {"HC-13", "overlap at the start", "", overlap, Level::bronze},
    {"HC-14", "bad input", "", bad_input, Level::gold},
    {"HC-15", "far from the origin", "", far_away, Level::gold},
    {"HC-16", "no normal", "", no_normal, Level::gold},
    {"HC-17", "seams of a floor", "", seams, Level::bronze},
    {"HC-17", "seams of a floor", "Seamless", seams_left_out, Level::gold},
    {"HC-18", "bullet and thin plate", "", bullet, Level::gold},
    {"HC-18", "bullet and thin plate", "Continuous", bullet_watched, Level::gold},
    {"HC-21", "four-bars through their singular pose", "ProximalNewton, WholeViolation", four_bars,
     Level::bronze},
    {"HC-22", "bar without room", "", no_room, Level::gold},
    {"HC-22", "opposed motors", "", opposed_motors, Level::gold},
    {"HC-24", "elastic balls", "", elastic_balls, Level::silver},
    {"HC-25", "impacts at one moment", "", simultaneous, Level::gold},
    {"HC-26", "card house", "ProximalNewton", card_house, Level::gold},
    {"HC-28", "dominoes", "ProximalNewton", dominoes, Level::silver},
    {"HC-29", "tower of blocks, one taken out", "ProximalNewton", tower, Level::gold},
    {"HC-30", "heap of spheres", "AcceleratedGaussSeidel{.tolerance = 1e-5}", heap, Level::gold},
    {"HC-33", "train of gears", "", gear_train, Level::gold},
    {"HC-34", "chain at its limits", "", limits, Level::gold},
    {"HC-35", "net of ball joints", "AcceleratedGaussSeidel{.tolerance = 1e-6}, WholeViolation", joint_grid,
     Level::gold},
    {"HC-36", "stretched chain", "PositionProjection", stretched_chain, Level::gold},
    {"HC-38", "stiff drive", "", drives, Level::silver},
    {"HC-39", "grip", "ProximalNewton", grip, Level::silver},
    {"HC-41", "long spin", "", long_spin, Level::gold},
    {"HC-41", "long pendulum", "ImplicitMidpoint, PositionProjection", long_pendulum, Level::gold},
    {"HC-42", "tiny and huge", "", scale, Level::gold},
};

struct Missing {
  const char* id;
  const char* title;
  const char* reason;
};

inline constexpr Missing missing[] = {
    {"HC-19", "inverted elements", "no rung yet; tests do it (`loop/soft_recovery`, `loop/soft_hexahedra`)"},
    {"HC-20", "nearly incompressible", "no rung yet; a test goes to 0.4999 (`bodies/hexahedral_bending`)"},
    {"HC-23", "Painlevé", "not built yet; needs no new part"},
    {"HC-27", "arch on moving supports", "not built yet; needs no new part"},
    {"HC-31", "rope with a knot",
     "not built yet; a rope's contact with itself needs small steps and continuous collision"},
    {"HC-32", "nut on a bolt", "not built yet; meshes are `WithMeshes`"},
    {"HC-37", "crowding", "not built yet; needs no new part"},
    {"HC-40", "rigid on soft", "no rung yet; a test goes from 1 g to 1 t (`loop/soft_coupling`)"},
};

}  // namespace ladders
