// A ball knocks over a tower of five boxes; the run is written as a page that replays it and as a table of its steps.
// prints: 480 steps of 9 stages, 60 frames of 7 bodies, energy from 44\.1 J to 3\.[2-9] J
#include <delassus/delassus.hpp>
#include <delassus/io/csv.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/io/replay_page.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Stopwatch{}, Recorder{"Hit", "A ball hits five boxes."}};  // the Stopwatch first, for its times
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 5; ++i)
    rigid.add({.position = {0, 0, 0.1 + 0.2 * i}, .mass = 0.5, .shape = Box{0.2, 0.2, 0.2}});
  rigid.add({.position = {-1, 0, 0.8}, .velocity = {8, 0, 0}, .mass = 0.8, .shape = Sphere{0.1}});

  for (int i = 0; i < 480; ++i) loop.step(1.0 / 240);  // 2 s, of which every eighth step is a frame

  loop.get<Stopwatch>().print();  // ms of each stage
  const Recording& recording = loop.get<Recorder>().recording();
  write_replay_page("recording.html", "Hit", std::vector{recording});  // opens in any browser, without network
  write_csv("recording.csv", recording.steps);  // time, energy, residual, sweeps, ms of each stage
  const RecordedSteps& steps = recording.steps;
  std::printf("%zu steps of %zu stages, %zu frames of %zu bodies, energy from %.1f J to %.1f J\n", steps.time.size(),
              steps.stages.size(), recording.frames.size(), recording.bodies.size(), steps.energy.front(),
              steps.energy.back());  // thrown: 25.6 J and 18.5 J of weight; with all of them on the floor 3.2 J are left
}
