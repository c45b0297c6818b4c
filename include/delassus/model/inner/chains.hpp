/// The joints of a link in order: slides, then hinges, a ball, or six freedoms; as frames in the world.
#pragma once

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/model/inner/lumps.hpp>
#include <delassus/model/machine.hpp>

#include <string>
#include <vector>

namespace delassus::inner {

/// What a link's joints are together. Points and axes are in the world, in the pose that the tree describes.
struct Chain {
  Index body = -1;                   ///< of the model
  bool is_free = false, is_ball = false;
  std::vector<Index> slides, hinges; ///< joints of the model, in order
  Vec3 at = zero<Vec3>();            ///< the point of the ball, or of the first hinge, or of the first slide
  Vec3 at_last = zero<Vec3>();       ///< of two hinges: the point of the last that is next to the first's axis
  std::vector<Vec3> axes;            ///< unit, of slides and then of hinges
  double cosine = 0, offset = 0;     ///< of two hinges, see SerialJoint

  Vec3 slide(std::size_t k) const { return axes[k]; }
  Vec3 hinge(std::size_t k) const { return axes[slides.size() + k]; }
};

/// Of a link whose frame is at `pose` in the world. Refuses what no law holds, in one sentence.
inline Chain chain_of(const Model& model, Index body, const Pose& pose) {
  Chain chain;
  chain.body = body;
  const std::string who = "model '" + model.name + "': body '" + model.bodies[std::size_t(body)].name + "'";
  std::vector<Vec3> points;
  for (const Index j : model.bodies[std::size_t(body)].joints) {
    const model::Joint& joint = model.joints[std::size_t(j)];
    const bool is_alone = model.bodies[std::size_t(body)].joints.size() == 1;
    if (joint.kind == model::JointKind::free || joint.kind == model::JointKind::ball) {
      DELASSUS_EXPECT(is_alone, who + " has joint '" + joint.name + "' beside others; a ball or a free joint is the only one of its body");
      (joint.kind == model::JointKind::free ? chain.is_free : chain.is_ball) = true;
      chain.at = pose.to_world(joint.point);
      return chain;
    }
    const bool is_slide = joint.kind == model::JointKind::slide;
    DELASSUS_EXPECT(!is_slide || chain.hinges.empty(),
                    who + ": slide '" + joint.name + "' comes after a hinge; put slides first, or a body of small mass between");
    (is_slide ? chain.slides : chain.hinges).push_back(j);
    chain.axes.push_back(pose.rotation * joint.axis);
    points.push_back(pose.to_world(joint.point));
  }
  DELASSUS_EXPECT(chain.slides.size() <= 3 && chain.hinges.size() <= 3, who + " has more than three slides or hinges; a joint takes three of each");
  if (points.empty()) return chain;
  for (std::size_t i = 0; i < chain.slides.size(); ++i)
    for (std::size_t k = i + 1; k < chain.slides.size(); ++k)
      DELASSUS_EXPECT(std::abs(dot(chain.slide(i), chain.slide(k))) < 1e-6,
                      who + " has slides that are not at right angles; a body of small mass between them parts them");
  const std::size_t first = chain.slides.size();
  chain.at = chain.at_last = first < points.size() ? points[first] : points[0];
  const auto skew = [&](std::size_t i, std::size_t k) { return norm(cross(chain.hinge(i), chain.hinge(k))); };
  if (chain.hinges.size() == 2) {
    DELASSUS_EXPECT(skew(0, 1) > 1e-3, who + " has two hinges that are parallel; a body of small mass between them parts them");
    const Vec3 p = chain.hinge(0), q = chain.hinge(1), r = points[first + 1] - points[first], n = cross(p, q);
    const double c = dot(p, q), left = 1 - c * c;
    chain.cosine = c;
    chain.offset = dot(r, n) / left;
    DELASSUS_EXPECT(chain.slides.empty() || std::abs(chain.offset) < 1e-9 * (norm(points[first]) + norm(points[first + 1]) + 1e-3),
                    who + " has slides and two hinges that pass each other; a body of small mass between slides and hinges parts them");
    chain.at += (dot(r, p) - c * dot(r, q)) / left * p;
    chain.at_last = points[first + 1] + (c * dot(r, p) - dot(r, q)) / left * q;
  }
  if (chain.hinges.size() == 3) {
    const double size = norm(points[first]) + norm(points[first + 1]) + norm(points[first + 2]) + 1e-3;
    // The points may differ along their axes: what counts is where the axes meet.
    for (std::size_t k = 1; k < 3; ++k) {
      const Vec3 r = points[first + k] - points[first];
      DELASSUS_EXPECT(norm(cross(r, chain.hinge(k))) < 1e-9 * size, who + " has three hinges that do not meet in one point; a body of small mass between them parts them");
    }
    DELASSUS_EXPECT(std::abs(dot(chain.hinge(0), chain.hinge(1))) < 1e-6 && std::abs(dot(chain.hinge(1), chain.hinge(2))) < 1e-6 && skew(0, 2) > 1e-3,
                    who + " has three hinges of which two in order are not at right angles, or the outer two are parallel; a body of small mass between them parts them");
  }
  return chain;
}

/// The turn that takes z to the axis of the joint, and x to one across it.
inline Quat along(const Vec3& axis) { return frame_along(axis); }

}  // namespace delassus::inner
