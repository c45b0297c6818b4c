/// Draws what a study found: error against time, one mark a run.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/study/inner/log_axis.hpp>
#include <delassus/study/inner/svg.hpp>
#include <delassus/study/study.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace delassus {

/// What it shows.
struct DiagramOptions {
  int measure = 0;  ///< place among those of the study
  double budget = 0;     ///< drawn, with the cheapest run that holds it, where > 0
  int colour_axis = -1;  ///< axis of the combinations that colours tell apart; -1: the first with a choice
  int marker_axis = -1;  ///< and the one that marks tell apart; -1: the next
  bool joins_steps = false;  ///< a curve through the steps of each combination and tolerance, in place of the best
};

namespace inner {

/// The colours are those of Okabe and Ito, which people who do not tell red from green apart do tell apart;
/// on a dark page the same hues, lighter.
inline constexpr std::string_view diagram_style = R"css(
svg{font:13px system-ui,sans-serif;background:#fff}
text{fill:#1f2328}.small{font-size:12px;fill:#59636e}.title{font-size:18px;font-weight:600}.code{font:12px ui-monospace,monospace}
.halo{paint-order:stroke;stroke:#fff;stroke-width:4px}.page{fill:#fff}.grid{stroke:#e3e7eb}.frame{fill:none;stroke:#8c959f}.band{fill:#8c959f;fill-opacity:.16}
.run{fill-opacity:.75;stroke-width:1.6}.hollow{fill-opacity:0}.dim{opacity:.45}
.c0{fill:#0072b2;stroke:#0072b2}.c1{fill:#d55e00;stroke:#d55e00}.c2{fill:#009e73;stroke:#009e73}
.c3{fill:#cc79a7;stroke:#cc79a7}.c4{fill:#b8860b;stroke:#b8860b}.c5{fill:#56b4e9;stroke:#56b4e9}.ink{fill:#59636e;stroke:#59636e}
.front{fill:none;stroke:#1f2328;stroke-width:1.5}.budget{stroke:#1f2328;stroke-width:1.5;stroke-dasharray:7 5}
.kept{stroke-dasharray:9 4 2 4}
polyline.curve{fill:none;stroke-width:1.5}.chosen{fill:none;stroke:#1f2328;stroke-width:2.5}.cross{fill:none;stroke-width:1.8}
@media(prefers-color-scheme:dark){svg{background:#0d1117}text{fill:#e6edf3}.small{fill:#9198a1}.halo{stroke:#0d1117}.page{fill:#0d1117}.grid{stroke:#262c36}
.c0{fill:#58a6ff;stroke:#58a6ff}.c1{fill:#ff8f45;stroke:#ff8f45}.c2{fill:#2fd0a0;stroke:#2fd0a0}.c3{fill:#eba3cb;stroke:#eba3cb}
.c4{fill:#e3b341;stroke:#e3b341}.c5{fill:#9ad8ff;stroke:#9ad8ff}.ink{fill:#9198a1;stroke:#9198a1}
.front,.budget,.chosen{stroke:#e6edf3}}
)css";

/// One diagram while it is drawn.
class Diagram {
 public:
  Diagram(const Study& study, const DiagramOptions& options)
      : study_(study), options_(options), m_(std::size_t(options.measure)) {
    DELASSUS_EXPECT(
        options.measure >= 0 && m_ < study.measures.size(),
        "diagram of '" + study.plan.name + "': there is no measure " + std::to_string(options.measure));
    for (int a = 0; a < int(study.axes.size()); ++a)
      if (study.axes[std::size_t(a)].size() > 1) {
        if (options_.colour_axis < 0)
          options_.colour_axis = a;
        else if (options_.marker_axis < 0 && a != options_.colour_axis)
          options_.marker_axis = a;
      }
    chosen_ = options.budget > 0 ? study.cheapest(options.measure, options.budget) : nullptr;
    const auto controlled = std::count_if(study.runs.begin(), study.runs.end(), [](const StudyRun& run) { return run.is_controlled(); });
    has_both_ = controlled > 0 && std::size_t(controlled) < study.runs.size();
    find_ranges();
  }

  std::string text() {
    const StudyMeasure& measure = study_.measures[m_];
    svg_.rectangle(0, 0, width, height, "page");
    svg_.text(left, 30, study_.plan.name + ": what accuracy costs", "title");
    svg_.text(left, 50,
              "Each mark is one run of " + inner::text(study_.plan.duration) +
                  " s. Lower is more accurate, further left is cheaper. " +
                  (options_.joins_steps ? "Lines join the steps of one choice." : "The line joins the best."),
              "small");
    if (!options_.joins_steps && has_both_) svg_.text(left, 68, "Solid: the best of fixed steps. Dashed: the best that keep an accuracy.", "small");
    draw_axes(measure);
    if (measure.uncertainty > 0) draw_uncertainty(measure.uncertainty);
    if (options_.budget > 0) draw_budget(measure);
    if (options_.joins_steps) draw_curves();
    draw_runs();
    if (!options_.joins_steps) draw_front();
    if (measure.uncertainty > 0)
      svg_.text(right - 8, bottom - 7, "errors in here are not believed: the reference is not this sure",
                "small halo", "end");
    draw_legend();
    draw_choice(measure);
    return svg_.text_of(study_.plan.name + ": error in " + measure.name + " against processor time",
                        "A log-log diagram of " + std::to_string(study_.runs.size()) + " runs.",
                        diagram_style);
  }

 private:
  static constexpr double width = 960, height = 664, left = 100, top = 92, plot_width = 590,
                          plot_height = 430;
  static constexpr double bottom = top + plot_height, right = left + plot_width;

  double seconds(const StudyRun& run) const { return run.cost / study_.plan.duration; }
  double error(const StudyRun& run) const { return run.errors[m_]; }

  void find_ranges() {
    double least = 1e300, most = 0, fast = 1e300, slow = 0;
    const auto take_error = [&](double e) {
      if (!(e > 0) || !std::isfinite(e)) return;
      least = std::min(least, e), most = std::max(most, e);
    };
    for (const StudyRun& run : study_.runs) {
      if (run.is_usable()) take_error(error(run));
      if (seconds(run) > 0) fast = std::min(fast, seconds(run)), slow = std::max(slow, seconds(run));
    }
    take_error(options_.budget);
    const double u = study_.measures[m_].uncertainty;
    if (u > 0) take_error(u / 3);  // a strip of the band at least
    if (!(most > 0)) least = most = 1;
    if (!(slow > 0)) fast = slow = 1;
    // Beyond twelve decades the rest is rounding: it lies on the edge.
    y_ = LogAxis{std::max(least, 1e-12 * most), most, bottom, top};
    x_ = LogAxis{fast, slow, left, right};
  }

  void draw_axes(const StudyMeasure& measure) {
    for (const double value : x_.decades()) {
      const double x = x_.at(value);
      svg_.line(x, top, x, bottom, "grid");
      svg_.text(x, bottom + 20, with_prefix(value, "s"), "", "middle");
    }
    for (const double value : y_.decades()) {
      const double y = y_.at(value);
      svg_.line(left, y, right, y, "grid");
      svg_.text(left - 8, y + 4, with_prefix(value, measure.unit), "", "end");
    }
    svg_.rectangle(left, top, plot_width, plot_height, "frame");
    svg_.text(left + plot_width / 2, bottom + 42, "processor time per simulated second", "", "middle");
    svg_.text(22, top + plot_height / 2, "error: " + measure.name, "", "middle", -90);
  }

  void draw_uncertainty(double u) {
    const double y = y_.at(u);
    svg_.rectangle(left, y, plot_width, bottom - y, "band");
  }

  void draw_budget(const StudyMeasure& measure) {
    const double y = y_.at(options_.budget);
    svg_.line(left, y, right, y, "budget");
    svg_.text(right + 8, y + 4, "budget " + with_prefix(options_.budget, measure.unit));
  }

  std::string hint(const StudyRun& run) const {
    std::string text = run.code + "\n" + (run.is_controlled() ? std::to_string(run.inner_steps) + " steps, " + std::to_string(run.repeated) + " repeated, "
                                                              : "step " + step_text(run.h) + " s, ") +
                       name(run.outcome) + "\n";
    if (run.is_usable()) text += "error " + with_prefix(error(run), study_.measures[m_].unit) + ", ";
    text += with_prefix(seconds(run), "s") + " per s, " +
            number_text(run.sweeps / double(std::max(run.steps, 1l)), 3) + " sweeps a step";
    if (run.capped_steps > 0)
      text += "\n" + std::to_string(run.capped_steps) + " of " + std::to_string(run.steps) +
              " steps not converged";
    return text;
  }

  int choice(const StudyRun& run, int axis) const {
    return axis < 0 ? 0 : study_.choices(run.combination)[std::size_t(axis)];
  }
  static std::string colour(int k) { return k < 6 ? "c" + std::to_string(k) : "ink"; }

  void draw_runs() {
    for (const StudyRun& run : study_.runs) {
      const std::string ink = colour(choice(run, options_.colour_axis));
      const int shape = choice(run, options_.marker_axis);
      const double x = x_.at(seconds(run));
      if (!run.is_usable()) {
        svg_.cross(x, top - 14, 4, "cross " + ink, hint(run));
        continue;
      }
      std::string cls = "run " + ink;
      if (run.outcome == Outcome::capped) cls += " hollow";
      if (!study_.is_believed(run, options_.measure) && study_.measures[m_].uncertainty > 0) cls += " dim";
      svg_.marker(shape, x, y_.at(error(run)), 3.6, cls, hint(run));
    }
    const auto lost = std::count_if(study_.runs.begin(), study_.runs.end(),
                                    [](const auto& run) { return !run.is_usable(); });
    if (lost > 0)
      svg_.text(right + 8, top - 10,
                "× " + std::to_string(lost) + (lost == 1 ? " run" : " runs") + " failed or too slow");
  }

  /// Runs are numbered so that the steps of one choice follow each other.
  void draw_curves() {
    std::vector<std::pair<double, double>> points;
    const auto& runs = study_.runs;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      if (runs[k].is_usable()) points.push_back({x_.at(seconds(runs[k])), y_.at(error(runs[k]))});
      const bool is_last = k + 1 == runs.size() || runs[k + 1].combination != runs[k].combination ||
                           runs[k + 1].tolerance != runs[k].tolerance;
      if (!is_last) continue;
      if (points.size() > 1) svg_.polyline(points, "curve " + colour(choice(runs[k], options_.colour_axis)));
      points.clear();
    }
  }

  /// Down and to the right from one best run to the next: nothing lies below or left of it. Fixed steps and those that keep
  /// an accuracy have a line each.
  void draw_front() {
    const auto draw = [&](Stepping stepping, std::string_view cls) {
      std::vector<std::pair<double, double>> points;
      for (const StudyRun* run : study_.front(options_.measure, stepping)) {
        const double x = x_.at(seconds(*run)), y = y_.at(error(*run));
        if (!points.empty()) points.push_back({x, points.back().second});
        points.push_back({x, y});
      }
      if (points.size() > 1) svg_.polyline(points, cls);
    };
    draw(has_both_ ? Stepping::fixed : Stepping::any, "front");
    if (has_both_) draw(Stepping::controlled, "front kept");
    if (chosen_)
      svg_.marker(0, x_.at(seconds(*chosen_)), y_.at(error(*chosen_)), 9, "chosen", hint(*chosen_));
  }

  /// `AcceleratedGaussSeidel{}` needs no braces to be recognised.
  static std::string short_name(std::string text) {
    if (text.ends_with("{}")) text.resize(text.size() - 2);
    return text;
  }

  void draw_legend() {
    double y = top + 150;
    // Out of the way of the budget's own words.
    if (options_.budget > 0 && y_.at(options_.budget) > y - 24)
      y = std::min(y_.at(options_.budget) + 34, bottom - 200);
    if (options_.budget > 0 && std::abs(y_.at(options_.budget) - y) < 24) y = top + 40;
    const double x = right + 20;
    const auto entries = [&](int axis, bool is_colour) {
      if (axis < 0) return;
      const auto& names = study_.axes[std::size_t(axis)];
      for (std::size_t k = 0; k < names.size(); ++k, y += 21) {
        svg_.marker(is_colour ? 0 : int(k), x, y - 4, 4.5, "run " + (is_colour ? colour(int(k)) : "ink"));
        svg_.text(x + 14, y, short_name(names[k]));
      }
      y += 10;
    };
    entries(options_.colour_axis, true);
    entries(options_.marker_axis, false);
    const bool is_any_capped = std::any_of(study_.runs.begin(), study_.runs.end(),
                                           [](const auto& r) { return r.outcome == Outcome::capped; });
    if (is_any_capped) {
      svg_.marker(0, x, y - 4, 4.5, "run ink hollow");
      svg_.text(x + 14, y, "some steps not converged");
      y += 21;
    }
    if (chosen_) {
      svg_.marker(0, x, y - 4, 7, "chosen");
      svg_.text(x + 14, y, "cheapest within the budget");
    }
  }

  void draw_choice(const StudyMeasure& measure) {
    if (!(options_.budget > 0)) return;
    const std::string budget = with_prefix(options_.budget, measure.unit);
    if (!chosen_) {
      svg_.text(left, bottom + 76,
                "No run is known to hold " + budget +
                    (measure.uncertainty >= options_.budget
                         ? ": the reference itself is only sure to " +
                               with_prefix(measure.uncertainty, measure.unit) + "."
                         : "; smaller steps or tolerances may."));
      draw_horizon(budget);
      return;
    }
    svg_.text(left, bottom + 72,
              "Cheapest within " + budget + ": error " + with_prefix(error(*chosen_), measure.unit) +
                  (measure.uncertainty > 0 ? " ± " + with_prefix(measure.uncertainty, measure.unit) : "") +
                  " for " + with_prefix(seconds(*chosen_), "s") + " of processor time per simulated second");
    svg_.text(left, bottom + 94, "auto loop = " + study_.call(*chosen_) + ";", "code");
    svg_.text(left, bottom + 111, "loop.step(" + step_text(chosen_->h) + ");", "code");
    if (has_both_) svg_.text(left, bottom + 131, other_choice(budget));
  }

  /// What the cheapest of the other kind costs.
  std::string other_choice(const std::string& budget) const {
    const bool keeps = chosen_->is_controlled();
    const StudyRun* other = study_.cheapest(options_.measure, options_.budget, keeps ? Stepping::fixed : Stepping::controlled);
    const std::string what = keeps ? "fixed step" : "accuracy that is kept";
    if (!other) return "No " + what + " is known to hold " + budget + ".";
    return "The cheapest " + what + " takes " + number_text(other->cost / chosen_->cost, 2) + " times as long: " +
           (keeps ? "loop.step(" + step_text(other->h) + ")" : "accuracy " + number_text(other->accuracy, 3)) + ".";
  }
  /// What is known of the end of the run, where the references part before it.
  void draw_horizon(const std::string& budget) {
    const double until = study_.horizon(options_.measure, options_.budget);
    if (until < study_.plan.duration)
      svg_.text(left, bottom + 94,
                "The references agree to " + budget + " for " + with_prefix(until, "s") +
                    ". If finer ones do no longer, the scene is chaotic: then no run has a true error beyond.");
  }

  const Study& study_;
  DiagramOptions options_;
  std::size_t m_;
  const StudyRun* chosen_ = nullptr;
  bool has_both_ = false;  ///< runs of fixed steps, and runs that keep an accuracy
  LogAxis x_, y_;
  Svg svg_{width, height};
};

}  // namespace inner

/// The diagram as SVG text, for light and dark pages. Throws InvalidArgument when there is no such measure.
inline std::string diagram_svg(const Study& study, const DiagramOptions& options = {}) {
  return inner::Diagram(study, options).text();
}

/// Throws InvalidArgument naming `path` when it cannot be written.
inline void write_diagram(const std::string& path, const Study& study, const DiagramOptions& options = {}) {
  inner::write_file(path, diagram_svg(study, options));
}

}  // namespace delassus
