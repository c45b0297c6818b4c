// Draws docs/theory/haptic_wall.svg: a hand presses a tool on a stiff wall, with the force from ticks at 1 kHz and with the force of
// the loop at 30 Hz. The runs are those of the tests.
#include "../../../tests/haptics/wall.hpp"

#include <cstdio>

namespace {

constexpr double left = 70, top = 50, width = 640, panel = 170, gap = 50;

struct Axis {
  double low, high, start;  ///< range of the quantity, and the y of `high`
  double y(double value) const { return start + panel * (high - value) / (high - low); }
};

void curve(std::FILE* out, const std::vector<wall::Sample>& run, double wall::Sample::*value, double scale, const Axis& axis,
           const char* colour) {
  std::fprintf(out, "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.4\" points=\"", colour);
  for (std::size_t n = 0; n < run.size(); n += 4)
    std::fprintf(out, "%.1f,%.1f ", left + width * run[n].time / 3, axis.y(scale * run[n].*value));
  std::fprintf(out, "\"/>\n");
}

void frame(std::FILE* out, const Axis& axis, const char* title, double step) {
  std::fprintf(out, "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"none\" stroke=\"#999\"/>\n", left, axis.start, width, panel);
  std::fprintf(out, "<text x=\"%g\" y=\"%g\">%s</text>\n", left, axis.start - 8, title);
  for (double v = axis.low; v <= axis.high + 1e-9; v += step)
    std::fprintf(out, "<text x=\"%g\" y=\"%.1f\" text-anchor=\"end\">%g</text><line x1=\"%g\" x2=\"%g\" y1=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n",
                 left - 8, axis.y(v) + 4, v, left, left + width, axis.y(v), axis.y(v));
}

}  // namespace

int main(int count, char** names) {
  std::FILE* out = std::fopen(count > 1 ? names[1] : "haptic_wall.svg", "w");
  if (!out) return std::fprintf(stderr, "cannot write the figure\n"), 1;
  const auto ticks = wall::press({.max_force = 8});
  const auto direct = wall::press({.display = wall::Display::direct, .max_force = 8});
  const Axis place{-40, 60, top}, force{-10, 10, top + panel + gap}, energy{-8, 1, top + 2 * (panel + gap)};
  std::fprintf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"740\" height=\"%g\" font-family=\"sans-serif\" font-size=\"12\">\n",
               top + 3 * panel + 2 * gap + 45);
  std::fprintf(out, "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n");
  std::fprintf(out, "<text x=\"%g\" y=\"20\"><tspan fill=\"#c33\">force of the loop, 30 Hz</tspan>    <tspan fill=\"#06c\">tick, 1 kHz</tspan></text>\n", left);
  frame(out, place, "device, mm above the surface", 20);
  frame(out, force, "force on the hand, N (the motors give 8 N)", 5);
  frame(out, energy, "energy the display took in, J: below zero it gives out", 3);
  for (const auto& [run, colour] : {std::pair{&direct, "#c33"}, std::pair{&ticks, "#06c"}}) {
    curve(out, *run, &wall::Sample::position, 1e3, place, colour);
    curve(out, *run, &wall::Sample::force, 1, force, colour);
    curve(out, *run, &wall::Sample::energy, 1, energy, colour);
  }
  for (int s = 0; s <= 3; ++s)
    std::fprintf(out, "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">%d s</text>\n", left + width * s / 3, energy.start + panel + 18, s);
  std::fprintf(out, "</svg>\n");
  std::fclose(out);
  std::printf("rests at %.3f mm with %.4f N; the loop's force swings by %.1f mm\n", 1e3 * ticks.back().position, ticks.back().force,
              1e3 * wall::swing(direct));
}
