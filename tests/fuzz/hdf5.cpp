// Files of HDF5 in nearly the form of FCLIB: each array may be missing, of another length or of any numbers.
// The library of HDF5 itself is not asked to read damaged bytes.
#include "bytes.hpp"

#include <delassus/adapters/hdf5.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

using namespace delassus;
using fuzz::Bytes, fuzz::expect;

namespace {

std::vector<int> integers(Bytes& bytes, std::vector<int> good) {
  if (bytes.chance(200)) return good;
  good.resize(std::size_t(bytes.below(12)));
  for (int& x : good)
    if (bytes.chance(128)) x = bytes.chance(64) ? 1 << bytes.below(31) : bytes.byte() - 128;
  return good;
}

std::vector<double> numbers(Bytes& bytes, std::vector<double> good) {
  if (bytes.chance(40)) good.resize(std::size_t(bytes.below(24)));
  for (double& x : good)
    if (bytes.chance(24)) x = bytes.odd();
  return good;
}

/// W = 1 for n contacts, in one of the three forms, and then what the bytes make of it.
void write(inner::Hdf5File& out, Bytes& bytes) {
  const int n = bytes.below(3), rows = 3 * n, form = bytes.below(3);
  const auto put = [&](const std::string& name, const auto& value) {
    if (!bytes.chance(8)) out.write("/fclib_local/" + name, value);
  };
  for (const char* group :
       {"/fclib_local", "/fclib_local/W", "/fclib_local/vectors", "/guesses", "/guesses/1"})
    out.group(group);
  std::vector<int> place, start;
  for (int k = 0; k <= rows; ++k) start.push_back(k);
  place.assign(start.begin(), start.end() - 1);
  put("spacedim", integers(bytes, {3}));
  put("W/m", integers(bytes, {rows}));
  put("W/n", integers(bytes, {rows}));
  put("W/nzmax", integers(bytes, {rows}));
  put("W/nz", integers(bytes, {form == 0 ? rows : -form}));
  put("W/p", integers(bytes, form == 0 ? place : start));
  put("W/i", integers(bytes, place));
  put("W/x", numbers(bytes, std::vector<double>(std::size_t(rows), 1.0)));
  put("vectors/q", numbers(bytes, std::vector<double>(std::size_t(rows), -1.0)));
  put("vectors/mu", numbers(bytes, std::vector<double>(std::size_t(n), 0.5)));
  out.write("/guesses/1/r", numbers(bytes, std::vector<double>(std::size_t(rows), 0.25)));
}

void check(const FrictionProblem& p) {
  const auto& pool = p.rows.pool<0>();
  for (Index i = 0; i < pool.items(); ++i) {
    expect(is_finite(pool.d[i]) && is_finite(pool.lambda[i]), "a number that was read is not finite");
    expect(p.W.diagonal<0>(i).diagonal().minCoeff() > 0, "a diagonal that was read is not positive");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("delassus_fuzz_" + std::to_string(::getpid()) + ".hdf5"))
          .string();
  Bytes bytes(data, size);
  {
    auto out = inner::Hdf5File::create(path);
    write(out, bytes);
  }
  try {
    FrictionProblem p = read_fclib(path);
    check(p);
    write_fclib(path, p);
    check(read_fclib(path));
  } catch (const InvalidArgument& refused) {
    expect(std::string(refused.what()).size() > 10, "a refusal says nothing");
  }
  std::filesystem::remove(path);
  return 0;
}
