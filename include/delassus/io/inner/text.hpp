/// Numbers, words and bytes as JSON, HTML and CSV want them, the same in every locale.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace delassus::inner {

/// A number with at most `digits` significant digits, without trailing zeros, from 17 on the fewest that read
/// back as the same number; "nan" and "inf" where it is neither.
inline std::string number_text(double value, int digits) {
  char buffer[40], *end = buffer + sizeof buffer;
  constexpr auto format = std::chars_format::general;
  end = digits < 17 ? std::to_chars(buffer, end, value, format, digits).ptr
                    : std::to_chars(buffer, end, value, format).ptr;
  return std::string(buffer, end);
}

/// A JSON number; JSON knows neither nan nor inf, so they become null.
inline void append_number(std::string& out, double value, int digits = 7) {
  out += std::isfinite(value) ? number_text(value, digits) : "null";
}

/// A JSON string. `<` is written as an escape too, so that no text can end the <script> element that holds
/// it.
inline void append_string(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '<' || (c >= 0 && c < 0x20)) {
      char buffer[8];
      std::snprintf(buffer, sizeof buffer, "\\u%04x", unsigned(c));
      out += buffer;
    } else {
      out += c;
    }
  }
  out += '"';
}

/// Text that HTML shows as it is, inside an element or an attribute.
inline std::string html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

/// Bytes as base64, padded.
inline void append_base64(std::string& out, std::string_view bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return k < bytes.size() ? std::uint32_t(std::uint8_t(bytes[k])) : 0u;
    };
    const std::uint32_t three = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    out += digits[three >> 18];
    out += digits[three >> 12 & 63];
    out += i + 1 < bytes.size() ? digits[three >> 6 & 63] : '=';
    out += i + 2 < bytes.size() ? digits[three & 63] : '=';
  }
}

/// Writes a whole file; throws InvalidArgument naming it when that fails.
inline void write_file(const std::string& path, std::string_view content) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  DELASSUS_EXPECT(file != nullptr,
                  "cannot open '" + path + "' for writing; does its folder exist, and may you write there?");
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  const bool closed = std::fclose(file) == 0;
  DELASSUS_EXPECT(written && closed, "cannot write all of '" + path + "'; is the disk full?");
}

}  // namespace delassus::inner
