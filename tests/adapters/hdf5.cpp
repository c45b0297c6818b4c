#include <delassus/adapters/hdf5.hpp>
#include <delassus/io/problem_file.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>

#include "catch.hpp"
#include "scratch_path.hpp"

#include <filesystem>
#include <fstream>

using namespace delassus;

namespace {

// Two contacts, W not symmetric, one block that is zero, numbers without a short decimal.
const std::string two =
    "fcp 1 gen\n2 4\n0.5 0.1\n-1 0.3333333333333333 1e-300\n-2 0 0.25\n"
    "0 0 2 0.1 0 0.2 3 0 0 0 4\n1 1 5 0 0 0 6 0 0 0 7\n1 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9\n"
    "0 1 0 0 0 0 0 0 0 0 0\n";

struct File {
  std::string path;
  explicit File(const char* name) : path(scratch_path(name).string()) {
    std::filesystem::remove(path);
  }
  ~File() { std::filesystem::remove(path); }
};

/// A file with W = diag(2, 3, 4) in one of FCLIB's three forms.
void write_one(const std::string& path, int form, int dimensions = 3, double mu = 0.5) {
  auto out = inner::Hdf5File::create(path);
  for (const char* group : {"/fclib_local", "/fclib_local/W", "/fclib_local/vectors"}) out.group(group);
  const std::string W = "/fclib_local/W/";
  out.write("/fclib_local/spacedim", dimensions);
  for (const char* name : {"m", "n"}) out.write(W + name, 3);
  out.write(W + "nzmax", form >= 0 ? 4 : 3);
  out.write(W + "nz", form);
  // Triplets may name a place twice: 1.5 + 0.5.
  out.write(W + "p", form >= 0 ? std::vector<int>{0, 1, 2, 0} : std::vector<int>{0, 1, 2, 3});
  out.write(W + "i", form >= 0 ? std::vector<int>{0, 1, 2, 0} : std::vector<int>{0, 1, 2});
  out.write(W + "x", form >= 0 ? std::vector<double>{1.5, 3, 4, 0.5} : std::vector<double>{2, 3, 4});
  out.write("/fclib_local/vectors/q", std::vector<double>{-1, 2, 0});
  out.write("/fclib_local/vectors/mu", std::vector<double>{mu});
}

}  // namespace

TEST_CASE("a problem goes to FCLIB's form and back to the same text") {
  const File file("delassus_round_trip.hdf5");
  FrictionProblem p = parse_problem(two, "two");
  p.rows.pool<0>().lambda = {{1, 0.25, 1. / 3}, {0, 0, 0}};
  write_fclib(file.path, p, "two contacts");
  const FrictionProblem back = read_fclib(file.path);
  // The text has every number to the bit, blocks in the order in which they stand: here by columns.
  REQUIRE(problem_text(back) == problem_text(p));
  REQUIRE(back.rows.pool<0>().lambda == p.rows.pool<0>().lambda);
  write_fclib_solution(file.path, p);
  REQUIRE(read_fclib_solution(file.path, 2) == p.rows.pool<0>().lambda);
  REQUIRE_THROWS_WITH(write_fclib_solution(file.path, p), Catch::Contains("it has a solution already"));
}

TEST_CASE("triplets, compressed columns and compressed rows are read alike") {
  const File file("delassus_forms.hdf5");
  for (const int form : {4, -1, -2}) {
    write_one(file.path, form);
    const FrictionProblem p = read_fclib(file.path);
    REQUIRE(p.W.diagonal<0>(0) == Mat3(Vec3(2, 3, 4).asDiagonal()));
    REQUIRE(p.rows.pool<0>().d[0] == Vec3(-1, 2, 0));
    REQUIRE(p.rows.pool<0>().lambda[0] == Vec3::Zero());
  }
}

TEST_CASE("an FCLIB file that is not a problem of this form is refused with its name and the reason") {
  const File file("delassus_refused.hdf5");
  const auto reason = [&](const std::string& part) {
    REQUIRE_THROWS_WITH(read_fclib(file.path), Catch::Contains(file.path) && Catch::Contains(part));
  };
  reason("cannot open");
  std::ofstream(file.path) << two;
  reason("as a file of HDF5");
  inner::Hdf5File::create(file.path);
  reason("no group fclib_local");
  inner::Hdf5File::create(file.path).group("/fclib_global");
  reason("global problem");
  write_one(file.path, -1, 2);
  reason("only 3");
  write_one(file.path, -1, 3, -0.5);
  reason("friction -0.5 must be >= 0");
  write_one(file.path, -3);
  reason("W/nz = -3");
  write_one(file.path, -1);
  inner::Hdf5File::open(file.path, true).group("/fclib_local/V");
  reason("equality rows");
}

TEST_CASE("arrays longer than their file, entries that add up to inf and solutions of others are refused") {
  const File file("delassus_claims.hdf5");
  write_one(file.path, -1);
  {
    // 10^12 numbers in pieces none of which is there.
    const hid_t data = H5Fopen(file.path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hsize_t size = 1000000000000, piece = 1024;
    const hid_t space = H5Screate_simple(1, &size, nullptr), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 1, &piece);
    H5Ldelete(data, "/fclib_local/vectors/q", H5P_DEFAULT);
    const hid_t q =
        H5Dcreate2(data, "/fclib_local/vectors/q", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Dclose(q), H5Pclose(how), H5Sclose(space), H5Fclose(data);
  }
  REQUIRE_THROWS_WITH(read_fclib(file.path), Catch::Contains("claims 1000000000000 numbers"));

  FrictionProblem two_contacts = parse_problem(two, "two");
  write_one(file.path, -1);
  REQUIRE_THROWS_WITH(write_fclib_solution(file.path, two_contacts),
                      Catch::Contains("3 rows, the solution has 6"));

  write_one(file.path, 4);
  {
    const hid_t data = H5Fopen(file.path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t x = H5Dopen2(data, "/fclib_local/W/x", H5P_DEFAULT);
    const double twice[4] = {1e308, 3, 4, 1e308};  // entries 0 and 3 are of one place
    H5Dwrite(x, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, twice);
    H5Dclose(x), H5Fclose(data);
  }
  REQUIRE_THROWS_WITH(read_fclib(file.path), Catch::Contains("add up to what is not finite"));
}
