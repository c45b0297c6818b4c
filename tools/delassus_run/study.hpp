/// What accuracy costs for a machine, over the loops that are compiled in.
#pragma once

#include "start.hpp"

#include <string>

namespace delassus_run {

/// Runs `file` over loops, steps and tolerances for options.seconds; prints what is best for its cost and the cheapest run within
/// options.budget, as words for the command line. Writes <base>.study.csv and .study.svg.
void study_of(const Model& model, const Start& start, const Options& options, const std::string& file, const std::string& base);

}  // namespace delassus_run
