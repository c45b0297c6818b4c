// expect: delassus: an integrator with move(step), such as NewtonMidpoint, makes its step at once, without W
#include <delassus/delassus.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Particles{}}, RungeKutta4{}, PredictiveScheme{}};
  loop.step(1e-3);
}
