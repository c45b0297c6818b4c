/// Everything up to the loop and its listeners; study, io and the adapters have their own headers.
#pragma once

#include <delassus/bodies/invariants.hpp>
#include <delassus/bodies/particles.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/compliance/assembled.hpp>
#include <delassus/compliance/matrix_free.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/integrators/symplectic_euler.hpp>
#include <delassus/listeners/convergence_record.hpp>
#include <delassus/listeners/stopwatch.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/stabilisation/baumgarte.hpp>
#include <delassus/stabilisation/position_projection.hpp>
#include <delassus/stabilisation/soft_contact.hpp>
#include <delassus/stabilisation/whole_violation.hpp>
