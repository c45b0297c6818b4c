/// The compliance of a body at rest as a file, and what it belongs to.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/index.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string>

namespace delassus::inner {

/// FNV-1a over the bytes of arrays. Source: [FowlerNollVo].
inline std::uint64_t key_of(std::uint64_t key, const void* from, std::size_t count) {
  const auto* p = static_cast<const unsigned char*>(from);
  for (std::size_t i = 0; i < count; ++i) key = (key ^ p[i]) * 1099511628211ull;
  return key;
}
std::uint64_t key_of(const auto& list, std::uint64_t key = 14695981039346656037ull) {
  return key_of(key, list.data(), list.size() * sizeof(list.data()[0]));
}

/// What a compliance depends on.
struct ComplianceKeys {
  std::uint64_t mesh = 0, material = 0, held = 0, step = 0;

  static ComplianceKeys of(const auto& body) {
    ComplianceKeys keys;
    keys.mesh = key_of(body.mesh().cells(), key_of(body.mesh().points));
    if constexpr (requires { body.mesh().thickness; })
      keys.mesh = key_of(keys.mesh, &body.mesh().thickness, sizeof(double));
    const auto& material = body.material();
    keys.material = key_of(key_of(body.mass()), &material, sizeof material);
    keys.held = key_of(body.held());
    const double scale[] = {body.scale().mass, body.scale().stiffness};
    keys.step = key_of(std::span<const double>(scale));
    return keys;
  }
};

struct ComplianceHeader {
  char name[24] = "delassus compliance 1\n";
  std::uint64_t number_size = 0, nodes = 0;
  ComplianceKeys keys;
  std::uint64_t sum = 0;  ///< of nodes and numbers
};

using ComplianceFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Gives `inverse` what the file says; false where there is no file. Throws InvalidArgument where it is of
/// something else, or damaged.
template <class Inverse>
bool read_compliance(const std::string& path, const ComplianceKeys& keys, Inverse& inverse) {
  using S = typename Inverse::FactorScalar;
  const ComplianceFile file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return false;
  const std::string who = "PrecomputedCompliance: '" + path + "'";
  ComplianceHeader header;
  const ComplianceHeader ours;
  DELASSUS_EXPECT(std::fread(&header, sizeof header, 1, file.get()) == 1 &&
                      std::memcmp(header.name, ours.name, sizeof ours.name) == 0,
                  who + " is no compliance of this version");
  const auto refusal = [&](const char* what) {
    return who + " is of another " + what + "; take it away or name another file";
  };
  DELASSUS_EXPECT(header.number_size == sizeof(S), refusal("scalar type"));
  DELASSUS_EXPECT(header.keys.mesh == keys.mesh, refusal("mesh or place of it"));
  DELASSUS_EXPECT(header.keys.material == keys.material, refusal("material or density"));
  DELASSUS_EXPECT(header.keys.held == keys.held, refusal("choice of fixed nodes"));
  DELASSUS_EXPECT(header.keys.step == keys.step, refusal("step or damping"));
  DELASSUS_EXPECT(header.nodes <= std::uint64_t(inverse.nodes()), who + " is damaged");
  Array<Index> nodes(header.nodes);
  Array<S> numbers(9 * header.nodes * header.nodes);
  const bool is_whole = std::fread(nodes.data(), sizeof(Index), nodes.size(), file.get()) == nodes.size() &&
                        std::fread(numbers.data(), sizeof(S), numbers.size(), file.get()) == numbers.size();
  DELASSUS_EXPECT(is_whole && header.sum == key_of(numbers, key_of(nodes)), who + " is damaged");
  inverse.take(nodes, numbers);
  return true;
}

/// Throws InvalidArgument where the file cannot be written.
template <class Inverse>
void write_compliance(const std::string& path, const ComplianceKeys& keys, const Inverse& inverse) {
  using S = typename Inverse::FactorScalar;
  const std::span<const Index> nodes = inverse.known();
  const std::span<const S> numbers = inverse.kept();
  ComplianceHeader header;
  header.number_size = sizeof(S);
  header.nodes = nodes.size();
  header.keys = keys;
  header.sum = key_of(numbers, key_of(nodes));
  ComplianceFile file(std::fopen(path.c_str(), "wb"), &std::fclose);
  bool is_written = file && std::fwrite(&header, sizeof header, 1, file.get()) == 1 &&
                    std::fwrite(nodes.data(), sizeof(Index), nodes.size(), file.get()) == nodes.size() &&
                    std::fwrite(numbers.data(), sizeof(S), numbers.size(), file.get()) == numbers.size();
  if (file) is_written = std::fclose(file.release()) == 0 && is_written;
  DELASSUS_EXPECT(is_written, "PrecomputedCompliance: '" + path + "' cannot be written");
}

}  // namespace delassus::inner
