/// A logarithmic axis, and numbers with the prefixes of the SI.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/io/inner/text.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace delassus::inner {

/// [low, high], both > 0, widened to a tenth of a decade on each side and to one decade at least, on [start,
/// end] px.
class LogAxis {
 public:
  LogAxis() = default;
  LogAxis(double low, double high, double start, double end) : start_(start), end_(end) {
    low_ = std::log10(low) - 0.1;
    high_ = std::log10(high) + 0.1;
    const double missing = 1 - (high_ - low_);
    if (missing > 0) low_ -= missing / 2, high_ += missing / 2;
  }

  /// Where a value stands; what lies beyond, zero included, stands on the edge.
  double at(double value) const {
    const double place = value > 0 ? std::clamp(std::log10(value), low_, high_) : low_;
    return start_ + (end_ - start_) * (place - low_) / (high_ - low_);
  }
  /// Powers of ten within the range, at most about ten of them.
  std::vector<double> decades() const {
    std::vector<double> values;
    const int every = 1 + int((high_ - low_) / 10.5);
    for (int k = int(std::ceil(low_)); k <= int(std::floor(high_)); ++k)
      if (k % every == 0) values.push_back(std::pow(10.0, k));
    return values;
  }

 private:
  double low_ = 0, high_ = 1, start_ = 0, end_ = 1;
};

/// 10⁻⁷.
inline std::string power_of_ten(int exponent) {
  static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[c - '0'];
  return text;
}

/// 0.00123 m: "1.23 mm". Units that take no prefix, or sizes beyond them, get a power of ten.
inline std::string with_prefix(double value, std::string_view unit) {
  const std::string in = unit == "1" || unit.empty() ? "" : " " + std::string(unit);
  if (!(value > 0) || !std::isfinite(value)) return number_text(value, 3) + in;
  const double rounded = std::strtod(number_text(value, 3).c_str(), nullptr);
  const int exponent = int(std::floor(std::log10(rounded) + 1e-12));
  static constexpr const char* prefixes[] = {"f", "p", "n", "µ", "m", ""};
  const int third = int(std::floor(exponent / 3.0));
  const bool takes_prefix = unit == "m" || unit == "s" || unit == "J" || unit == "N" || unit == "rad";
  if (takes_prefix && third >= -5 && third < 0)
    return number_text(value * std::pow(10.0, -3 * third), 3) + " " + prefixes[third + 5] + std::string(unit);
  if (exponent >= -3 && exponent < 5) return number_text(rounded, 5) + in;
  const double mantissa = rounded / std::pow(10.0, exponent);
  return (std::abs(mantissa - 1) < 1e-9 ? "" : number_text(mantissa, 3) + "·") + power_of_ten(exponent) + in;
}

}  // namespace delassus::inner
