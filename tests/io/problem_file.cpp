#include <delassus/delassus.hpp>
#include <delassus/io/problem_file.hpp>

#include "catch.hpp"
#include "scenes.hpp"

#include <cstdlib>
#include <filesystem>

using namespace scenes;

namespace {

const std::string two =
    "fcp 1 gen\n"
    "2 3\n"
    "0.5 0.7\n"
    "-1 0.5 0\n"
    "-2 0 0.25\n"
    "0 0 2 0.1 0 0.2 3 0 0 0 4\n"
    "1 1 5 0 0 0 6 0 0 0 7\n"
    "1 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// Every number of one problem is, to the bit, that of the other.
bool same_bits(const FrictionProblem& a, const FrictionProblem& b) {
  const auto &x = a.rows.pool<0>(), &y = b.rows.pool<0>();
  const auto &V = a.W.blocks<0, 0>(), &W = b.W.blocks<0, 0>();
  if (x.d != y.d || V.start != W.start) return false;
  for (Index i = 0; i < x.items(); ++i) {
    if (a.laws.pool<0>().item(i).parameters.friction != b.laws.pool<0>().item(i).parameters.friction)
      return false;
    if (a.W.diagonal<0>(i) != b.W.diagonal<0>(i)) return false;
    for (Index e = V.start[i]; e < V.start[i + 1]; ++e) {
      Index f = W.start[i];
      while (f < W.start[i + 1] && W.column[f] != V.column[e]) ++f;
      if (f == W.start[i + 1] || V.block[e] != W.block[f]) return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("a problem file says friction, velocities and blocks, row by row") {
  const FrictionProblem p = parse_problem(two, "two.fcp");
  const auto& pool = p.rows.pool<0>();
  REQUIRE(pool.items() == 2);
  REQUIRE(p.laws.pool<0>().item(1).parameters.friction == 0.7);
  REQUIRE(pool.d[1] == Vec3(-2, 0, 0.25));
  REQUIRE(p.W.diagonal<0>(0)(0, 1) == 0.1);
  REQUIRE(p.W.diagonal<0>(0)(1, 0) == 0.2);
  const auto W = p.W.blocks<0, 0>();
  REQUIRE(W.start == std::vector<Index>{0, 0, 1});
  REQUIRE(W.column == std::vector<Index>{0});
  REQUIRE(W.block[0](0, 2) == 0.3);
  REQUIRE(W.block[0](2, 0) == 0.7);
}

TEST_CASE("what is written is read back to the bit, symmetric or not") {
  const FrictionProblem p = parse_problem(two, "two.fcp");
  REQUIRE(problem_text(p).substr(0, 9) == "fcp 1 gen");
  REQUIRE(same_bits(p, parse_problem(problem_text(p), "again")));

  std::string text = with(two, "gen", "sym");
  text = with(text, "0.1 0 0.2 3", "0.1 0 0.1 3");
  const FrictionProblem q = parse_problem(text, "sym.fcp");
  REQUIRE(q.W.blocks<0, 0>().column == std::vector<Index>{1, 0});
  REQUIRE(q.W.blocks<0, 0>().block[0] == Mat3(q.W.blocks<0, 0>().block[1].transpose()));
  REQUIRE(problem_text(q).substr(0, 9) == "fcp 1 sym");
  REQUIRE(same_bits(q, parse_problem(problem_text(q), "again")));
}

TEST_CASE("the problem of a loop's step can be written, and is solved as in the loop") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0}}, BallJoint{}}};
  add_stack(rigid_bodies(loop), 3, Box{1, 1, 1});
  loop.step(1.0 / 60);
  const auto problem = loop.problem();
  FrictionProblem p = friction_problem(problem);
  REQUIRE(p.rows.pool<0>().items() == problem.rows.template pool<0>().items());
  REQUIRE(p.rows.pool<0>().items() >= 9);
  REQUIRE(same_bits(p, parse_problem(problem_text(p), "stack")));
  // The same numbers in the same order: the same sweeps, the same bits.
  auto copy = problem;
  for (auto& x : copy.rows.template pool<0>().lambda) x.setZero();
  for (auto& x : p.rows.pool<0>().lambda) x.setZero();
  const AcceleratedSweeps solver{.tolerance = 1e-8, .max_iterations = 100000};
  const SolveReport a = solve(copy, solver), b = solve(p, solver);
  REQUIRE(a.status == Status::converged);
  REQUIRE(a.sweeps == b.sweeps);
  REQUIRE(copy.rows.template pool<0>().lambda == p.rows.pool<0>().lambda);
}

TEST_CASE("a loop's problem with a joint is refused: the form holds contacts alone") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}, BallJoint{}}};
  auto& set = rigid_bodies(loop);
  const auto box = set.add({.mass = 1.0, .shape = Box{1, 1, 1}});
  loop.add(BallJoint::Item{anchor(set, box, {0, 0, .5}), world_anchor({0, 0, .5})});
  loop.step(0.01);
  REQUIRE_THROWS_WITH(friction_problem(loop.problem()),
                      Catch::Contains("pool 1 has 1 constraints that are not contacts with friction"));
}

TEST_CASE("impulses are written and read back to the bit") {
  const std::vector<Vec3> lambda{{1.0 / 3, -1e-300, 0}, {5e300, 2, -0.1}};
  REQUIRE(parse_impulses(impulses_text(lambda), "guess", 2) == lambda);
  REQUIRE_THROWS_WITH(parse_impulses(impulses_text(lambda), "guess", 3),
                      "delassus: guess, line 7: the file ends where one of 3 × 3 impulses should stand");
  REQUIRE_THROWS_WITH(parse_impulses(impulses_text(lambda), "guess", 1),
                      "delassus: guess, line 4: the file goes on after the impulses of 1 contacts");
}

// [[1, w], [w, 1]] has the eigenvalues 1 ± w. Six digits make an eigenvalue that is zero one of −1e-6.
TEST_CASE("a file whose W is indefinite is refused at the contact that makes it so") {
  const auto file = [](const std::string& own, const std::string& between) {
    return "fcp 1 sym\n3 4\n0.5 0.5 0.5\n-1 0 0\n-1 0 0\n-1 0 0\n0 0 1 0 0 0 1 0 0 0 1\n1 1 " + own + "\n2 1 " + between +
           " 0 0 0 0 0 0 0 0\n2 2 1 0 0 0 1 0 0 0 1\n";
  };
  const std::string unit = "1 0 0 0 1 0 0 0 1";
  REQUIRE_NOTHROW(parse_problem(file(unit, "0.99"), "W.fcp"));
  REQUIRE_NOTHROW(parse_problem(file(unit, "-1.000001"), "W.fcp"));
  REQUIRE_THROWS_WITH(parse_problem(file(unit, "1.01"), "W.fcp"),
                      Catch::Contains("W.fcp, line 10: W of contacts 0 to 2 is indefinite"));
  REQUIRE_THROWS_WITH(parse_problem(file("1 2 0 2 1 0 0 0 1", "0"), "W.fcp"),
                      Catch::Contains("W.fcp, line 8: W of contacts 0 to 1 is indefinite"));
  // Of a W that is not symmetric its symmetric part is asked.
  REQUIRE_NOTHROW(parse_problem("fcp 1 gen\n1 1\n0.5\n-1 0 0\n0 0 1 9 0 -9 1 0 0 0 1\n", "W.fcp"));
}

TEST_CASE("bad problem files are refused with file, line and reason") {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      parse_problem(text, "bad.fcp");
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "";
  };
  const std::string at = "delassus: bad.fcp, line ";
  REQUIRE(refusal("") == at + "1: the file ends where 'fcp' should stand");
  REQUIRE(refusal(with(two, "fcp", "mcp")) == at + "1: a problem file begins with 'fcp 1'");
  REQUIRE(refusal(with(two, "fcp 1", "fcp 2")) ==
          at + "1: '2' is no whole number from 1 to 1, but the version of the format, 1, should stand there");
  REQUIRE(refusal(with(two, "gen", "half")) == at + "1: after 'fcp 1' stands 'sym' or 'gen', not 'half'");
  REQUIRE(refusal(with(two, "2 3", "-2 3")).find("line 2: '-2' is no whole number") != std::string::npos);
  REQUIRE(refusal(with(two, "2 3", "99999999999 3")).find("line 2: ") != std::string::npos);
  REQUIRE(refusal(with(two, "0.7\n", "-0.7\n")) == at + "3: friction -0.7 must be >= 0");
  REQUIRE(refusal(with(two, "0.7\n", "nan\n")) ==
          at + "3: 'nan' is no finite number, but a friction coefficient should stand there");
  REQUIRE(refusal(with(two, "0.25", "0.2x")).find("line 5: '0.2x' is no finite number") != std::string::npos);
  REQUIRE(refusal(with(two, "1 0 0.1", "1 2 0.1")).find("line 8: '2' is no whole number from 0 to 1") !=
          std::string::npos);
  REQUIRE(refusal(with(two, "1 0 0.1", "1 1 0.1")) ==
          at + "8: block (1, 1) is given twice, first on line 7; take one of them out");
  REQUIRE(refusal(with(with(two, "2 3", "2 4"), "1 0 0.1", "1 0 0 0 0 0 0 0 0 0 0\n1 0 0.1")) ==
          at + "9: block (1, 0) is given twice, first on line 8; take one of them out");
  const std::string symmetric = with(two, "gen", "sym");
  REQUIRE(refusal(symmetric) == at + "6: W_10 of contact 0 is 0.2 and W_01 is 0.1, but a file of the form 'sym' is symmetric; "
                                     "write 'gen' if W is not");
  REQUIRE(refusal(with(two, "1 1 5", "1 0 5")) == at + "8: block (1, 0) is given twice, first on line 7; take one of them out");
  REQUIRE(refusal(with(two, "1 1 5", "1 1 0")) == at + "7: W_00 of contact 1 is 0 and must be > 0");
  REQUIRE(refusal(with(two, " 0.9\n", "\n")) ==
          at + "9: the file ends where an entry of a block should stand");
  REQUIRE(refusal(two + "1") == at + "9: the file goes on after its last block");
  REQUIRE(refusal(with(two, "2 3", "2 1")).find("the file goes on") != std::string::npos);
  REQUIRE(refusal(with(with(two, "2 3", "2 2"), "1 1 5 0 0 0 6 0 0 0 7\n", "")) ==
          at + "8: the diagonal block of contact 1 is missing");
  REQUIRE_THROWS_WITH(read_problem("no/such/file.fcp"), Catch::Contains("cannot open 'no/such/file.fcp'"));
}

TEST_CASE("the problem files at DELASSUS_PROBLEMS are read, and written back to the bit") {
  const char* folder = std::getenv("DELASSUS_PROBLEMS");
  if (folder == nullptr) {
    WARN("DELASSUS_PROBLEMS is not set: nothing read");
    return;
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".fcp") continue;
    CAPTURE(entry.path().string());
    const FrictionProblem p = read_problem(entry.path().string());
    REQUIRE(p.rows.pool<0>().items() > 0);
    REQUIRE(same_bits(p, parse_problem(problem_text(p), "again")));
    auto guess = entry.path();
    guess.replace_extension(".guess");
    if (std::filesystem::exists(guess))
      REQUIRE(read_impulses(guess.string(), p.rows.pool<0>().items()).size() ==
              p.rows.pool<0>().lambda.size());
    ++files;
  }
  REQUIRE(files > 0);
}
