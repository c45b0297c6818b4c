// The two tables of docs/evidence/ladders.md.
#include "page.hpp"

#include "../rows.hpp"

#include <delassus/core/expect.hpp>
#include <delassus/io/inner/text.hpp>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

namespace ladders::peers {

namespace {

/// Replaces the text between two marks by what f makes of it.
template <class F>
void between(std::string& text, const std::string& path, const std::string& name, F&& f) {
  const std::string from = "<!-- " + name + " -->\n", to = "<!-- end of " + name + " -->";
  const std::size_t start = text.find(from), end = text.find(to);
  DELASSUS_EXPECT(
      start != text.npos && end != text.npos && start < end,
      "'" + path + "' has no lines '<!-- " + name + " -->' and '" + to + "' for the table to stand between");
  const std::size_t first = start + from.size();
  text.replace(first, end - first, f(text.substr(first, end - first)));
}

/// The line of our row with another last cell; any other line as it is.
std::string with_best(const std::string& line, const std::vector<PeerFigure>& peers) {
  for (const Row& row : rows) {
    const std::string start = std::string("| ") + row.id + " " + row.title + " | " + row.parts + " | ";
    if (!line.starts_with(start)) continue;
    const std::size_t last = line.rfind(" | ");
    return line.substr(0, last) + " | " + best_peer(peers, row.id, row.title, row.parts) + " |";
  }
  return line;
}

}  // namespace

void write_page(const std::string& path, const std::string& table, const std::vector<PeerFigure>& peers) {
  std::ifstream in(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  between(text, path, "peers", [&](const std::string&) { return table; });
  between(text, path, "ladders", [&](const std::string& old) {
    std::istringstream lines(old);
    std::string out;
    for (std::string line; std::getline(lines, line);) out += with_best(line, peers) + "\n";
    return out;
  });
  delassus::inner::write_file(path, text);
}

}  // namespace ladders::peers
