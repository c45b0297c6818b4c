// Reading docs/evidence/ladders/peers.csv, and the best of a row.
#include "peer_figures.hpp"

#include <delassus/io/inner/text.hpp>

#include <cstdlib>
#include <fstream>
#include <tuple>

namespace ladders {

namespace {

/// The fields of one line of CSV; a quote within quotes is doubled.
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out{""};
  bool is_quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && is_quoted && k + 1 < line.size() && line[k + 1] == '"')
      out.back() += line[++k];
    else if (line[k] == '"')
      is_quoted = !is_quoted;
    else if (line[k] == ',' && !is_quoted)
      out.emplace_back();
    else if (line[k] != '\r')
      out.back() += line[k];
  }
  return out;
}

int count_of(const std::string& field) { return field.empty() ? -1 : std::atoi(field.c_str()); }

std::string count_text(int count, int rungs) {
  return count == 0       ? "none"
         : count == rungs ? "all " + std::to_string(rungs)
                          : std::to_string(count) + " of " + std::to_string(rungs);
}

bool is_better(const PeerFigure& a, const PeerFigure& b) {
  const auto rank = [](const PeerFigure& p) {
    return std::tuple(p.silver, p.gold, p.bronze, -p.microseconds);
  };
  return rank(a) > rank(b);
}

}  // namespace

std::string time_text(double microseconds) {
  const bool is_long = microseconds >= 1000;
  const double value = is_long ? microseconds / 1000 : microseconds;
  return delassus::inner::number_text(value, value < 100 ? 2 : 3) + (is_long ? " ms" : " µs");
}

std::vector<PeerFigure> read_peers(const std::string& path) {
  std::vector<PeerFigure> out;
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);  // the columns' names
  while (std::getline(in, line)) {
    const std::vector<std::string> f = fields(line);
    if (f.size() != 10) continue;
    out.push_back({f[0], f[1], f[2], f[3], std::atoi(f[4].c_str()), count_of(f[5]), count_of(f[6]),
                   count_of(f[7]), f[8], std::atof(f[9].c_str())});
  }
  return out;
}

std::string best_peer(const std::vector<PeerFigure>& all, std::string_view id, std::string_view title,
                      std::string_view parts) {
  const PeerFigure *best = nullptr, *refused = nullptr, *ours = nullptr;
  for (const PeerFigure& peer : all) {
    if (peer.id != id || peer.title != title) continue;
    if (peer.is_ours()) {
      if (peer.parts == parts && peer.bronze >= 0) ours = &peer;
    } else if (peer.bronze < 0) {
      refused = &peer;
    } else if (!best || is_better(peer, *best)) {
      best = &peer;
    }
  }
  if (!best) return refused ? "– (" + refused->shortfall + ")" : "not measured";
  const auto levels = [](const PeerFigure& p) {
    return "silver " + count_text(p.silver, p.rungs) + ", gold " + count_text(p.gold, p.rungs) + ", " +
           time_text(p.microseconds) + " a step";
  };
  return best->engine + ": " + levels(*best) + (best->shortfall.empty() ? "" : " (" + best->shortfall + ")") +
         (ours ? "; ours by the same marks: " + levels(*ours) : "");
}

}  // namespace ladders
