// expect: delassus: a sheet needs a law of two constants that turns with it; write Corotational or StVenantKirchhoff
#include <delassus/fem/cloth.hpp>
#include <delassus/fem/elasticity/linear.hpp>

using namespace delassus;

int main() {
  Cloth<Linear> set;
  set.add({.mesh = sheet(1, 1, {2, 2}, 1e-3)});
  return set.elastic_energy() > 0;
}
