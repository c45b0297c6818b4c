/// The rows that delassus_ladders runs: one function a row.
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
void heavy_chain_midpoint(Ladder&);
void hanging_chain(Ladder&);
void stretched_chain(Ladder&);
void joint_grid(Ladder&);
void joint_grid_direct(Ladder&);
void joint_grid_level(Ladder&);
void stack(Ladder&);
void stack_newton(Ladder&);
void pyramid(Ladder&);
void card_house(Ladder&);
void dominoes(Ladder&);
void dominoes_newton(Ladder&);
void tower(Ladder&);
void stiffness(Ladder&);
void step_size(Ladder&);
void drives(Ladder&);
void friction_range(Ladder&);
void friction_range_newton(Ladder&);
void friction_range_in_200(Ladder&);
void jams(Ladder&);
void jams_newton(Ladder&);
void grip(Ladder&);
void duplicates(Ladder&);
void many_hinges(Ladder&);
void many_hinges_midpoint(Ladder&);
void supports(Ladder&);
void supports_shared(Ladder&);
void loops_in_space(Ladder&);
void vanishing_mass(Ladder&);
void vanishing_mass_midpoint(Ladder&);
void no_room(Ladder&);
void opposed_motors(Ladder&);
void no_way(Ladder&);
void free_spin(Ladder&);
void long_spin(Ladder&);
void long_pendulum(Ladder&);
void long_pendulum_midpoint(Ladder&);
void long_top(Ladder&);
void long_rest(Ladder&);
void long_rest_exact(Ladder&);
void long_sleep(Ladder&);
void overlap(Ladder&);
void overlap_projected(Ladder&);
void one_place(Ladder&);
void one_place_projected(Ladder&);
void no_normal(Ladder&);
void bad_input(Ladder&);
void far_away(Ladder&);
void far_away_in_float(Ladder&);
void scale(Ladder&);
void seams(Ladder&);
void seams_left_out(Ladder&);
void slide_over_triangles(Ladder&);
void edges(Ladder&);
void bullet(Ladder&);
void elastic_balls(Ladder&);
void simultaneous(Ladder&);
void heap(Ladder&);
void heap_loose(Ladder&);
void four_bars(Ladder&);
void four_bars_midpoint(Ladder&);
void four_bars_midpoint_in_parts(Ladder&);
void dead_centres(Ladder&);
void gear_train(Ladder&);
void gear_train_direct(Ladder&);
void gear_train_rattle(Ladder&);
void limits(Ladder&);
void limits_in_parts(Ladder&);
void inverted_elements(Ladder&);
void incompressible(Ladder&);
void squeezed(Ladder&);
void squeezed_tetrahedra(Ladder&);
void rigid_on_soft(Ladder&);
void soft_grip(Ladder&);
void painleve(Ladder&);
void drawer(Ladder&);
void arch(Ladder&);
void arch_that_spreads(Ladder&);
void bollard(Ladder&);
void knot(Ladder&);
void screw(Ladder&);
void thread_by_contacts(Ladder&);
void crowding(Ladder&);
void crowding_foreseen(Ladder&);
void hopper(Ladder&);
void hopper_of_many(Ladder&);
void hopper_of_cubes(Ladder&);
void repose(Ladder&);
void silo(Ladder&);
void confined(Ladder&);
void confined_yielding(Ladder&);
void confined_soft(Ladder&);

struct Row {
  const char* id;
  const char* title;
  const char* parts;  ///< of the loop, where they are not the defaults
  void (*climb)(Ladder&);
  Level at_least;  ///< what the first, easiest rung reaches: the tests hold it
  double patience = 1;  ///< its rungs may take this many times as long as others
};

inline constexpr Row rows[] = {
    {"HC-01", "mass ratio: r kg on 1 kg", "", mass_ratio, Level::gold},
    {"HC-01", "mass ratio: r kg on 1 kg", "ProximalNewton{.tolerance = 1e-6}", mass_ratio_newton,
     Level::gold},
    {"HC-02", "big on small", "", big_on_small, Level::gold},
    {"HC-02", "big on small", "ProximalNewton", big_on_small_newton, Level::gold},
    {"HC-03", "chain with a heavy end, 60 steps a second", "", heavy_chain, Level::silver},
    {"HC-03", "chain with a heavy end, 60 steps a second", "ProximalNewton, WholeViolation",
     heavy_chain_newton, Level::silver},
    {"HC-03", "chain with a heavy end, 960 steps a second", "ProximalNewton, WholeViolation",
     heavy_chain_fine, Level::gold},
    {"HC-03", "chain with a heavy end, 60 steps a second", "NewtonMidpoint", heavy_chain_midpoint,
     Level::gold},
    {"HC-03", "hanging chain, its first swing", "NewtonMidpoint", hanging_chain, Level::gold},
    {"HC-04", "stack", "", stack, Level::gold},
    {"HC-04", "stack", "ProximalNewton", stack_newton, Level::gold},
    {"HC-04", "pyramid", "ProximalNewton", pyramid, Level::gold, 10},
    {"HC-05", "heavy top taken away", "", warm_start_energy, Level::gold},
    {"HC-06", "soft joint", "", stiffness, Level::gold},
    {"HC-07", "step size", "PositionProjection", step_size, Level::gold},
    {"HC-08", "range of friction", "", friction_range, Level::gold},
    {"HC-08", "range of friction", "ProximalNewton", friction_range_newton, Level::gold},
    {"HC-08", "range of friction up to 1, all its scenes", "AcceleratedGaussSeidel{.tolerance = 1e-6, .max_iterations = 200}",
     friction_range_in_200, Level::silver},
    {"HC-08", "range of friction, wedge and arch", "", jams, Level::gold},
    {"HC-08", "range of friction, wedge and arch", "ProximalNewton, PositionProjection", jams_newton, Level::gold},
    {"HC-09", "duplicate constraints", "", duplicates, Level::gold},
    {"HC-10", "redundant hinges", "WholeViolation, Substeps{.count = 4}", many_hinges, Level::gold},
    {"HC-10", "redundant hinges", "NewtonMidpoint", many_hinges_midpoint, Level::gold},
    {"HC-10", "box and table on many supports", "", supports, Level::silver},
    {"HC-10", "box and table on many supports", "MinimumNorm{AcceleratedGaussSeidel{.tolerance = 1e-10}}",
     supports_shared, Level::gold},
    {"HC-10", "redundant loops", "NewtonMidpoint", loops_in_space, Level::gold},
    {"HC-11", "vanishing mass in a chain", "PositionProjection", vanishing_mass, Level::gold},
    {"HC-11", "vanishing mass in a chain", "NewtonMidpoint", vanishing_mass_midpoint, Level::gold},
    {"HC-12", "free spin, 100 s at 60 steps a second", "", free_spin, Level::gold},
    {"HC-13", "overlap at the start", "", overlap, Level::bronze},
    {"HC-13", "overlap at the start", "PositionProjection", overlap_projected, Level::gold},
    {"HC-13", "bodies in one place",
     "AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 300}, MatrixFreeCompliance", one_place,
     Level::bronze},
    {"HC-13", "bodies in one place",
     "PositionProjection, AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 300}, MatrixFreeCompliance",
     one_place_projected, Level::gold},
    {"HC-14", "bad input", "", bad_input, Level::gold},
    {"HC-15", "far from the origin", "", far_away, Level::gold},
    {"HC-15", "far from the origin, single precision", "RigidBodiesF", far_away_in_float, Level::gold},
    {"HC-16", "no normal", "", no_normal, Level::gold},
    {"HC-17", "seams of a floor", "", seams, Level::bronze},
    {"HC-17", "seams of a floor", "Seamless", seams_left_out, Level::gold},
    {"HC-17", "floor of triangles", "WithMeshes{NativeCollision{}}", slide_over_triangles, Level::gold},
    {"HC-17", "edges on edges", "", edges, Level::gold},
    {"HC-18", "bullet and thin plate", "", bullet, Level::gold},
    {"HC-19", "inverted elements", "TetrahedralFem, ImplicitEuler", inverted_elements, Level::gold},
    {"HC-20", "nearly incompressible beam", "HexahedralFem", incompressible, Level::gold},
    {"HC-20", "squeezed block", "HexahedralFem<StableNeoHookean>", squeezed, Level::silver},
    {"HC-20", "squeezed block", "TetrahedralFem<StableNeoHookean>, which locks", squeezed_tetrahedra,
     Level::silver},
    {"HC-21", "four-bars through their singular pose", "ProximalNewton, WholeViolation", four_bars,
     Level::bronze},
    {"HC-21", "four-bars through their singular pose", "NewtonMidpoint", four_bars_midpoint, Level::silver},
    {"HC-21", "four-bars through their singular pose", "NewtonMidpoint, Substeps{.count = 4}",
     four_bars_midpoint_in_parts, Level::gold},
    {"HC-21", "slider-crank and five-bar at their dead centres", "NewtonMidpoint", dead_centres, Level::gold},
    {"HC-22", "bar without room", "", no_room, Level::gold},
    {"HC-22", "opposed motors", "", opposed_motors, Level::gold},
    {"HC-22", "limits, a loop and a pin that cannot be", "PositionProjection", no_way, Level::gold},
    {"HC-23", "a rod that is pushed on its tip", "", painleve, Level::gold},
    {"HC-23", "drawer that jams", "", drawer, Level::gold},
    {"HC-24", "elastic balls", "", elastic_balls, Level::silver},
    {"HC-25", "impacts at one moment", "", simultaneous, Level::gold},
    {"HC-26", "card house", "ProximalNewton", card_house, Level::gold},
    {"HC-27", "arch", "ProximalNewton", arch, Level::silver},
    {"HC-27", "arch whose support gives way", "ProximalNewton", arch_that_spreads, Level::silver},
    {"HC-28", "dominoes", "", dominoes, Level::silver},
    {"HC-28", "dominoes", "ProximalNewton", dominoes_newton, Level::silver},
    {"HC-29", "tower of blocks, one taken out", "ProximalNewton", tower, Level::gold},
    {"HC-30", "heap of spheres", "AcceleratedGaussSeidel{.tolerance = 1e-5}", heap, Level::gold},
    {"HC-30", "heap of spheres", "AcceleratedGaussSeidel{.tolerance = 1e-3, .max_iterations = 300}",
     heap_loose, Level::gold},
    {"HC-30", "hopper", "AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 100}", hopper, Level::silver},
    {"HC-30", "hopper, many grains", "AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 100}", hopper_of_many,
     Level::silver, 10},
    {"HC-30", "hopper, cubes, 480 steps a second",
     "AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 100}, NativeCollision{.margin = 0.01}, CheaperCompliance",
     hopper_of_cubes, Level::silver, 10},
    {"HC-30", "angle of repose", "AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 100}", repose, Level::silver, 10},
    {"HC-30", "silo", "AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 100}", silo, Level::silver},
    {"HC-31", "rope around a bollard, loads by the capstan's formula", "DirectGaussSeidel, WholeViolation",
     bollard, Level::silver},
    {"HC-31", "overhand knot in a rope of 200 links, 960 steps a second",
     "DirectGaussSeidel{.tolerance = 1e-6}, WholeViolation, WithFilter", knot, Level::silver},
    {"HC-32", "nut on a bolt, by its contacts",
     "AcceleratedGaussSeidel{.tolerance = 1e-4}, WithMeshes{NativeCollision{.margin = 5e-5}}",
     thread_by_contacts, Level::silver},
    {"HC-32", "nut on a bolt, by a joint", "", screw, Level::silver},
    {"HC-33", "train of gears", "", gear_train, Level::gold},
    {"HC-33", "train of gears", "DirectGaussSeidel", gear_train_direct, Level::silver},
    {"HC-33", "train of gears", "Rattle", gear_train_rattle, Level::gold},
    {"HC-34", "chain at its limits", "", limits, Level::gold},
    {"HC-34", "chain at its limits", "WholeViolation, Substeps{.count = 4}", limits_in_parts, Level::gold},
    {"HC-35", "net of ball joints", "AcceleratedGaussSeidel{.tolerance = 1e-6}, WholeViolation", joint_grid,
     Level::gold},
    {"HC-35", "net of ball joints", "DirectGaussSeidel, WholeViolation", joint_grid_direct, Level::silver, 10},
    {"HC-35", "net of ball joints, let go level", "DirectGaussSeidel, WholeViolation, Substeps{.count = 16}",
     joint_grid_level, Level::silver},
    {"HC-36", "stretched chain", "PositionProjection", stretched_chain, Level::gold},
    {"HC-37", "crowding", "ProximalNewton", crowding, Level::gold},
    {"HC-37", "crowding",
     "AcceleratedGaussSeidel{.tolerance = 1e-3, .max_iterations = 300}, NativeCollision{.margin = 0.1}",
     crowding_foreseen, Level::gold},
    {"HC-37", "box that is too small", "AcceleratedGaussSeidel{.tolerance = 1e-3, .max_iterations = 300}", confined,
     Level::gold},
    {"HC-37", "box that is too small", "SoftContact", confined_soft, Level::gold},
    {"HC-37", "box that is too small", "WithCompliance{Baumgarte{}, 1e-5}", confined_yielding, Level::gold},
    {"HC-38", "stiff drive", "", drives, Level::gold},
    {"HC-39", "grip", "ProximalNewton", grip, Level::silver},
    {"HC-40", "rigid on soft", "HexahedralFem, ImplicitEuler", rigid_on_soft, Level::silver},
    {"HC-40", "soft body between rigid fingers", "HexahedralFem, ImplicitEuler", soft_grip, Level::gold},
    {"HC-41", "long spin", "", long_spin, Level::gold},
    {"HC-41", "long pendulum", "ImplicitMidpoint, PositionProjection", long_pendulum, Level::gold},
    {"HC-41", "long pendulum", "NewtonMidpoint", long_pendulum_midpoint, Level::gold},
    {"HC-41", "long heavy top", "NewtonMidpoint", long_top, Level::gold},
    {"HC-41", "long rest of a stack", "", long_rest, Level::silver},
    {"HC-41", "long rest of a stack", "AcceleratedGaussSeidel{.tolerance = 1e-12}", long_rest_exact,
     Level::gold},
    {"HC-41", "long rest of a stack", "Sleeping", long_sleep, Level::gold},
    {"HC-42", "tiny and huge", "", scale, Level::gold},
};

}  // namespace ladders
