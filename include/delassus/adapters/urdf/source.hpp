/// The text of a URDF as XML: where each element stands, which attributes it may have, and what is passed
/// over.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>
#include <delassus/io/inner/xml_tags.hpp>
#include <delassus/model/check.hpp>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <tinyxml2.h>

namespace delassus::inner::urdf_file {

/// What an element may say. `numbers` is how many an attribute holds; 0: it is a text.
struct Attribute {
  std::string_view element, name;
  int numbers;
};
inline constexpr Attribute attributes[] = {
    {"robot", "name", 0},
    {"robot", "version", 0},
    {"link", "name", 0},
    {"link", "type", 0},
    {"collision", "name", 0},
    {"collision", "group", 0},
    {"joint", "name", 0},
    {"joint", "type", 0},
    {"parent", "link", 0},
    {"child", "link", 0},
    {"mesh", "filename", 0},
    {"mesh", "scale", 3},
    {"origin", "xyz", 3},
    {"origin", "rpy", 3},
    {"mass", "value", 1},
    {"inertia", "ixx", 1},
    {"inertia", "ixy", 1},
    {"inertia", "ixz", 1},
    {"inertia", "iyy", 1},
    {"inertia", "iyz", 1},
    {"inertia", "izz", 1},
    {"box", "size", 3},
    {"sphere", "radius", 1},
    {"cylinder", "radius", 1},
    {"cylinder", "length", 1},
    {"capsule", "radius", 1},
    {"capsule", "length", 1},
    {"axis", "xyz", 3},
    {"limit", "lower", 1},
    {"limit", "upper", 1},
    {"limit", "effort", 1},
    {"limit", "velocity", 1},
    {"dynamics", "damping", 1},
    {"dynamics", "friction", 1},
    {"mimic", "joint", 0},
    {"mimic", "multiplier", 1},
    {"mimic", "offset", 1},
    {"lateral_friction", "value", 1},
    {"rolling_friction", "value", 1},
    {"spinning_friction", "value", 1},
    {"restitution", "value", 1},
};

inline std::vector<std::string_view> words(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  std::vector<std::string_view> found;
  for (std::size_t at = text.find_first_not_of(space); at != text.npos;
       at = text.find_first_not_of(space, at)) {
    const std::size_t end = std::min(text.find_first_of(space, at), text.size());
    found.push_back(text.substr(at, end - at));
    at = end;
  }
  return found;
}

/// A file while it is read: its name for sentences, and what was passed over.
class Source {
 public:
  using Element = tinyxml2::XMLElement;

  Source(std::string_view text, std::string name, bool is_strict)
      : name_(std::move(name)), is_strict_(is_strict) {
    expect_moderate(text);
    xml_.Parse(text.data(), text.size());
    if (xml_.Error())
      refuse_at(std::max(xml_.ErrorLineNum(), 1), std::string("this is no XML that can be read (") +
                                                      tinyxml2::XMLDocument::ErrorIDToName(xml_.ErrorID()) +
                                                      "); is the file whole?");
    root_ = xml_.RootElement();
    if (!root_ || std::string_view(root_->Name()) != "robot")
      refuse_at(root_ ? root_->GetLineNum() : 1,
                "a URDF begins with the element <robot>, and this file does not");
    if (const Element* second = root_->NextSiblingElement())
      refuse_at(second->GetLineNum(), "a second element stands beside <robot>; a URDF has one");
  }

  const Element& root() const { return *root_; }
  std::string where(int line) const { return name_ + ":" + std::to_string(line); }
  [[noreturn, gnu::cold]] void refuse_at(int line, const std::string& reason) const {
    refuse(where(line) + ": " + reason);
  }
  [[noreturn, gnu::cold]] void refuse_at(const Element& at, const std::string& reason) const {
    refuse_at(at.GetLineNum(), reason);
  }

  /// What nothing here does: named in `Model::skipped`, or refused.
  void skip(int line, const std::string& what) {
    if (is_strict_)
      refuse_at(line, what + "; without `strict` this is named in Model::skipped and passed over");
    skipped_.emplace_back(line, what);
  }
  void skip(const Element& at, const std::string& what) { skip(at.GetLineNum(), what); }
  void skip_element(const Element& at) { skip(at, std::string("<") + at.Name() + "> is not read"); }

  /// Its only child of that name, or null; more of them are passed over.
  const Element* only(const Element& of, const char* name) {
    const Element* first = of.FirstChildElement(name);
    for (const Element* e = first ? first->NextSiblingElement(name) : nullptr; e;
         e = e->NextSiblingElement(name))
      skip(*e, std::string("a second <") + name + "> in one <" + of.Name() + ">");
    if (first) expect_attributes(*first);
    return first;
  }

  /// Passes over children that have none of the names.
  void skip_all_but(const Element& of, std::initializer_list<std::string_view> names) {
    for (const Element* e = of.FirstChildElement(); e; e = e->NextSiblingElement())
      if (std::find(names.begin(), names.end(), std::string_view(e->Name())) == names.end()) skip_element(*e);
  }

  /// Refuses numbers that are none, or too many or too large. Passes over attributes that URDF does not have,
  /// and what stands within and is no element, as one that has lost its `<`.
  void expect_attributes(const Element& of) {
    for (const tinyxml2::XMLNode* node = of.FirstChild(); node; node = node->NextSibling())
      if (node->ToText() || node->ToUnknown())
        skip(node->GetLineNum(), "'" + beginning(node->Value()) + "' in <" + of.Name() + "> is no element");
    std::string others;
    for (const tinyxml2::XMLAttribute* a = of.FirstAttribute(); a; a = a->Next()) {
      const Attribute* known = find(of.Name(), a->Name());
      if (known && known->numbers > 0) expect_numbers(of, *a, known->numbers);
      if (!known && std::string_view(a->Name()).substr(0, 5) != "xmlns")
        others += (others.empty() ? "'" : ", '") + std::string(a->Name()) + "'";
    }
    if (!others.empty()) skip(of, "of <" + std::string(of.Name()) + "> no " + others + " is read");
  }

  double number(const Element& of, const char* attribute, double otherwise) const {
    const char* text = of.Attribute(attribute);
    return text ? parsed(of, attribute, words(text).at(0)) : otherwise;
  }

  /// The element without its children, as urdfdom shall see it: numbers alone, parted by one space.
  std::string numbers_of(const Element& of) const {
    std::string tag = std::string("<") + of.Name();
    for (const tinyxml2::XMLAttribute* a = of.FirstAttribute(); a; a = a->Next()) {
      const Attribute* known = find(of.Name(), a->Name());
      if (!known || known->numbers == 0) continue;
      tag += std::string(" ") + a->Name() + "=\"";
      for (const std::string_view word : words(a->Value()))
        tag += (tag.back() == '"' ? "" : " ") + std::string(word);
      tag += '"';
    }
    return tag + "/>";
  }

  /// In the order of the lines.
  std::vector<std::string> skipped() {
    std::stable_sort(skipped_.begin(), skipped_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> sentences;
    for (const auto& [line, what] : skipped_) sentences.push_back(where(line) + ": " + what);
    return sentences;
  }

 private:
  static constexpr std::size_t most_bytes = 16u << 20, most_parts = 400000;

  /// Before any tree is made of it.
  void expect_moderate(std::string_view text) const {
    const std::size_t zero = text.find('\0');
    if (zero != text.npos)
      refuse_at(line_of(text, zero), "a zero byte stands in the text");
    if (text.size() > most_bytes || std::size_t(std::count(text.begin(), text.end(), '<') +
                                                std::count(text.begin(), text.end(), '=')) > most_parts)
      refuse_at(1, "the file is longer than 16 MiB, or has more than " + std::to_string(most_parts) +
                       " elements and attributes");
    const std::size_t longer = longer_tag(text, 200);
    if (longer != text.npos)
      refuse_at(line_of(text, longer), "a tag has more than 200 attributes, and URDF has no such");
  }

  static int line_of(std::string_view text, std::size_t at) {
    return 1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
  }

  static const Attribute* find(std::string_view element, std::string_view name) {
    for (const Attribute& a : attributes)
      if (a.element == element && a.name == name) return &a;
    return nullptr;
  }

  double parsed(const Element& of, const char* attribute, std::string_view word) const {
    double value = 0;
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || !is_sane(value))
      refuse_at(of, "'" + std::string(word.substr(0, 40)) + "' in " + attribute + " of <" + of.Name() +
                        "> is no number from -1e50 to 1e50");
    return value;
  }

  void expect_numbers(const Element& of, const tinyxml2::XMLAttribute& a, int count) const {
    const std::vector<std::string_view> all = words(a.Value());
    if (int(all.size()) != count)
      refuse_at(of, std::string(a.Name()) + " of <" + of.Name() + "> has " + std::to_string(all.size()) +
                        " numbers and must have " + std::to_string(count));
    for (const std::string_view word : all) parsed(of, a.Name(), word);
  }

  std::string name_;
  bool is_strict_;
  tinyxml2::XMLDocument xml_;
  const Element* root_ = nullptr;
  std::vector<std::pair<int, std::string>> skipped_;
};

}  // namespace delassus::inner::urdf_file
