/// Names of a model's elements, and which of them an element means that `replicate` or `attach` has copied.
#pragma once

#include <delassus/adapters/mjcf/source.hpp>
#include <delassus/core/index.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace delassus::inner::mjcf {

/// One copy that `replicate` or `attach` makes: its names have a prefix and a suffix. Copies lie in copies.
struct Scope {
  int parent = -1;
  int owner = 0;  ///< the scope in which the document of this one begins
  std::string prefix, suffix;

  std::string name(const std::string& base) const { return base.empty() ? base : prefix + base + suffix; }
};

enum class Kind { body, joint, geom, site, tendon };
inline const char* word(Kind kind) {
  constexpr const char* words[] = {"body", "joint", "geom", "site", "tendon"};
  return words[int(kind)];
}

/// A name in an attribute of an element.
struct Reference {
  Kind kind;
  std::string base;
};

class Names {
 public:
  std::vector<Scope> scopes{Scope{}};  ///< 0 is the model itself

  /// A copy within a scope. A document of its own begins its own names.
  int add_scope(const Element& e, int parent, const std::string& prefix, const std::string& suffix,
                bool is_document, Budget& budget) {
    const Scope& outer = scopes[std::size_t(parent)];
    const int scope = int(scopes.size());
    budget.take_letters(e, outer.prefix.size() + prefix.size() + suffix.size() + outer.suffix.size());
    scopes.push_back(
        {parent, is_document ? scope : outer.owner, outer.prefix + prefix, suffix + outer.suffix});
    return scope;
  }

  /// Says the whole name.
  std::string add(const Element& e, Kind kind, int scope, Index index, Budget& budget) {
    const std::string base = e.text("name"), name = scopes[std::size_t(scope)].name(base);
    if (base.empty()) return name;
    budget.take_letters(e, name.size());
    if (!found_.try_emplace({int(kind), name}, Found{index, scope}).second)
      e.refuse(std::string("the name '") + name.substr(0, 200) + "' is given to two of kind " + word(kind) +
               "; rename one");
    copies_[{int(kind), base}].push_back(scope);
    return name;
  }

  /// Of an element that is known but not read: `find` says `left_out` for its name.
  static constexpr Index left_out = -3, none = -2, world = -1;

  /// Indices change: those of a kind become to[index].
  void renumber(Kind kind, const std::vector<Index>& to) {
    for (auto& [key, found] : found_)
      if (key.first == int(kind) && found.index >= 0) found.index = to[std::size_t(found.index)];
  }

  /// The element that a name means in a scope, or in those around it; or `left_out`, `none`, `world`.
  Index find(const Reference& r, int scope) const { return look(r, scope).index; }

  /// The scopes in which an element of a document that begins in `owner` may stand, by what it refers to: the
  /// document's own, and those of all copies of that.
  std::vector<int> scopes_near(const std::vector<Reference>& references, int owner) const {
    std::vector<int> in{owner};
    std::set<std::pair<int, std::string>> seen;
    for (const Reference& r : references) {
      const auto copies = copies_.find({int(r.kind), r.base});
      if (copies == copies_.end() || !seen.insert(copies->first).second) continue;
      for (const int scope : copies->second)
        if (scopes[std::size_t(scope)].owner == owner) in.push_back(scope);
    }
    std::sort(in.begin(), in.end());
    in.erase(std::unique(in.begin(), in.end()), in.end());
    return in;
  }

  /// Whether it stands in a scope: the document's own where all names are found there, or a copy that has one
  /// of them where the others are found around it.
  bool stands_in(const std::vector<Reference>& references, int scope) const {
    bool is_own = scope == scopes[std::size_t(scope)].owner;
    for (const Reference& r : references) {
      const Found found = look(r, scope);
      if (found.index == none) return false;
      is_own = is_own || found.scope == scope;
    }
    return is_own;
  }

 private:
  struct Found {
    Index index = none;
    int scope = -1;
  };

  Found look(const Reference& r, int scope) const {
    if (r.kind == Kind::body && r.base == "world") return {world, -1};
    const int owner = scopes[std::size_t(scope)].owner;
    for (int s = scope;; s = scopes[std::size_t(s)].parent) {
      if (const auto at = found_.find({int(r.kind), scopes[std::size_t(s)].name(r.base)}); at != found_.end())
        return at->second;
      if (s == owner) return {};
    }
  }

  std::map<std::pair<int, std::string>, Found> found_;
  std::map<std::pair<int, std::string>, std::vector<int>> copies_;
};

}  // namespace delassus::inner::mjcf
