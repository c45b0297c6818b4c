/// What readers of XML files say of a text: which tags are too long, and how a piece of it begins.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace delassus::inner {

/// Where a tag begins that has more than `most` attributes; npos where none has. A reader that looks for doubled names in
/// each tag takes time with the square of their number.
inline std::size_t longer_tag(std::string_view text, std::size_t most) {
  const auto behind = [&](std::string_view end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == text.npos ? text.size() : found + end.size();
  };
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::size_t start = at;
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = behind("-->", at + 4);
    } else if (rest.starts_with("<![CDATA[")) {
      at = behind("]]>", at + 9);
    } else if (rest.starts_with("<?")) {
      at = behind("?>", at + 2);
    } else if (rest.starts_with("<!")) {
      at = behind(">", at + 2);
    } else {
      std::size_t count = 0;
      for (++at; at < text.size() && text[at] != '>'; ++at) {
        if (text[at] == '"' || text[at] == '\'') at = std::min(text.find(text[at], at + 1), text.size());
        if (at < text.size() && text[at] == '=' && ++count > most) return start;
      }
    }
  }
  return text.npos;
}

/// Its first line that is not blank, 40 letters at most.
inline std::string beginning(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  return std::string(text.substr(first, std::min<std::size_t>(text.find_first_of("\r\n", first) - first, 40)));
}

}  // namespace delassus::inner
