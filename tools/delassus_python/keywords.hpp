/// What Python says to `Machine(...)`, as options of delassus_run.
#pragma once

#include "../delassus_run/options.hpp"

#include <pybind11/pybind11.h>

#include <algorithm>
#include <locale.h>

namespace delassus_run {

/// Keywords are options without their dashes: `push_apart=True` is --push-apart, `hold=[200, 5]` is --hold 200,5 and
/// `at={"knee": 0.3}` is --at knee=0.3. None and False say nothing. Refuses what delassus_run refuses, in its words, and options
/// that say how long a run is or what it writes.
inline Options options_of(const pybind11::dict& keywords) {
  namespace py = pybind11;
  static constexpr const char* known[] = {"accuracy", "at", "base", "dt", "friction", "ground", "height", "hold", "integrator", "key", "meshes", "package", "push_apart", "strict", "threads", "tolerance"};
  const auto text = [](const py::handle& value) -> std::string { return py::str(value); };
  std::vector<std::string> words;
  for (const auto& [key, given] : keywords) {
    const py::object value = py::hasattr(given, "tolist") ? given.attr("tolist")() : py::reinterpret_borrow<py::object>(given);  // NumPy's
    std::string name = text(key), list;
    if (std::find(std::begin(known), std::end(known), name) == std::end(known)) {
      for (const char* one : known) list += (list.empty() ? "" : ", ") + std::string(one);
      inner::refuse("Machine: there is no keyword '" + name + "'; there are " + list);
    }
    std::replace(name.begin(), name.end(), '_', '-');
    const std::string option = "--" + name;
    if (value.is_none() || value.is(py::bool_(false))) continue;
    if (value.is(py::bool_(true))) {
      words.push_back(option);
    } else if (py::isinstance<py::dict>(value)) {
      for (const auto& [of, what] : value.cast<py::dict>()) words.push_back(option + "=" + text(of) + "=" + text(what));
    } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
      for (const py::handle one : value) list += (list.empty() ? "" : ",") + text(one);
      words.push_back(option + "=" + list);
    } else {
      words.push_back(option + "=" + text(value));
    }
  }
  CLI::App app;
  Options options;
  describe(app, options);
  app.get_option("MODEL")->required(false);
  std::reverse(words.begin(), words.end());  // it takes them from the end
  const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", nullptr), before = uselocale(plain);  // Python writes 0.5 wherever it runs
  std::string why;
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    why = error.what();
  }
  uselocale(before), freelocale(plain);
  if (!why.empty()) inner::refuse(why);
  return check_machine(options), options;
}

}  // namespace delassus_run
