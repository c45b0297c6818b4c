/// A drawing as SVG text: what a diagram needs of it.
#pragma once

#include <delassus/io/inner/text.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace delassus::inner {

/// Elements in the order in which they are drawn; x to the right and y down, px. Classes are styled by the
/// `style` given at the end.
class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  void rectangle(double x, double y, double width, double height, std::string_view cls) {
    open("rect", cls);
    place("x", x), place("y", y), place("width", width), place("height", height);
    body_ += "/>\n";
  }
  void line(double x1, double y1, double x2, double y2, std::string_view cls) {
    open("line", cls);
    place("x1", x1), place("y1", y1), place("x2", x2), place("y2", y2);
    body_ += "/>\n";
  }
  void polyline(const std::vector<std::pair<double, double>>& points, std::string_view cls) {
    open("polyline", cls);
    body_ += " points=\"";
    for (const auto& [x, y] : points) body_ += number_text(x, 5) + "," + number_text(y, 5) + " ";
    body_ += "\"/>\n";
  }
  /// anchor: start, middle or end.
  void text(double x, double y, std::string_view words, std::string_view cls = "",
            std::string_view anchor = "start", double turn = 0) {
    open("text", cls);
    place("x", x), place("y", y);
    if (anchor != "start") body_ += " text-anchor=\"" + std::string(anchor) + "\"";
    if (turn != 0)
      body_ += " transform=\"rotate(" + number_text(turn, 4) + " " + number_text(x, 5) + " " +
               number_text(y, 5) + ")\"";
    body_ += ">" + html(words) + "</text>\n";
  }
  /// One of `marker_count` shapes about (x, y), 2 `size` wide; `hint` is shown where the pointer rests.
  static constexpr int marker_count = 5;
  void marker(int shape, double x, double y, double size, std::string_view cls, std::string_view hint = "") {
    const auto at = [&](double dx, double dy) {
      return number_text(x + size * dx, 5) + " " + number_text(y + size * dy, 5);
    };
    open("path", cls);
    body_ += " d=\"";
    switch (shape % marker_count) {
      case 0:  // disc
        body_ += "M" + at(-1, 0) + "a" + number_text(size, 3) + " " + number_text(size, 3) + " 0 1 0 " +
                 number_text(2 * size, 3) + " 0a" + number_text(size, 3) + " " + number_text(size, 3) +
                 " 0 1 0 " + number_text(-2 * size, 3) + " 0z";
        break;
      case 1:
        body_ += "M" + at(-.9, -.9) + "L" + at(.9, -.9) + "L" + at(.9, .9) + "L" + at(-.9, .9) + "z";
        break;
      case 2:
        body_ += "M" + at(0, -1.2) + "L" + at(1.1, .8) + "L" + at(-1.1, .8) + "z";
        break;
      case 3:
        body_ += "M" + at(0, -1.3) + "L" + at(1.2, 0) + "L" + at(0, 1.3) + "L" + at(-1.2, 0) + "z";
        break;
      case 4:
        body_ += "M" + at(0, 1.2) + "L" + at(1.1, -.8) + "L" + at(-1.1, -.8) + "z";
        break;
    }
    body_ += "\"";
    close("path", hint);
  }
  void cross(double x, double y, double size, std::string_view cls, std::string_view hint = "") {
    const auto at = [&](double dx, double dy) {
      return number_text(x + dx, 5) + " " + number_text(y + dy, 5);
    };
    open("path", cls);
    body_ += " d=\"M" + at(-size, -size) + "L" + at(size, size) + "M" + at(-size, size) + "L" +
             at(size, -size) + "\"";
    close("path", hint);
  }

  std::string text_of(std::string_view title, std::string_view description, std::string_view style) const {
    const std::string size = number_text(width_, 6) + " " + number_text(height_, 6);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" width=\"" +
           number_text(width_, 6) + "\" height=\"" + number_text(height_, 6) +
           "\" role=\"img\" aria-labelledby=\"title description\">\n<title id=\"title\">" + html(title) +
           "</title>\n<desc id=\"description\">" + html(description) + "</desc>\n<style>" +
           std::string(style) + "</style>\n" + body_ + "</svg>\n";
  }

 private:
  void open(const char* tag, std::string_view cls) {
    body_ += std::string("<") + tag;
    if (!cls.empty()) body_ += " class=\"" + std::string(cls) + "\"";
  }
  void place(const char* name, double value) {
    body_ += std::string(" ") + name + "=\"" + number_text(value, 5) + "\"";
  }
  void close(const char* tag, std::string_view hint) {
    body_ += hint.empty() ? "/>\n" : "><title>" + html(hint) + "</title></" + tag + ">\n";
  }

  double width_, height_;
  std::string body_;
};

}  // namespace delassus::inner
