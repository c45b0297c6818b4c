// What of a rung counts when engines are compared, and how it is written down.
#include "referee.hpp"

#include <sys/time.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace ladders::peers {

namespace {

/// The marks that poses and velocities give, whoever made them. What is not named here is of one engine alone
/// (its impulses, its work, what it says of itself) and counts for nobody, nor do numbers that are inputs.
constexpr std::string_view counted[] = {
    "angular momentum",
    "centre below the ground (m)",
    "change (m)",
    "change / size",
    "change of angular momentum",
    "change of the motion (m)",
    "creep (m/s)",
    "creep of the top after 1 s (m)",
    "dominoes that stand",
    "drift of the top (m)",
    "drop of the crown / radius, or what is missing of a fall",
    "drop of the top (m)",
    "drop of the top / height of a box",
    "energy gained",
    "energy gained / energy of the scene",
    "energy lost",
    "energy lost / energy of the scene",
    "hop / size",
    "joint gap (m)",
    "joint gap (m, rad)",
    "joint gap / link",
    "joint gap / size",
    "joint gap / spacing",
    "kinetic energy (J)",
    "largest overlap / diameter",
    "largest overlap at the end / diameter",
    "largest overlap of the run / diameter",
    "mean overlap / diameter",
    "momentum",
    "off the middle / excess",
    "out of order",
    "overlap after 4 s (m)",
    "penetration / size",
    "penetration after 2 s / size",
    "rms speed at the end (m/s)",
    "speed (m/s)",
    "speed / free fall of its length",
    "speed after 10 s (m/s)",
    "speed at the end (m/s)",
    "speed lost",
    "speed of the middle one (m/s)",
    "through the plate, of 4",
    "turn and drift (1/s)",
    "wave at h against h/4",
    "way a second (m/s)",
};

bool counts(const Mark& mark) {
  return std::find(std::begin(counted), std::end(counted), mark.what) != std::end(counted);
}

std::string clean(std::string text) {
  for (char& c : text)
    if (c == '\t' || c == '\n') c = ' ';
  return text;
}

}  // namespace

const char* why_not(const Row& row) {
  struct Why {
    std::string_view id, title;
    const char* reason;
  };
  constexpr Why list[] = {
      {"HC-05", "", "takes a body away from warm contacts, which an engine that is built anew has not"},
      {"HC-06", "", "needs particles"},
      {"HC-07", "step size", "one of its rungs steps its loop itself"},
      {"HC-14", "", "asks what is refused"},
      {"HC-15", "far from the origin, single", "is about single precision, in which no other engine here runs"},
      {"HC-19", "", "needs a deformable"},
      {"HC-20", "", "needs a deformable"},
      {"HC-23", "", "its figure is a contact's impulse"},
      {"HC-30", "hopper", "puts grains back on top while it runs"},
      {"HC-30", "angle", "pours its grains while it runs"},
      {"HC-30", "silo", "pours its grains while it runs"},
      {"HC-31", "overhand", "the description has no word for neighbours that pass through each other"},
      {"HC-31", "", "needs particles"},
      {"HC-40", "", "needs a deformable"},
      {"HC-41", "long spin", "10⁷ steps of one loop"},
  };
  for (const Why& why : list)
    if (row.id == why.id && std::string_view(row.title).starts_with(why.title)) return why.reason;
  return nullptr;
}

std::string line_of(const Outcome& outcome) {
  std::ostringstream out;
  out.precision(17);
  out << clean(outcome.difficulty) << '\t' << clean(outcome.said) << '\t' << int(outcome.level) << '\t'
      << outcome.is_refused << '\t' << outcome.microseconds;
  for (const auto& f : outcome.figures)
    out << '\t' << f.what << '\t' << f.value << '\t' << f.silver << '\t' << f.gold << '\t' << int(f.level);
  return out.str();
}

Outcome outcome_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream in(line);
  for (std::string word; std::getline(in, word, '\t');) words.push_back(word);
  words.resize(std::max<std::size_t>(words.size(), 5));
  const auto number = [&](std::size_t k) { return std::strtod(words[k].c_str(), nullptr); };
  const auto level = [&](std::size_t k) { return Level(int(number(k))); };
  Outcome out{.difficulty = words[0],
              .said = words[1],
              .level = level(2),
              .is_refused = number(3) != 0,
              .microseconds = number(4)};
  for (std::size_t k = 5; k + 4 < words.size(); k += 5)
    out.figures.push_back({words[k], number(k + 1), number(k + 2), number(k + 3), level(k + 4)});
  return out;
}

void Referee::begin(const std::string& difficulty) {
  worst_ = {};
  spent_ = 0;
  has_marks_ = true;
  steps_.clear();
  std::fprintf(out_, "begin\t%s\n", clean(difficulty).c_str());
  std::fflush(out_);
  // What hangs within a step is ended by a signal; measuring takes its time too.
  const itimerval limit{{}, {.tv_sec = long(20 * max_seconds_ + 60), .tv_usec = 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

std::unique_ptr<Engine> Referee::engine(const Scene& scene, double h) {
  return kind_ ? kind_->make(scene, h) : nullptr;
}

void Referee::note(double seconds, const Reading& reading) {
  steps_.push_back(seconds);
  spent_ += seconds;
  worst_.penetration = std::max(worst_.penetration, reading.penetration);
  worst_.joint_gap = std::max(worst_.joint_gap, reading.joint_gap);
  worst_.growth = std::max(worst_.growth, reading.growth);
  worst_.speed = reading.speed;
  if (spent_ > max_seconds_)
    throw std::runtime_error("not done in " + std::to_string(int(max_seconds_)) + " s of the processor");
}

/// Every rung says the gauge's own figures too, without limits.
void Referee::judge(Marks& marks) {
  std::erase_if(marks, [](const Mark& mark) { return !counts(mark); });
  has_marks_ = !marks.empty() && !steps_.empty();
  if (!has_marks_) throw Unsayable("none of its marks is of poses and velocities");
  marks.push_back({"gauge: deepest overlap (m)", worst_.penetration, unbounded, unbounded});
  marks.push_back({"gauge: joint gap (m or rad)", worst_.joint_gap, unbounded, unbounded});
  marks.push_back({"gauge: growth of overlaps and gaps (m/s)", worst_.growth, unbounded, unbounded});
  marks.push_back({"gauge: speed at the end (m/s)", worst_.speed, unbounded, unbounded});
}

bool Referee::end(const Rung& rung) {
  Outcome outcome{.difficulty = rung.difficulty,
                  .said = rung.trouble,
                  .level = rung.level,
                  .is_refused = !rung.trouble.empty() && (steps_.empty() || !has_marks_)};
  for (const Mark& mark : rung.marks)
    outcome.figures.push_back({mark.what, mark.value, mark.silver, mark.gold, mark.level()});
  if (!steps_.empty()) {
    const auto middle = steps_.begin() + std::ptrdiff_t(steps_.size() / 2);
    std::nth_element(steps_.begin(), middle, steps_.end());
    outcome.microseconds = 1e6 * *middle;
  }
  std::fprintf(out_, "end\t%s\n", line_of(outcome).c_str());
  std::fflush(out_);
  return rung.level != Level::failed;
}

}  // namespace ladders::peers
