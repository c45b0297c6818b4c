/// A loop as a file: restored, it goes on to the bit as if it had never stopped.
#pragma once

#include <delassus/collision/native_engine.hpp>
#include <delassus/core/archive.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/type_text.hpp>
#include <delassus/io/inner/text_reader.hpp>
#include <delassus/io/state_hash.hpp>
#include <delassus/rows/row_system.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {
namespace inner {

/// World and laws, widths of the sets, rows of the pools: loops that differ in it do not understand each other. The type of the solver
/// may differ. Two compilers may write the names of some types in two ways.
template <class Loop>
std::string shape_of(const Loop& loop) {
  using Laws = typename Loop::Laws;
  std::string text = type_text<typename Loop::WorldType>() + ", " + type_text<Laws>() + ", scalar " +
                     std::to_string(sizeof(typename Loop::Scalar)) + ", sets";
  loop.world().each([&](const auto& set, auto) { text += ' ' + std::to_string(std::remove_cvref_t<decltype(set)>::width); });
  text += ", pools";
  for_each_index<Laws::pool_count>([&](auto p) {
    using Pool = std::remove_cvref_t<decltype(std::declval<Laws&>().template pool<p>())>;
    text += ' ' + std::to_string(Pool::rows) + ':' + std::to_string(sizeof(typename Pool::Item));
  });
  return text;
}

}  // namespace inner

/// The state of a loop as bytes, for `restore`: everything `AnimationLoop::memory` names. For this machine, compiler
/// and version.
template <class Loop>
std::vector<char> checkpoint(Loop& loop) {
  ArchiveWriter archive;
  loop.memory(archive);
  const std::string header = "delassus checkpoint 2, " + inner::shape_of(loop) + '\n';
  inner::Fingerprint sum;
  sum.bytes(archive.data.data(), archive.data.size());
  std::vector<char> all(header.begin(), header.end());
  const auto* check = reinterpret_cast<const char*>(&sum.value);
  all.insert(all.end(), check, check + sizeof sum.value);
  all.insert(all.end(), archive.data.begin(), archive.data.end());
  return all;
}

/// Gives a loop of the same type the state that `checkpoint` took, whatever it holds now. Throws InvalidArgument when the bytes
/// are of another loop or damaged; the loop is then as it was.
///
/// Handles belong to the loop that gave them out: there they name what has their place now. `set.handle(block)` and
/// `loop.constraint<Law>(place)` give this loop's own.
template <class Loop>
void restore(Loop& loop, std::span<const char> bytes) {
  const std::string header = "delassus checkpoint 2, " + inner::shape_of(loop) + '\n';
  const std::size_t most = std::min(bytes.size(), header.size());
  DELASSUS_EXPECT(std::string(bytes.data(), most) == header,
                  "checkpoint: it is of another version or another loop; this one is '" + inner::shape_of(loop) + "'");
  bytes = bytes.subspan(header.size());
  inner::Fingerprint sum, said;
  DELASSUS_EXPECT(bytes.size() >= sizeof sum.value, "checkpoint: it ends in the middle; it was not written whole");
  std::memcpy(&said.value, bytes.data(), sizeof said.value);
  bytes = bytes.subspan(sizeof sum.value);
  sum.bytes(bytes.data(), bytes.size());
  DELASSUS_EXPECT(sum.value == said.value, "checkpoint: its bytes are not those that were written");
  Loop next = loop.clone();
  ArchiveReader archive(bytes);
  next.memory(archive);
  DELASSUS_EXPECT(archive.is_at_end(), "checkpoint: it is longer than this loop can read");
  std::swap(loop.data().channels, next.data().channels);  // other threads hold references to the loop's own
  loop = std::move(next);
}

/// The same in a file, which is there whole or not at all. Throws InvalidArgument when it cannot be written.
template <class Loop>
void save_checkpoint(Loop& loop, const std::string& path) {
  const std::vector<char> bytes = checkpoint(loop);
  const std::string part = path + ".part";
  bool is_written = false;
  if (std::FILE* file = std::fopen(part.c_str(), "wb")) {
    is_written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    is_written = std::fclose(file) == 0 && is_written;
  }
  is_written = is_written && std::rename(part.c_str(), path.c_str()) == 0;
  if (!is_written) std::remove(part.c_str());
  DELASSUS_EXPECT(is_written, "checkpoint: cannot write '" + path + "'; is its folder there, and is there room?");
}

/// Restores from a file of `save_checkpoint`.
template <class Loop>
void load_checkpoint(Loop& loop, const std::string& path) {
  restore(loop, inner::read_text(path));
}

}  // namespace delassus
