/// Runs named loops and compares them with what the code did that wrote the data: see README.md.
#pragma once

#include <delassus/core/status.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "state.hpp"

namespace trace {

inline constexpr int steps = 200;
/// The steps of which data are kept: the hash of all up to there, the state before and the result after.
inline constexpr int stored[] = {1, 2, 5, 10, 20, 50, 100, 200};

/// What a step ends with.
struct Outcome {
  std::vector<double> x, v, lambda, heard;  ///< x: a point of each body; heard: what is looked at besides
  int sweeps = 0, status = 0;

  void walk(Text& text) {
    text.line("after"), text(status), text(sweeps);
    for (const auto& [name, list] : {std::pair{"x", &x}, {"v", &v}, {"lambda", &lambda}, {"heard", &heard}}) {
      text.line(name), text.size(*list);
      for (double& number : *list) text(number);
    }
  }
};

/// A combination of parts that runs: a loop, or a problem that is solved again and again.
class Run {
 public:
  virtual ~Run() = default;
  /// What the host does before step n = 1, 2, …
  virtual void act(int n) = 0;
  virtual void step(int n) = 0;
  virtual void walk(Text& state, Text& pairs) = 0;
  virtual void hash(Hash& hash) const = 0;
  virtual Outcome outcome() const = 0;
};

struct Options {
  double h = 1.0 / 60;       ///< s
  double change = 0;         ///< h of step n is h (1 + change (n mod 3))
  double tolerance = 1e-10;  ///< of x, v and λ, by their largest entry in all stored steps
  /// Rows depend on each other: λ is not unique, and v, which is what W λ does, speaks for it.
  bool is_redundant = false;
  /// What of the memory no text holds; the forced steps then are those of a loop without it, in the data too.
  const char* forgets = "";
};

template <class Loop, class Act, class Look>
class LoopRun : public Run {
 public:
  LoopRun(Loop loop, Act act, Look look, const Options& options)
      : loop_(std::move(loop)), act_(act), look_(look), options_(options) {}

  void act(int n) override { act_(loop_, n); }
  void step(int n) override { loop_.step(options_.h * (1 + options_.change * (n % 3))); }
  void walk(Text& state, Text& pairs) override { walk_state(loop_, state, pairs); }
  void hash(Hash& hash) const override {
    each_result(loop_, [&](const auto& m) { hash.matrix(m); });
    look_(loop_, [&](double x) { hash.bytes(&x, sizeof x); });
  }
  Outcome outcome() const override {
    Outcome out{.sweeps = loop_.report().sweeps, .status = int(loop_.report().status)};
    const auto to = [](std::vector<double>& list) {
      return [&list](const auto& m) {
        for (Index k = 0; k < Index(m.size()); ++k) list.push_back(double(m.data()[k]));
      };
    };
    each_place(loop_, to(out.x));
    each_velocity(loop_, to(out.v));
    each_impulse(loop_, to(out.lambda));
    look_(loop_, [&](double x) { out.heard.push_back(x); });
    return out;
  }

 private:
  Loop loop_;
  Act act_;
  Look look_;
  Options options_;
};

/// No host, nobody who looks.
struct Nobody {
  void operator()(auto&&...) const {}
};

class Trace {
 public:
  /// `name` is that of the program and of its file of data.
  explicit Trace(std::string name) : name_(std::move(name)) {}

  /// `make()` returns a loop with its scene; `act(loop, n)` is what the host does before step n. Of a fresh
  /// loop that goes on at step n all acts before are called one after the other, without steps. `look(loop,
  /// f)` calls f(number) for what else a step ends with, as what a listener heard.
  template <class Make, class Act = Nobody, class Look = Nobody>
  void add(std::string name, Options options, Make make, Act act = {}, Look look = {}) {
    using Loop = std::invoke_result_t<Make>;
    add_run(std::move(name), options, [=] {
      return std::unique_ptr<Run>(std::make_unique<LoopRun<Loop, Act, Look>>(make(), act, look, options));
    });
  }
  void add_run(std::string name, Options options, std::function<std::unique_ptr<Run>()> make) {
    all_.push_back({std::move(name), options, std::move(make)});
  }

  int main(int argc, char** argv);

 private:
  struct Combination {
    std::string name;
    Options options;
    std::function<std::unique_ptr<Run>()> make;
  };
  /// Of a stored step: the state before, as lines, without or with what collision keeps; the result after.
  struct Moment {
    std::string state, pairs;
    Outcome after;
  };
  struct Record {
    std::vector<std::uint64_t> hashes;  ///< up to each of the stored steps
    std::map<int, Moment> moments;
  };
  struct Found {
    bool has_same_bits = true, is_within = true;
    std::string line;
  };

  Record write(const Combination& c);
  static Found compare(const Combination& c, const Record& then, bool free, bool forced);
  static std::vector<std::uint64_t> run_free(Run& run);
  static std::unique_ptr<Run> forced(const Combination& c, int n, const Moment& from);
  static std::map<std::string, Record> read(const std::string& path);
  static void save(std::ostream& file, const std::string& name, Record& record);

  std::string name_;
  std::vector<Combination> all_;
  bool is_sound_ = true;
};

inline std::vector<std::uint64_t> Trace::run_free(Run& run) {
  std::vector<std::uint64_t> hashes;
  Hash hash;
  for (int n = 1; n <= steps; ++n) {
    run.act(n);
    run.step(n);
    run.hash(hash);
    if (std::count(std::begin(stored), std::end(stored), n)) hashes.push_back(hash.value);
  }
  return hashes;
}

/// A fresh run after step n from the state before it.
inline std::unique_ptr<Run> Trace::forced(const Combination& c, int n, const Moment& from) {
  auto run = c.make();
  for (int k = 1; k < n; ++k) run->act(k);
  if (from.state != "fresh") {
    Text state(from.state), pairs(from.pairs);
    run->walk(state, pairs);
    if (!state.is_at_end() || !pairs.is_at_end())
      throw std::runtime_error("the data say more than the state takes");
  }
  run->act(n);
  run->step(n);
  return run;
}

inline std::uint64_t hash_of(const Run& run) {
  Hash hash;
  run.hash(hash);
  return hash.value;
}

/// The largest |a − b| by `scale`; infinite where they are not of one size or one is not finite.
inline double difference(const std::vector<double>& a, const std::vector<double>& b, double scale) {
  if (a.size() != b.size()) return INFINITY;
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!std::isfinite(a[k]) || !std::isfinite(b[k])) return INFINITY;
    most = std::max(most, std::abs(a[k] - b[k]));
  }
  return most == 0 ? 0 : most / scale;
}
inline double largest(const std::vector<double>& list) {
  double most = 0;
  for (const double x : list) most = std::max(most, std::abs(x));
  return most;
}

/// Runs freely, and tries each state that is kept: a fresh loop with it must make the step that follows to
/// the bit.
inline Trace::Record Trace::write(const Combination& c) {
  Record record;
  auto run = c.make();
  Hash hash;
  for (int n = 1; n <= steps; ++n) {
    const bool is_stored = std::count(std::begin(stored), std::end(stored), n) > 0;
    Moment whole;
    if (is_stored) {
      Text state, pairs, fresh, fresh_pairs;
      run->walk(state, pairs);
      auto other = c.make();
      for (int k = 1; k < n; ++k) other->act(k);
      other->walk(fresh, fresh_pairs);
      whole = {state.words(), pairs.words(), {}};
      if (state.words() == fresh.words() && pairs.words() == fresh_pairs.words()) whole = {"fresh", "", {}};
    }
    run->act(n);
    run->step(n);
    run->hash(hash);
    if (!is_stored) continue;
    record.hashes.push_back(hash.value);
    // What collision keeps is left out where the step is the same without it.
    Moment least = whole;
    least.pairs.clear();
    auto again = forced(c, n, least);
    if (hash_of(*again) != hash_of(*run)) again = forced(c, n, least = whole);
    if (hash_of(*again) != hash_of(*run)) {
      const bool is_known = *c.options.forgets != '\0';
      const Outcome here = again->outcome(), there = run->outcome();
      std::printf("%s: step %d from its state is not the step of the run, v %.1e apart: %s\n", c.name.c_str(),
                  n, difference(here.v, there.v, largest(there.v)),
                  is_known ? c.options.forgets : "some memory is missing");
      is_sound_ = is_sound_ && is_known;
    }
    least.after = again->outcome();
    record.moments[n] = least;
  }
  return record;
}

inline Trace::Found Trace::compare(const Combination& c, const Record& then, bool free, bool is_forced) {
  Found found;
  char text[200];
  if (free) {
    const auto run = c.make();
    const std::vector<std::uint64_t> now = run_free(*run);
    std::size_t k = 0;
    while (k < now.size() && k < then.hashes.size() && now[k] == then.hashes[k]) ++k;
    found.has_same_bits = k == std::size(stored);
    if (found.has_same_bits)
      std::snprintf(text, sizeof text, "  free: same bits");
    else
      std::snprintf(text, sizeof text, "  free: differs from step <= %d", stored[k]);
    found.line += text;
  }
  if (is_forced) {
    double x = 0, v = 0, lambda = 0, x_scale = 0, v_scale = 0, lambda_scale = 0;
    int sweeps = 0, worst = 0;
    for (const auto& [n, moment] : then.moments) {
      x_scale = std::max(x_scale, largest(moment.after.x));
      v_scale = std::max(v_scale, largest(moment.after.v));
      lambda_scale = std::max(lambda_scale, largest(moment.after.lambda));
    }
    const char *status = "same status", *status_now = "", *listeners = "";
    for (const auto& [n, moment] : then.moments) {
      const Outcome now = forced(c, n, moment)->outcome();
      const Outcome& before = moment.after;
      const double dx = difference(now.x, before.x, x_scale), dv = difference(now.v, before.v, v_scale),
                   dl = difference(now.lambda, before.lambda, lambda_scale);
      const int more = std::abs(now.sweeps - before.sweeps);
      x = std::max(x, dx), v = std::max(v, dv), lambda = std::max(lambda, dl),
      sweeps = std::max(sweeps, more);
      if (now.status != before.status)
        status = "another status:", status_now = delassus::name(Status(now.status));
      double heard = now.heard.size() == before.heard.size() ? 0 : INFINITY;
      for (std::size_t k = 0; k < now.heard.size() && heard < INFINITY; ++k)
        heard = std::max(heard, difference({now.heard[k]}, {before.heard[k]}, std::abs(before.heard[k])));
      if (heard > c.options.tolerance) listeners = ", heard something else";
      const bool is_within = std::max({dx, dv, heard}) <= c.options.tolerance &&
                             (c.options.is_redundant || dl <= c.options.tolerance) &&
                             more <= std::max(2.0, 0.1 * before.sweeps) && now.status == before.status;
      if (!is_within && worst == 0) worst = n;
      found.is_within = found.is_within && is_within;
    }
    std::snprintf(text, sizeof text, "  forced: x %.1e, v %.1e, lambda %.1e%s, sweeps %d, %s%s", x, v, lambda,
                  c.options.is_redundant ? " (not unique)" : "", sweeps, status, status_now);
    found.line += text;
    found.line += listeners;
    if (worst > 0) found.line += "  WRONG from step " + std::to_string(worst);
    if (then.moments.size() != std::size(stored)) found.is_within = false, found.line += "  WRONG: no data";
  }
  return found;
}

inline void Trace::save(std::ostream& file, const std::string& name, Record& record) {
  file << "= " << name << "\nfree";
  for (const std::uint64_t h : record.hashes) {
    char digits[20];
    std::snprintf(digits, sizeof digits, " %016llx", static_cast<unsigned long long>(h));
    file << digits;
  }
  file << '\n';
  for (auto& [n, moment] : record.moments) {
    Text after;
    moment.after.walk(after);
    file << "step " << n << '\n' << moment.state << '\n';
    if (!moment.pairs.empty()) file << moment.pairs << '\n';
    file << after.words() << '\n';
  }
}

inline std::map<std::string, Trace::Record> Trace::read(const std::string& path) {
  std::map<std::string, Record> all;
  std::ifstream file(path);
  Record* record = nullptr;
  Moment* moment = nullptr;
  std::string line, after;
  const auto begins = [&](const char* word) { return line.rfind(word, 0) == 0; };
  const auto add = [&](std::string& to) { to += (to.empty() ? "" : "\n") + line; };
  const auto end_moment = [&] {
    if (moment == nullptr) return;
    Text text(std::exchange(after, {}));
    std::exchange(moment, nullptr)->after.walk(text);
  };
  while (std::getline(file, line)) {
    if (begins("= ")) {
      end_moment();
      record = &all[line.substr(2)];
    } else if (begins("free")) {
      std::istringstream words(line.substr(4));
      for (std::string w; words >> w;) record->hashes.push_back(std::strtoull(w.c_str(), nullptr, 16));
    } else if (begins("step ")) {
      end_moment();
      moment = &record->moments[std::atoi(line.c_str() + 5)];
    } else if (moment != nullptr) {
      if (!after.empty() || begins("after"))
        add(after);
      else if (!moment->pairs.empty() || begins("pairs"))
        add(moment->pairs);
      else
        add(moment->state);
    }
  }
  end_moment();
  return all;
}

inline int Trace::main(int argc, char** argv) {
  std::string here = __FILE__, folder = here.substr(0, here.rfind('/') + 1) + "data";
  bool writes = false, free = false, forced = false, bits = false;
  std::vector<std::string> names;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if ((word == "--write" || word == "--data") && k + 1 < argc)
      writes = word == "--write", folder = argv[++k];
    else if (word == "--free")
      free = true;
    else if (word == "--forced")
      forced = true;
    else if (word == "--bits")
      bits = true;
    else if (word[0] != '-')
      names.push_back(word);
    else
      return std::printf("trace_%s [--write DIR | --data DIR] [--free | --forced] [--bits] [NAME ...]\n",
                         name_.c_str()),
             2;
  }
  if (!free && !forced) free = forced = true;
  const std::string path = folder + "/" + name_ + ".txt";
  std::map<std::string, Record> data;
  try {
    if (!writes || !names.empty()) data = read(path);
  } catch (const std::exception& e) {
    return std::printf("%s: %s\n", path.c_str(), e.what()), 1;
  }
  int same = 0, within = 0, wrong = 0;
  for (const Combination& c : all_) {
    if (!names.empty() && !std::count(names.begin(), names.end(), c.name)) continue;
    try {
      if (writes) data[c.name] = write(c);
      const Found found = compare(c, data[c.name], free, forced);
      std::printf("%-34s%s%s%s\n", c.name.c_str(), found.line.c_str(), *c.options.forgets ? "  without " : "",
                  c.options.forgets);
      ++(!found.is_within || (!forced && !found.has_same_bits) || (bits && !found.has_same_bits) ? wrong
         : found.has_same_bits                                                                   ? same
                                                                                                 : within);
    } catch (const std::exception& e) {
      std::printf("%-34s  WRONG: %s\n", c.name.c_str(), e.what());
      ++wrong;
    }
  }
  if (writes) {
    std::ofstream file(path);
    for (const Combination& c : all_)
      if (data.count(c.name)) save(file, c.name, data[c.name]);
    if (!file.flush()) return std::printf("cannot write %s\n", path.c_str()), 1;
  }
  std::printf("%d combinations: %d same bits, %d within 1e-10, %d wrong\n", same + within + wrong, same,
              within, wrong);
  return wrong > 0 || !is_sound_ ? 1 : 0;
}

}  // namespace trace
