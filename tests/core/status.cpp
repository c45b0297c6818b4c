#include <delassus/core/status.hpp>

#include <string>

#include "catch.hpp"

using delassus::Status;

TEST_CASE("the worse of two statuses does not depend on their order") {
  REQUIRE(worse(Status::converged, Status::quarantined) == Status::quarantined);
  REQUIRE(worse(Status::quarantined, Status::converged) == Status::quarantined);
  REQUIRE(worse(Status::stalled, Status::max_iterations) == Status::max_iterations);
}

TEST_CASE("every status has a name of its own") {
  REQUIRE(name(Status::converged) == std::string("converged"));
  REQUIRE(name(Status::stalled) == std::string("stalled"));
  REQUIRE(name(Status::max_iterations) == std::string("max_iterations"));
  REQUIRE(name(Status::deadline) == std::string("deadline"));
  REQUIRE(name(Status::unclaimed_contact) == std::string("unclaimed_contact"));
  REQUIRE(name(Status::quarantined) == std::string("quarantined"));
}
