/// Attributes that several elements have alike: limits, and numbers of which only some act here.
#pragma once

#include <delassus/adapters/mjcf/compiler.hpp>

#include <array>
#include <initializer_list>
#include <span>
#include <string>

namespace delassus::inner::mjcf {

/// A range, and whether it holds.
struct Limit {
  int is_on = 2;  ///< 0 no, 1 yes, 2: where there is a range
  std::array<double, 2> range{0, 0};

  bool has_range() const { return range[0] != 0 || range[1] != 0; }
};

/// The attributes `word` and `word` + "limited", as "ctrlrange" and "ctrllimited" of the word "ctrl".
inline void read_limit(const Element& e, const std::string& word, Limit& to) {
  e.read((word + "range").c_str(), to.range, 2);
  if (const int k = e.choice((word + "limited").c_str(), {"false", "true", "auto"}); k >= 0) to.is_on = k;
}

/// Whether the limit holds; a range that is none is refused.
inline bool holds(const Element& e, const Compiler& c, const Limit& limit, const std::string& word) {
  if (limit.is_on == 2 && !c.auto_limits && limit.has_range())
    e.refuse(std::string(e.name()) + " has " + word + "range but not " + word +
             "limited, and the compiler's autolimits are off; say whether the range holds");
  const bool is_on = limit.is_on == 1 || (limit.is_on == 2 && limit.range[0] < limit.range[1]);
  if (is_on && !(limit.range[0] < limit.range[1]))
    e.refuse(word + "range " + text(limit.range[0]) + " to " + text(limit.range[1]) + " of " +
             std::string(e.name()) + " must rise");
  return is_on;
}

/// A coefficient and those of the higher powers, which nothing here has.
inline void read_polynomial(const Element& e, const char* attribute, double& to, Skipped& skipped) {
  std::array<double, 3> all{to, 0, 0};
  if (!e.read(attribute, all, 1)) return;
  to = all[0];
  if (all[1] != 0 || all[2] != 0) skipped.add(e, std::string(attribute) + ": coefficients of higher powers");
}

inline void expect_not_below_zero(const Element& e, const char* attribute, double value) {
  if (!(value >= 0))
    e.refuse(std::string(attribute) + " " + text(value) + " of " + std::string(e.name()) + " must be >= 0");
}

/// Names a number other than 0 that nothing here heeds.
inline void skip_number(const Element& e, const char* attribute, const std::string& why, Skipped& skipped) {
  std::array<double, 10> x{};
  if (!e.read(attribute, x, 1)) return;
  for (const double value : x)
    if (value != 0) return skipped.add(e, std::string(attribute) + ": " + why);
}

/// Softness of contacts, limits and friction: one line a file.
inline void skip_softness(const Element& e, Skipped& skipped) {
  for (const char* attribute :
       {"solref", "solimp", "solmix", "solreflimit", "solimplimit", "solreffriction", "solimpfriction"})
    if (e.has(attribute))
      skipped.add_once(
          e, "softness",
          std::string(attribute) +
              ", and all solref and solimp of this file: contacts, limits and equalities are rigid here");
}

}  // namespace delassus::inner::mjcf
