// One sweep over a pool of Coulomb contacts with W assembled: compiled_to.py looks for calls in its loop.
#include <delassus/delassus.hpp>

using namespace delassus;

using Loop = AnimationLoop<World<RigidBodies>, Constraints<Contact<Coulomb>>>;
using Given = decltype(std::declval<const Loop&>().problem());
using Book = LawSet<Constraints<Contact<Coulomb>>, double>;
using OneIsland = IslandProblem<Book, Given::Rows, decltype(Given::W), NoObserver>;

extern "C" [[gnu::noinline]] double one_sweep(OneIsland& island) { return island.sweep(); }

int main() {
  Loop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.step(1e-3);
  Given problem = loop.problem();
  Book book(problem.laws);
  book.prepare(problem.W, problem.rows, problem.h);
  NoObserver nobody;
  OneIsland island(book, problem.rows, problem.W, problem.islands, 0, problem.h, nobody);
  return one_sweep(island) >= 0 ? 0 : 1;
}
