/// A machine as its run begins: on its base, on the floor, in the pose of a keyframe.
#pragma once

#include "options.hpp"

#include <string>
#include <vector>

namespace delassus_run {

/// What a run begins from. Made once, and put into as many loops as wanted.
class Start {
 public:
  std::vector<std::string> notes;  ///< sentences that the user should read

  /// Refuses a keyframe that is not there. Links of one tree that are in each other as the run begins do not collide, unless the
  /// options say so.
  Start(const Model& model, const Options& options);

  Start(const Start&) = delete;

  /// The machine in a loop of its own.
  std::unique_ptr<Motion> put(const Asked& asked) const;
  /// Where the frame of the model is.
  const Pose& pose() const { return pose_; }
  bool adds_floor() const { return adds_floor_; }

 private:
  void find_numbers(const Options& options);
  void find_allowed();
  bool is_tied(Index joint) const;
  void find_floor(const Options& options);
  void tell_limits(const Motion& motion);
  void tell_fall(const Motion& motion);
  void find_overlaps(Motion& motion, const Options& options);

  Model model_;
  Base base_;
  Pose pose_;
  bool adds_floor_ = false;
  const model::Keyframe* key_ = nullptr;
  std::vector<double> q_, v_;  ///< of the joints, see `JointSpace`; empty: as the tree describes
};

}  // namespace delassus_run
