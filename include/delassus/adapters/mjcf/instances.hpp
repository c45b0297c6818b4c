/// Elements of the sections beside the bodies: once for each copy of what they refer to.
#pragma once

#include <delassus/adapters/mjcf/reading.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace delassus::inner::mjcf {

/// The first name that is not found, for a sentence.
inline std::string missing_name(const Reading& r, const std::vector<Reference>& references, int scope) {
  for (const Reference& reference : references)
    if (r.names.find(reference, scope) == Names::none)
      return std::string("there is no ") + word(reference.kind) + " '" + reference.base.substr(0, 200) + "'";
  return "its names lie in copies that share none";
}

/// All instances of the elements of a section, those of the model itself first, then copy by copy.
/// `references(document, element)` says what an element refers to.
template <class References>
std::vector<Instance> instances(Reading& r, std::string_view section, References&& references) {
  std::vector<Instance> all;
  for (const Copy& copy : r.copies)
    copy.source->document->for_each_section(section, [&](const Element& s) {
      copy.source->document->for_each(s, [&](const Element& e) {
        const std::vector<Reference> names = references(*copy.source->document, e);
        bool is_there = false;
        for (const int scope : r.names.scopes_near(names, copy.scope)) {
          r.budget.take_references(e, names.size() + 1);
          if (!r.names.stands_in(names, scope)) continue;
          r.budget.take_element(e);
          all.push_back({e, copy.source, scope});
          is_there = true;
        }
        // Of a model of which a part is attached, what refers to the rest does not come along.
        if (!is_there && copy.scope == 0) e.refuse(missing_name(r, names, 0));
      });
    });
  std::stable_sort(all.begin(), all.end(),
                   [](const Instance& a, const Instance& b) { return a.scope < b.scope; });
  return all;
}

/// The references of the attributes of an element that it has.
inline std::vector<Reference> references_of(const Element& e, Kind kind,
                                            std::initializer_list<const char*> attributes) {
  std::vector<Reference> found;
  for (const char* attribute : attributes)
    if (e.has(attribute)) found.push_back({kind, e.text(attribute)});
  return found;
}

}  // namespace delassus::inner::mjcf
