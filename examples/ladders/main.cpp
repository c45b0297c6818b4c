// delassus_ladders: hard cases made harder rung by rung, and how far up the library stays on its feet.
#include "report.hpp"

#include <delassus/core/expect.hpp>
#include <delassus/io/csv.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

namespace ladders {

namespace {

constexpr const char* help =
    R"text(delassus_ladders [ROW...] [--out DIR] [--docs FILE] [--peers FILE] [--seconds S] [--quick]

Runs hard cases, each a ladder of rungs that get harder, and says how far up it reaches bronze (fails safely), silver (as good
engines do) and gold (meets a stated number). Writes DIR/ladders.csv with every figure and DIR/index.html, a page to look at.

  ROW            HC-01 or a word of a title or of its parts, "stack" say: only these rows; all if none is said
  --out DIR      the folder of what is written, made if missing; "out/ladders" if not said
  --docs FILE    replaces the table of this page, between its two ladder marks
  --peers FILE   what delassus_peers measured of other engines; docs/evidence/ladders/peers.csv of the tree if not said
  --seconds S    a rung that takes more processor time has failed, and no harder one of its row is tried; 60 if not said,
                 and in rows of very many bodies ten times that
  --quick        the easiest rung of each row, cut short; fails where one reaches less than it is known to
  --help         this text
)text";

struct Options {
  std::string out = "out/ladders", docs, peers = DELASSUS_LADDERS_PEERS, unknown;
  std::vector<std::string> wanted;
  double seconds = 60;
  bool is_quick = false, wants_help = false;
};

bool read_seconds(const char* word, double& seconds) {
  char* end = nullptr;
  seconds = std::strtod(word, &end);
  return end != word && *end == '\0' && seconds > 0 && seconds < 1e9;
}

bool is_wanted(const Row& row, const std::string& word) {
  for (const char* text : {row.id, row.title, row.parts})
    if (std::string_view(text).find(word) != std::string_view::npos) return true;
  return false;
}

bool is_word_of_a_row(const std::string& word) {
  for (const Row& row : rows)
    if (is_wanted(row, word)) return true;
  return false;
}

Options read_options(std::span<char*> arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    const bool has_value = i + 1 < arguments.size();
    if (word == "--quick")
      options.is_quick = true;
    else if (word == "--help" || word == "-h")
      options.wants_help = true;
    else if (word == "--out" && has_value)
      options.out = arguments[++i];
    else if (word == "--docs" && has_value)
      options.docs = arguments[++i];
    else if (word == "--peers" && has_value)
      options.peers = arguments[++i];
    else if (word == "--seconds" && has_value && read_seconds(arguments[i + 1], options.seconds))
      ++i;
    else if (!word.starts_with("-") && is_word_of_a_row(std::string(word)))
      options.wanted.emplace_back(word);
    else
      options.unknown = word;
  }
  return options;
}

std::vector<const Row*> chosen(const Options& options) {
  std::vector<const Row*> out;
  for (const Row& row : rows) {
    bool is_in = options.wanted.empty();
    for (const std::string& word : options.wanted) is_in = is_in || is_wanted(row, word);
    if (is_in) out.push_back(&row);
  }
  return out;
}

/// Replaces what stands between the two marks of a page.
void write_docs(const std::string& path, const std::string& table) {
  std::ifstream in(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  constexpr std::string_view from = "<!-- ladders -->\n", to = "<!-- end of ladders -->";
  const std::size_t start = text.find(from), end = text.find(to);
  DELASSUS_EXPECT(
      start != text.npos && end != text.npos && start < end,
      "'" + path +
          "' has no lines '<!-- ladders -->' and '<!-- end of ladders -->' for the table to stand between");
  text.replace(start + from.size(), end - start - from.size(), table);
  delassus::inner::write_file(path, text);
}

/// All rows that are wanted, one after the other; false when a quick one reaches less than it is known to.
bool climb(const Options& options) {
  std::vector<Climbed> all;
  bool holds = true;
  const std::vector<const Row*> list = chosen(options);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Row& row = *list[k];
    Ladder ladder("row " + std::to_string(k + 1) + " of " + std::to_string(list.size()) + "  " + row.id +
                      " " + row.title,
                  options.is_quick, options.seconds * row.patience);
    row.climb(ladder);
    all.push_back({&row, ladder.rungs()});
    double seconds = 0;
    for (const Rung& rung : ladder.rungs()) seconds += rung.seconds;
    std::printf("%s %s%s%s%s: bronze %zu, silver %zu, gold %zu of %zu rungs, %.1f s\n", row.id, row.title,
                *row.parts ? " (" : "", row.parts, *row.parts ? ")" : "", all.back().up_to(Level::bronze),
                all.back().up_to(Level::silver), all.back().up_to(Level::gold), all.back().rungs.size(),
                seconds);
    std::fflush(stdout);
    if (options.is_quick && all.back().rungs[0].level < row.at_least) {
      const Rung& rung = all.back().rungs[0];
      std::printf("  %s is %s; it was %s\n", rung.difficulty.c_str(), name(rung.level), name(row.at_least));
      if (const Mark* mark = worst(rung)) std::printf("  %s %g\n", mark->what, mark->value);
      holds = false;
    }
  }
  const std::vector<PeerFigure> peers = read_peers(options.peers);
  std::filesystem::create_directories(options.out);
  const std::filesystem::path out(options.out);
  delassus::write_csv((out / "ladders.csv").string(), figures(all));
  delassus::inner::write_file((out / "index.html").string(), page(all, peers));
  if (!options.docs.empty()) write_docs(options.docs, markdown(all, peers));
  if (!options.is_quick) std::puts(""), print(summary(all));
  std::printf("commit %s; every figure in %s, a page in %s\n", DELASSUS_LADDERS_COMMIT,
              (out / "ladders.csv").c_str(), (out / "index.html").c_str());
  return holds;
}

}  // namespace
}  // namespace ladders

int main(int count, char** arguments) {
  using namespace ladders;
  const Options options = read_options(std::span(arguments, std::size_t(count)).subspan(1));
  if (options.wants_help) {
    std::fputs(help, stdout);
    for (const Row& row : rows)
      std::printf("  %s  %s%s%s\n", row.id, row.title, *row.parts ? ", " : "", row.parts);
    return 0;
  }
  if (!options.unknown.empty()) {
    std::fprintf(stderr,
                 "delassus_ladders: '%s' is neither a row nor an option, or its value is not one; --help "
                 "lists them.\n",
                 options.unknown.c_str());
    return 2;
  }
  try {
    return climb(options) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "delassus_ladders: %s\n", error.what());
    return 1;
  }
}
