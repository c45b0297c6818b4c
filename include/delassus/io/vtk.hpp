/// Writes running loops and recordings for VTK: a .vtp each picture, and a .pvd that says when.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/io/inner/drawn_scene.hpp>
#include <delassus/io/inner/vtk_polydata.hpp>
#include <delassus/io/recording.hpp>
#include <delassus/step/stage.hpp>

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Pictures one after the other: `add` writes `path`_vtk/000000.vtp and so on, and `path`.pvd names them with their times, whole after
/// each. ParaView opens the .pvd. What stood there before is written over.
///
/// A .vtp has the surfaces of bodies as polygons, joints and edges as lines, contacts as points. `body` of a cell is the place of its body
/// in the list, −1 of other cells. `normal` (unit, from A to B) and `impulse` (N·s, on B) of a point are zero but at contacts. Numbers
/// are single precision; half-spaces are squares a few times as wide as the scene.
class VtkSeries {
 public:
  /// Makes the folder. Refuses where nothing can be written.
  explicit VtkSeries(std::string path) : path_(std::move(path)), folder_(std::filesystem::path(path_).filename().string() + "_vtk") {
    std::error_code failed;
    std::filesystem::create_directories(path_ + "_vtk", failed);
    DELASSUS_EXPECT(!failed, "cannot make the folder '" + path_ + "_vtk': " + failed.message());
    inner::write_file(path_ + ".pvd", head() + tail());
  }

  /// Refuses a frame that has not one pose a body, and a full disk.
  void add(std::span<const RecordedBody> bodies, const RecordedFrame& frame) {
    DELASSUS_EXPECT(frame.poses.size() == bodies.size(), "VtkSeries: " + std::to_string(frame.poses.size()) + " poses for " + std::to_string(bodies.size()) + " bodies");
    std::string number = std::to_string(count_++);
    number.insert(0, number.size() < 6 ? 6 - number.size() : 0, '0');
    inner::write_file(path_ + "_vtk/" + number + ".vtp", inner::vtp_text(bodies, frame));
    list("<DataSet timestep=\"" + inner::number_text(frame.time, 17) + "\" part=\"0\" file=\"" + inner::html(folder_) + "/" + number + ".vtp\"/>\n");
  }
  long count() const { return count_; }  ///< of pictures so far

 private:
  static std::string head() { return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n"; }
  static std::string tail() { return "</Collection>\n</VTKFile>\n"; }

  /// A line more, in the place of the tail.
  void list(const std::string& line) {
    const std::string path = path_ + ".pvd", text = line + tail();
    std::FILE* file = std::fopen(path.c_str(), "r+b");
    DELASSUS_EXPECT(file != nullptr, "cannot open '" + path + "' for writing; was it taken away?");
    const bool is_there = std::fseek(file, -long(tail().size()), SEEK_END) == 0;
    const bool is_written = is_there && std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool is_closed = std::fclose(file) == 0;
    DELASSUS_EXPECT(is_written && is_closed, "cannot write all of '" + path + "'; is the disk full?");
  }

  std::string path_, folder_;
  long count_ = 0;
};

/// Of a recording that is there already.
inline void write_vtk(const std::string& path, const Recording& recording) {
  inner::check_recording(recording);
  VtkSeries series(path);
  for (const RecordedFrame& frame : recording.frames) series.add(recording.bodies, frame);
}

/// Writes a running loop as `VtkSeries` does: list `VtkRecorder{"out/fall"}` in the loop. Bodies are those of the first step.
class VtkRecorder {
 public:
  using plays = role::Listener;
  using listens = Listens<stage::Step>;

  VtkRecorder() = default;
  /// At most so many pictures a simulated second; 0: one a step.
  explicit VtkRecorder(std::string path, double frames_per_second = 0) : path_(std::move(path)), rate_(frames_per_second) {}

  void check() const {
    DELASSUS_EXPECT(!path_.empty(), "VtkRecorder: it has no path; write VtkRecorder{\"out/name\"}");
    inner::expect_not_negative("VtkRecorder: frames_per_second", rate_, "1/s");
  }
  void after(stage::Step, const auto& loop) {
    if (series_.empty()) begin(loop);
    VtkSeries& series = series_.front();
    if (rate_ > 0 && series.count() > 0 && (loop.time() - first_) * rate_ <= double(series.count()) - 1e-6) return;
    series.add(bodies_, scene_.frame(loop));
  }

 private:
  void begin(const auto& loop) {
    scene_.begin(loop, bodies_);
    first_ = loop.time();
    series_.emplace_back(path_);
  }

  std::string path_;
  double rate_ = 0, first_ = 0;
  inner::DrawnScene scene_;
  std::vector<RecordedBody> bodies_;
  std::vector<VtkSeries> series_;  ///< one, from the first step on
};

}  // namespace delassus
