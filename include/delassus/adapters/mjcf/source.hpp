/// XML files of a machine: where each element stands, what may be read at all, and how much.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/io/inner/xml_tags.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <tinyxml2.h>

namespace delassus::inner::mjcf {

/// One file, for as long as elements of it are read.
struct File {
  std::string path;
  tinyxml2::XMLDocument xml;
};

/// Calls visit(word) for the words of a text, until it says false.
template <class Visit>
void for_each_word(std::string_view text, Visit&& visit) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  for (const char *at = text.data(), *const end = at + text.size(); at < end;) {
    const char* const word = at;
    while (at < end && !is_space(*at)) ++at;
    if (at == word)
      ++at;
    else if (!visit(std::string_view(word, std::size_t(at - word))))
      return;
  }
}

/// Whether the word is a number in whole, what is infinite, NaN or too large for a double included.
inline bool parse_number(std::string_view word, double& to) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), to);
  if (error == std::errc::result_out_of_range) {  // as 1e999, or 1e-999
    const std::size_t exponent = word.find_first_of("eE");
    to = exponent != std::string_view::npos && word.find('-', exponent) != std::string_view::npos ? 0
                                                                                                  : HUGE_VAL;
  } else if (error != std::errc{}) {
    return false;
  }
  return end == word.data() + word.size();
}

/// Beyond it no length, mass or time of a machine lies; below it no volume or moment overflows.
inline constexpr double largest_number = 1e30;

/// An element and the file that it stands in.
class Element {
 public:
  Element(const tinyxml2::XMLElement* xml, const File* file) : xml_(xml), file_(file) {}

  const tinyxml2::XMLElement* xml() const { return xml_; }
  const File* file() const { return file_; }
  std::string_view name() const { return xml_->Name(); }
  std::string where() const { return where(xml_->GetLineNum()); }
  std::string where(int line) const { return file_->path + ":" + std::to_string(line); }
  /// The sentence begins with file and line.
  [[noreturn, gnu::cold]] void refuse(const std::string& reason) const {
    inner::refuse(where() + ": " + reason);
  }

  bool has(const char* attribute) const { return xml_->Attribute(attribute) != nullptr; }
  std::string text(const char* attribute, const char* otherwise = "") const {
    const char* found = xml_->Attribute(attribute);
    return found ? found : otherwise;
  }
  std::string required(const char* attribute) const {
    if (!has(attribute)) refuse(std::string(name()) + " needs the attribute '" + attribute + "'");
    return text(attribute);
  }

  /// Any count of numbers.
  std::vector<double> numbers(const char* attribute) const {
    std::vector<double> found;
    const char* all = xml_->Attribute(attribute);
    std::size_t count = 0;  // a list that grows has twice the room in the end
    for_each_word(all ? all : "", [&](std::string_view) { return ++count > 0; });
    found.reserve(count);
    for_each_word(all ? all : "", [&](std::string_view word) {
      double value = 0;
      if (!parse_number(word, value)) refuse_value(attribute, word, "is no number");
      check_size(attribute, word, value);
      found.push_back(value);
      return true;
    });
    return found;
  }
  /// From `least` to `to.size()` numbers over the first of `to`; says how many, 0 where the attribute is
  /// absent.
  int read(const char* attribute, std::span<double> to, int least) const {
    if (!has(attribute)) return 0;
    const std::vector<double> found = numbers(attribute);
    if (found.size() > to.size() || int(found.size()) < least)
      refuse(std::string("attribute '") + attribute + "' of " + std::string(name()) + " has " +
             std::to_string(found.size()) + " numbers and must have " + std::to_string(least) +
             (to.size() > std::size_t(least) ? " to " + std::to_string(to.size()) : ""));
    for (std::size_t i = 0; i < found.size(); ++i) to[i] = found[i];
    return int(found.size());
  }
  bool read(const char* attribute, double& to) const { return read(attribute, {&to, 1}, 1) > 0; }
  bool read(const char* attribute, Vec3& to) const { return read(attribute, {to.data(), 3}, 3) > 0; }
  bool read(const char* attribute, int& to) const {
    double value = to;
    if (!read(attribute, value)) return false;
    if (value != std::floor(value) || value < -2147483648.0 || value > 2147483647)
      refuse_value(attribute, text(attribute), "is no whole number of 32 bits");
    to = int(value);
    return true;
  }
  /// Which of the words the attribute is; −1 where it is absent.
  int choice(const char* attribute, std::initializer_list<std::string_view> of) const {
    if (!has(attribute)) return -1;
    const std::string found = text(attribute);
    int k = 0;
    std::string all;
    for (const std::string_view word : of) {
      if (found == word) return k;
      ++k;
      all += (all.empty() ? "" : ", ") + std::string(word);
    }
    refuse_value(attribute, found, "is none of " + all);
  }
  bool read(const char* attribute, bool& to) const {
    const int k = choice(attribute, {"false", "true"});
    if (k >= 0) to = k == 1;
    return k >= 0;
  }

  void check_size(const char* attribute, std::string_view word, double value) const {
    if (!(std::abs(value) <= largest_number))
      refuse_value(attribute, word, "is no number of a machine: it must be finite, and at most 1e30 in size");
  }

 private:
  [[noreturn, gnu::cold]] void refuse_value(const char* attribute, std::string_view value,
                                            const std::string& reason) const {
    refuse("'" + std::string(value.substr(0, 40)) + "' in attribute '" + attribute + "' of " +
           std::string(name()) + " " + reason);
  }

  const tinyxml2::XMLElement* xml_;
  const File* file_;
};

/// What a file asks for and nothing here does: kept as sentences, or refused.
class Skipped {
 public:
  Skipped(bool is_strict, std::vector<std::string>& to) : is_strict_(is_strict), to_(to) {}

  /// Once, of however many copies it is said.
  void add(const Element& at, const std::string& what) { add(at, at.xml()->GetLineNum(), what); }
  void add(const Element& at, int line, const std::string& what) {
    const std::string sentence = at.where(line) + ": " + what;
    if (is_strict_) refuse(sentence + "; without `strict` this is left out and named in Model::skipped");
    if (said_.insert(sentence).second) to_.push_back(sentence);
  }
  /// Once for each file and kind.
  void add_once(const Element& at, const std::string& kind, const std::string& what) {
    if (said_.insert(at.file()->path + '\n' + kind).second) add(at, what);
  }

 private:
  bool is_strict_;
  std::vector<std::string>& to_;
  std::set<std::string> said_;
};

/// How much a file may make: `replicate` and `attach` can ask for more than a machine can hold.
class Budget {
 public:
  explicit Budget(std::int64_t elements)
      : elements_(elements), all_(elements), parts_(std::max(least_parts, 5 * std::min(elements, std::int64_t(1) << 40))), bytes_(10 * parts_) {}

  /// Of a file, before a tree is made of it: all of them together may have 5 tags and attributes an element, of 10 letters.
  void take_text(const std::string& path, std::string_view text) {
    bytes_ -= std::int64_t(text.size());
    parts_ -= std::count(text.begin(), text.end(), '<') + std::count(text.begin(), text.end(), '=');
    if (bytes_ < 0 || parts_ < 0)
      inner::refuse(path + ":1: the text is too long for a model of " + std::to_string(all_) +
                    " elements; raise MjcfOptions::most_elements if it is right");
    const std::size_t longer = longer_tag(text, 200);
    if (longer != text.npos)
      inner::refuse(path + ":" + std::to_string(1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(longer), '\n')) +
                    ": a tag has more than 200 attributes, and MJCF has no such");
  }

  void take_element(const Element& at) {
    expect_elements(at, 1);
    --elements_;
  }
  /// Refuses what is to come, before time is spent on it.
  void expect_elements(const Element& at, std::int64_t count) const {
    if (count > elements_)
      at.refuse("the model grows beyond " + std::to_string(all_) +
                " elements; count less in replicate and attach, or raise MjcfOptions::most_elements");
  }
  /// Names that are looked up for copies of what refers to them, and letters of all names.
  void take_references(const Element& at, std::size_t count) {
    if ((references_ -= std::int64_t(count)) < 0)
      at.refuse("what refers to copies grows beyond 1000000 names; count less in replicate and attach");
  }
  void take_letters(const Element& at, std::size_t count) {
    if ((letters_ -= std::int64_t(count)) < 0)
      at.refuse("the names of copies grow beyond 20000000 letters; make them shorter");
  }
  /// Before room is made for them.
  void expect_points(const Element& at, double count) const {
    if (count > points_) refuse_points(at);
  }
  /// Points of meshes and height fields, in all.
  void take_points(const Element& at, double count) {
    if ((points_ -= count) < 0) refuse_points(at);
  }

 private:
  [[noreturn, gnu::cold]] static void refuse_points(const Element& at) {
    at.refuse(std::string(at.name()) + " '" + at.text("name") + "' grows beyond the " + text(most_points) +
              " points that the meshes and height fields of a model may have");
  }

  static constexpr double most_points = 3e6;
  static constexpr std::int64_t least_parts = 50'000;
  std::int64_t elements_, all_, parts_, bytes_, references_ = 1'000'000, letters_ = 20'000'000;
  double points_ = most_points;
};

}  // namespace delassus::inner::mjcf
