/// Numbers, choices and sentences out of the bytes that a fuzzer gives.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string>

/// What a fuzzer calls; 0 always. Every program of this folder has one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fuzz {

/// Ends the program with a sentence: the fuzzer keeps the input, the replay fails.
inline void expect(bool holds, const std::string& sentence) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n", sentence.c_str());
  std::abort();
}

/// Reads an input from its front; behind its end everything is zero, so that every input says something.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  bool is_empty() const { return at_ == end_; }
  std::uint8_t byte() { return at_ == end_ ? std::uint8_t(0) : *at_++; }
  /// 0, 1, … n − 1.
  int below(int n) { return byte() % n; }
  bool chance(int of_256) { return byte() < of_256; }

  /// In [low, high], in 65 536 places.
  double between(double low, double high) {
    const int more = byte(), less = byte();
    return low + (high - low) * (256 * more + less) / 65535;
  }
  /// A positive number, every magnitude from 10^low to 10^high alike.
  double magnitude(double low, double high) { return std::pow(10.0, between(low, high)); }

  /// One of the numbers that programs forget.
  double odd() {
    ++odd_count_;
    constexpr double inf = std::numeric_limits<double>::infinity(),
                     tiny = std::numeric_limits<double>::denorm_min();
    constexpr double list[] = {0,     -0.0,   1,    -1,     1e-30, 1e30,
                               -1e30, 1e-300, tiny, inf,    -inf,  1e300,
                               1e16,  1e-16,  1e-8, 1e8,    1e4,   1e-4,
                               -1e-4, 0.5,    2,    -1e300, 1e150, std::numeric_limits<double>::quiet_NaN()};
    const double number = list[below(int(std::size(list)))];
    gave_nan_ = gave_nan_ || std::isnan(number);
    return number;
  }
  /// How many odd numbers there were so far, and whether NaN was among them since `forget_nan`.
  int odd_count() const { return odd_count_; }
  bool gave_nan() const { return gave_nan_; }
  void forget_nan() { gave_nan_ = false; }

  /// In [−size, size], or an odd one (three of ten) where `is_wild`.
  double number(double size, bool is_wild) { return is_wild && chance(77) ? odd() : between(-size, size); }

 private:
  const std::uint8_t *at_, *end_;
  int odd_count_ = 0;
  bool gave_nan_ = false;
};

}  // namespace fuzz
