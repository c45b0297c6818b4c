/// Who met whom in the last detection of a loop, and with what friction.
#pragma once

#include <delassus/delassus.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace delassus {

struct UsedContact {
  double friction = 0, gap = 0;
};

/// By the blocks of the two rigid bodies, the smaller first; of several points the deepest.
template <class Loop>
std::map<std::pair<Index, Index>, UsedContact> used_contacts(Loop& loop) {
  std::map<std::pair<Index, Index>, UsedContact> out;
  each_contact_pool(loop.data().laws(), [&](auto, auto& pool) {
    for (const auto& item : pool.items) {
      const auto [one, other] = std::minmax(item.record->a.block, item.record->b.block);
      const auto place = out.find({one, other});
      if (place == out.end() || item.gap < place->second.gap)
        out[{one, other}] = {item.parameters.friction, item.gap};
    }
  });
  return out;
}

}  // namespace delassus
