/// Brings docs/evidence/ladders.md up to date with a comparison.
#pragma once

#include "../peer_figures.hpp"

#include <string>
#include <vector>

namespace ladders::peers {

/// Replaces what stands between the page's two marks <!-- peers --> and <!-- end of peers -->, and the last
/// cell, the best peer, of each row between <!-- ladders --> and <!-- end of ladders -->.
void write_page(const std::string& path, const std::string& table, const std::vector<PeerFigure>& peers);

}  // namespace ladders::peers
