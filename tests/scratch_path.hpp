/// Where a test writes its files: a name of its own in each process, so that tests may run at once.
#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

namespace delassus {

/// A path in the folder of temporary files that no other process has. Nothing is created there.
inline std::filesystem::path scratch_path(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("delassus_" + std::to_string(::getpid()) + "_" + name);
}

}  // namespace delassus
