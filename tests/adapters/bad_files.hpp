/// Files of robots that are damaged or mean harm, for the tests of both readers, and what is asked of the answer.
#pragma once

#include "catch.hpp"

#include <delassus/core/expect.hpp>
#include <delassus/model/check.hpp>
#include <delassus/model/joint_space.hpp>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <tinyxml2.h>
#include <unistd.h>

namespace delassus::bad_files {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
inline constexpr bool is_sanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool is_sanitized = false;
#endif

// --- files ------------------------------------------------------------------------------------------------------------

struct File {
  std::string path, text;
};

/// Those below a folder of DELASSUS_MODELS that end so; none where that is not set.
inline std::vector<File> files_of_others(const std::string& folder, const std::string& ending) {
  std::vector<File> files;
  const char* models = std::getenv("DELASSUS_MODELS");
  if (!models) {
    WARN("DELASSUS_MODELS does not name the folder of models: they are left out");
    return files;
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(models) / folder))
    if (entry.path().extension() == ending) {
      std::ifstream in(entry.path(), std::ios::binary);
      files.push_back({entry.path().string(), std::string(std::istreambuf_iterator<char>(in), {})});
    }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.path < b.path; });
  return files;
}

/// Where numbers stand in a text: words between quotes that begin as one, and their lengths.
inline std::vector<std::pair<std::size_t, std::size_t>> numbers_of(const std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  bool in_value = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') in_value = !in_value;
    if (!in_value || std::string("\" \n").find(text[i]) == std::string::npos) continue;
    const std::size_t first = i + 1, end = std::min(text.find_first_of("\" \n", first), text.size());
    if (end > first && text.substr(first, end - first).find_first_not_of("0123456789.e-+") == std::string::npos)
      found.emplace_back(first, end - first);
  }
  return found;
}

// --- wounds -----------------------------------------------------------------------------------------------------------

using Random = std::mt19937;
inline std::size_t below(Random& random, std::size_t n) { return n == 0 ? 0 : random() % n; }

/// Wounds a text at random, one to three times: attributes are taken out, doubled, renamed and given the values of others, numbers
/// exchanged, elements taken out, doubled and moved, bytes spoiled, and the end cut off.
inline std::string mutilated(std::string text, Random& random) {
  struct Span {
    std::size_t at, size;
  };
  for (std::size_t wounds = 1 + below(random, 3); wounds > 0; --wounds) {
    std::vector<Span> attributes, values, tags, numbers;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '<') tags.push_back({i, std::min(text.find('>', i), text.size() - 1) - i + 1});
      if (text[i] != '=' || i + 1 >= text.size() || text[i + 1] != '"') continue;
      const std::size_t name = text.find_last_of(" \n\t<", i) + 1, end = std::min(text.find('"', i + 2), text.size() - 1);
      attributes.push_back({name, end - name + 1});
      values.push_back({i + 2, end - i - 2});
    }
    for (const auto& [at, size] : numbers_of(text)) numbers.push_back({at, size});
    const auto any = [&](const std::vector<Span>& of) { return of.empty() ? Span{0, 0} : of[below(random, of.size())]; };
    const auto exchange = [&](Span a, Span b) {
      if (a.at > b.at) std::swap(a, b);
      if (a.at + a.size > b.at) return;
      const std::string first = text.substr(a.at, a.size), second = text.substr(b.at, b.size);
      text.replace(b.at, b.size, first);
      text.replace(a.at, a.size, second);
    };
    const Span attribute = any(attributes), value = any(values), tag = any(tags), number = any(numbers);
    const std::size_t at = below(random, text.size());
    switch (below(random, 14)) {
      case 0: text.erase(attribute.at, attribute.size); break;
      case 1: text.insert(attribute.at, text.substr(attribute.at, attribute.size) + " "); break;
      case 2: text.insert(attribute.at, "x"); break;
      case 3: text.erase(attribute.at, 1); break;
      case 4: text.replace(value.at, value.size, ""); break;
      case 5: exchange(value, any(values)); break;
      case 6: exchange(number, any(numbers)); break;
      case 7: text.replace(number.at, number.size, std::vector<std::string>{"0", "-1", "1e10", "1e-10", "1 2"}[below(random, 5)]); break;
      case 8: text.erase(tag.at, tag.size); break;
      case 9: text.insert(any(tags).at, text.substr(tag.at, tag.size)); break;
      case 10: exchange(tag, any(tags)); break;
      case 11: text.erase(tag.at, 1); break;
      case 12: text[at] = char(below(random, 256)); break;
      default: text.resize(1 + at);
    }
    if (text.empty()) text = " ";
  }
  return text;
}

// --- answers ----------------------------------------------------------------------------------------------------------

/// Whether it begins with the file, or one beside it that it includes, and a line.
inline bool says_where(const std::string& sentence, const std::string& name) {
  const std::string start = "delassus: ";
  if (!sentence.starts_with(start)) return false;
  const std::size_t end = sentence.find(':', start.size());
  if (end == sentence.npos || end + 1 >= sentence.size() || !std::isdigit(static_cast<unsigned char>(sentence[end + 1]))) return false;
  const std::filesystem::path said = sentence.substr(start.size(), end - start.size()), file = name;
  return sentence[end + 1] != '0' && said.extension() == file.extension() && (said == file || said.parent_path() == file.parent_path());
}

/// Looks at each number of a description, whether `check` does or not.
struct NumberSearch {
  bool are_finite = true;

  void operator()(double x) { are_finite = are_finite && std::isfinite(x); }
  template <int R, int C>
  void operator()(const Mat<R, C>& x) {
    for (int k = 0; k < R * C; ++k) (*this)(x.data()[k]);
  }
  void operator()(const Pose& x) { (*this)(x.position), (*this)(x.rotation); }
  template <class T>
  void operator()(const std::vector<T>& list) {
    for (const T& x : list) (*this)(x);
  }
  template <class T, std::size_t n>
  void operator()(const std::array<T, n>& list) {
    for (const T& x : list) (*this)(x);
  }
  void all(const auto&... numbers) { ((*this)(numbers), ...); }

  void operator()(const Sphere& s) { all(s.radius); }
  void operator()(const Box& b) { all(b.x, b.y, b.z); }
  void operator()(const Capsule& c) { all(c.radius, c.height); }
  void operator()(const Cylinder& c) { all(c.radius, c.height); }
  void operator()(const Ellipsoid& e) { all(e.a, e.b, e.c); }
  void operator()(const model::Plane&) {}
  void operator()(const model::HullOf&) {}
  void operator()(const model::TrianglesOf&) {}
  void operator()(const model::FieldOf&) {}
  void operator()(const model::Joint& j) {
    all(j.point, j.axis, j.reference, j.lower, j.upper, j.damping, j.friction_loss, j.stiffness, j.spring_reference, j.armature, j.effort,
        j.speed);
  }
  void operator()(const model::Body& b) { all(b.pose, b.mass, b.centre, b.inertia, b.gravity_compensation); }
  void operator()(const model::Geometry& g) {
    std::visit(*this, g.shape);
    all(g.pose, g.friction, g.spinning_friction, g.rolling_friction, g.restitution, g.surface_velocity, g.surface_spin);
  }
  void operator()(const model::Mesh& m) { all(m.vertices); }
  void operator()(const model::HeightField& f) { all(f.half_x, f.half_y, f.base, f.heights); }
  void operator()(const model::Coupling& c) { all(c.coefficients); }
  void operator()(const model::Connect& c) { all(c.point, c.other_point); }
  void operator()(const model::Weld& w) { all(w.pose); }
  void operator()(const model::Site& s) { all(s.pose); }
  void operator()(const model::TendonJoint& j) { all(j.coefficient); }
  void operator()(const model::Tendon& t) { all(t.joints, t.lower, t.upper, t.damping, t.friction_loss, t.stiffness, t.rest_lower, t.rest_upper); }
  void operator()(const model::Actuator& a) {
    all(a.gear, a.gain, a.bias, a.time_constant, a.control_lower, a.control_upper, a.force_lower, a.force_upper);
  }
  void operator()(const model::Pair& p) { all(p.friction, p.spinning_friction, p.rolling_friction); }
  void operator()(const model::Keyframe& k) { all(k.time, k.q, k.v, k.activation, k.control); }
  void operator()(const Model& m) {
    all(m.gravity, m.time_step, m.bodies, m.joints, m.geometries, m.meshes, m.height_fields, m.couplings, m.connects, m.welds, m.sites,
        m.tendons, m.actuators, m.pairs, m.keyframes);
  }
};
/// A shape is looked at by the search that holds it.
inline bool are_finite(const Model& model) {
  NumberSearch search;
  search(model);
  return search.are_finite;
}

/// Calls read(text): a model that is sound, or a refusal with the file and a line. Says which, and the sentence.
struct Answer {
  bool is_model = false;
  Model model;
  std::string sentence;
};
template <class Read>
Answer expect_model_or_sentence(Read&& read, const std::string& text, const std::string& name) {
  Answer answer;
  const std::clock_t start = std::clock();
  try {
    answer.model = read(text, name);
    answer.is_model = true;
  } catch (const InvalidArgument& refused) {
    answer.sentence = refused.what();
  }
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC / (is_sanitized ? 10 : 1);
  CAPTURE(answer.sentence);
  CHECK(seconds < 1);
  if (answer.is_model) {
    CHECK_NOTHROW(check(answer.model));
    CHECK(are_finite(answer.model));
    for (const std::string& line : answer.model.skipped) {
      CAPTURE(line);
      CHECK(says_where("delassus: " + line, name));
    }
    // The tree can be reckoned with: a pose for each body.
    JointSpace space(answer.model);
    std::vector<double> q(std::size_t(space.q_size()));
    std::vector<Pose> poses(answer.model.bodies.size());
    space.reference(q);
    space.poses(q, poses);
    NumberSearch search;
    search.all(poses);
    CHECK(search.are_finite);
  } else {
    CHECK(says_where(answer.sentence, name));
  }
  return answer;
}

/// Each number of a text in turn becomes one that no reckoning bears: all of them, or one of them, in turns.
template <class Read>
void expect_no_number_gets_through(Read&& read, const File& file, bool is_each) {
  const char* odd[] = {"nan", "inf", "-inf", "1e308", "-1e308", "1e-320"};
  std::size_t turn = 0;
  for (const auto& [at, size] : numbers_of(file.text)) {
    ++turn;
    for (std::size_t k = 0; k < std::size(odd); ++k) {
      if (!is_each && k != turn % std::size(odd)) continue;
      std::string text = file.text;
      text.replace(at, size, odd[k]);
      CAPTURE(file.path, odd[k], file.text.substr(at > 30 ? at - 30 : 0, 60));
      expect_model_or_sentence(read, text, file.path);
    }
  }
}

/// How many of what is below an element are texts, as an element that lost its `<`.
inline std::size_t texts_below(const tinyxml2::XMLElement& in) {
  std::size_t count = 0;
  for (const tinyxml2::XMLNode* node = in.FirstChild(); node; node = node->NextSibling()) {
    count += node->ToText() || node->ToUnknown();
    if (node->ToElement()) count += texts_below(*node->ToElement());
  }
  return count;
}
/// How many sentences of what was passed over have these words.
inline std::size_t skipped_for(const Model& model, const std::string& words) {
  return std::size_t(std::count_if(model.skipped.begin(), model.skipped.end(), [&](const std::string& s) { return s.find(words) != s.npos; }));
}

// --- what a file costs ------------------------------------------------------------------------------------------------

/// What some work came to in a process of its own.
struct Cost {
  bool ended = false;  ///< not by a signal
  std::string says;    ///< of what it threw; empty where it threw nothing
  double seconds = 0;  ///< of the processor
  double megabytes = 0;  ///< most that was in memory, less what the tests had there before
};

/// Of this process, in memory now.
inline double resident_megabytes() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return double(resident) * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

template <class Work>
Cost cost_of(Work&& work) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const double before = resident_megabytes();
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::string says;
    try {
      work();
    } catch (const std::exception& thrown) {
      says = thrown.what();
    }
    says.resize(std::min<std::size_t>(says.size(), 1000));
    const bool is_written = ::write(ends[1], says.data(), says.size()) == ssize_t(says.size());
    ::_exit(is_written ? 0 : 1);
  }
  ::close(ends[1]);
  Cost cost;
  char buffer[2000];
  for (ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) cost.says.append(buffer, std::size_t(n));
  ::close(ends[0]);
  int status = 0;
  rusage use{};
  REQUIRE(::wait4(child, &status, 0, &use) == child);
  cost.ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  cost.seconds = (double(use.ru_utime.tv_sec + use.ru_stime.tv_sec) + 1e-6 * double(use.ru_utime.tv_usec + use.ru_stime.tv_usec)) /
                 (is_sanitized ? 10 : 1);
  cost.megabytes = is_sanitized ? 0 : double(use.ru_maxrss) * 1024 / 1e6 - before;
  return cost;
}

/// A text that is refused in that sentence, with the file and a line, within a second and 200 MB.
template <class Read>
void expect_refused_soon(Read&& read, const std::string& text, const std::string& name, const std::string& sentence) {
  const Cost cost = cost_of([&] { read(text, name); });
  CAPTURE(cost.says, cost.seconds, cost.megabytes);
  CHECK(cost.ended);
  CHECK(says_where(cost.says, name));
  CHECK_THAT(cost.says, Catch::Matchers::Contains(sentence));
  CHECK(cost.seconds < 1);
  CHECK(cost.megabytes < 200);
}

}  // namespace delassus::bad_files
