/// Controls of actuators over time, from a table.
#pragma once

#include <delassus/model/machine.hpp>

#include <string>
#include <vector>

namespace delassus_run {

/// A CSV file: a column `time`, s, ascending, and one for each actuator that it controls, by name. A row holds until the next;
/// before the first and without a file controls stay as they are.
class ControlTable {
 public:
  std::vector<std::string> notes;  ///< sentences that the user should read: what is beyond the range of an actuator

  ControlTable() = default;
  /// Refuses with file and line what is no such table of this machine.
  ControlTable(const std::string& path, const delassus::Machine& machine);

  /// The controls that hold at a time, s. Times do not go back.
  void set(delassus::Machine& machine, double time);

 private:
  void find_clamped(const std::string& path, const delassus::Machine& machine);

  std::vector<delassus::Index> actuators_;  ///< of the columns
  std::vector<double> times_, values_;      ///< row by row
  std::size_t next_ = 0;                    ///< the first row that is still to come
};

}  // namespace delassus_run
