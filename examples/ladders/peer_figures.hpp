/// What delassus_peers measured of other engines on the same rungs, as docs/evidence/ladders/peers.csv keeps it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ladders {

/// One engine on one row. `level` counts rungs in a row from the first; negative where the engine could not
/// have the scene, and `shortfall` then says why.
struct PeerFigure {
  std::string id, title, engine, parts;
  int rungs = 0, bronze = -1, silver = -1, gold = -1;
  std::string shortfall;  ///< the first rung below silver, or below gold, and the figure that keeps it there
  double microseconds = 0;

  bool is_ours() const { return engine == "delassus"; }
};

/// A time of a step with its unit, "8.2 µs" or "1.4 ms".
std::string time_text(double microseconds);

/// Empty when there is no such file.
std::vector<PeerFigure> read_peers(const std::string& path);

/// The engine that gets furthest on a row's rungs, in words, or why there is none; `parts` are of our row.
std::string best_peer(const std::vector<PeerFigure>& all, std::string_view id, std::string_view title,
                      std::string_view parts);

}  // namespace ladders
