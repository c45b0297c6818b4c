/// urdfdom's reading of a robot, without its words on the console: what it says there is an error with a
/// line.
#pragma once

#include <delassus/adapters/urdf/robot.hpp>

#include <exception>
#include <mutex>
#include <string>
#include <vector>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

namespace delassus::inner::urdf_file {

/// Collects what urdfdom would write on the console, for as long as it lives. One at a time: the handler is
/// global.
class Console : public console_bridge::OutputHandler {
 public:
  Console()
      : lock_(one()), level_(console_bridge::getLogLevel()), before_(console_bridge::getOutputHandler()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
    console_bridge::useOutputHandler(this);
  }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console() override {
    console_bridge::useOutputHandler(before_);
    console_bridge::setLogLevel(level_);
  }

  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override {
    said.push_back(text);
  }

  std::vector<std::string> said;

 private:
  static std::mutex& one() {
    static std::mutex mutex;
    return mutex;
  }

  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_;
  console_bridge::OutputHandler* before_;
};

/// What urdfdom made of a robot's plain text.
class Reading {
 public:
  Reading(const Robot& robot, const Source& in) {
    Console console;
    try {
      made_ = urdf::parseURDF(robot.plain());
    } catch (const std::exception& thrown) {
      console.said.push_back(thrown.what());
    }
    if (!made_ || !console.said.empty()) refuse_for(robot, in, console.said);
    for (Index i = 0; i < Index(robot.links.size()); ++i) {
      const urdf::LinkConstSharedPtr link = made_->getLink(std::to_string(i));
      if (!link || bool(link->inertial) != robot.link(i).has_inertial ||
          link->collision_array.size() != robot.link(i).collisions.size())
        in.refuse_at(robot.link(i).line, "urdfdom does not read all of link '" + robot.link(i).name + "'");
      links_.push_back(link);
    }
    for (Index j = 0; j < Index(robot.joints.size()); ++j) {
      joints_.push_back(made_->getJoint(std::to_string(j)));
      if (!joints_.back())
        in.refuse_at(robot.joint(j).line, "urdfdom does not read joint '" + robot.joint(j).name + "'");
    }
  }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  /// Each link owns those below it: a long chain would end in as many nested calls.
  ~Reading() {
    if (!made_) return;
    for (auto& [name, link] : made_->links_) {
      link->child_links.clear();
      link->child_joints.clear();
    }
  }

  const urdf::Link& link(Index i) const { return *links_[std::size_t(i)]; }
  const urdf::Joint& joint(Index j) const { return *joints_[std::size_t(j)]; }

 private:
  /// Its first complaint, at the joint or the link that a complaint names.
  [[noreturn]] static void refuse_for(const Robot& robot, const Source& in,
                                      const std::vector<std::string>& said) {
    const std::string first = said.empty() ? "it gives no reason" : said.front();
    for (const std::string& sentence : said) {
      const std::size_t open = sentence.find('['), close = sentence.find(']', open);
      if (open == sentence.npos || close == sentence.npos) continue;
      Index i = -1;
      std::from_chars(sentence.data() + open + 1, sentence.data() + close, i);
      const std::string before = sentence.substr(0, open);
      const bool is_link = before.ends_with("ink "), is_joint = before.ends_with("oint ");
      if (is_joint && i >= 0 && i < Index(robot.joints.size()))
        in.refuse_at(robot.joint(i).line,
                     "urdfdom does not take joint '" + robot.joint(i).name + "': " + first);
      if (is_link && i >= 0 && i < Index(robot.links.size()))
        in.refuse_at(robot.link(i).line, "urdfdom does not take link '" + robot.link(i).name + "': " + first);
    }
    in.refuse_at(in.root(), "urdfdom does not take this robot: " + first);
  }

  urdf::ModelInterfaceSharedPtr made_;
  std::vector<urdf::LinkConstSharedPtr> links_;
  std::vector<urdf::JointConstSharedPtr> joints_;
};

}  // namespace delassus::inner::urdf_file
