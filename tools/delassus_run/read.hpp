/// A model from a file of either kind.
#pragma once

#include "options.hpp"

#include <string>

namespace delassus_run {

/// By the file's name; where that is .xml, by its root.
Model read(const std::string& path, const Options& options);

/// `sentence` with a word of the tool in the place of one of the library.
std::string in_words_of_options(std::string sentence);

}  // namespace delassus_run
