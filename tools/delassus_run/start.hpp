/// A machine as its run begins: on its base, on the floor, its joints in place.
#pragma once

#include "options.hpp"

#include <string>
#include <vector>

namespace delassus_run {

/// The link that a body of a loop was made of, the first of them; −1: none.
Index link_of(const Machine& machine, const Anchor& body);

/// What a run begins from. Made once, and put into as many loops as wanted.
class Start {
 public:
  std::vector<std::string> notes;  ///< sentences that the user should read

  /// Refuses a keyframe and joints that are not there. Links of one tree that are in each other as the run begins do not collide,
  /// unless the options say so.
  Start(const Model& model, const Options& options);

  Start(const Start&) = delete;

  /// The machine in a loop of its own.
  std::unique_ptr<Motion> put(const Asked& asked) const;
  /// Where the frame of the model is.
  const Pose& pose() const { return pose_; }
  bool adds_floor() const { return adds_floor_; }

 private:
  void add_holders(const Options& options);
  void find_floor(const Options& options);
  void tell_limits(const Motion& motion);
  void tell_fall(const Motion& motion);
  void find_overlaps(Motion& motion, const Options& options);

  Model model_;
  Base base_;
  Pose pose_;
  bool adds_floor_ = false;
  const model::Keyframe* key_ = nullptr;
  std::size_t own_actuators_ = 0;  ///< of the file; those behind them hold their joints
  std::vector<double> q_, v_;      ///< see `JointNumbers`
};

}  // namespace delassus_run
