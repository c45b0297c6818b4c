#include <delassus/io/inner/text.hpp>

#include "catch.hpp"

#include <clocale>
#include <limits>

using namespace delassus;

TEST_CASE("base64 pads to full groups of four") {
  const auto base64 = [](std::string_view bytes) {
    std::string out;
    inner::append_base64(out, bytes);
    return out;
  };
  // The test vectors of RFC 4648, section 10.
  REQUIRE(base64("").empty());
  REQUIRE(base64("f") == "Zg==");
  REQUIRE(base64("fo") == "Zm8=");
  REQUIRE(base64("foo") == "Zm9v");
  REQUIRE(base64("foobar") == "Zm9vYmFy");
  REQUIRE(base64("\xff\xfe\xfd") == "//79");
}

TEST_CASE("a JSON string can neither end itself nor its script element") {
  std::string out;
  inner::append_string(out, "a \"quote\", a \\ and </script>\n");
  REQUIRE(out == R"("a \"quote\", a \\ and \u003c/script>\u000a")");
}

TEST_CASE("HTML shows what was written") {
  REQUIRE(inner::html("a<b> & \"c\"") == "a&lt;b&gt; &amp; &quot;c&quot;");
}

TEST_CASE("numbers are written with a point in every locale") {
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  REQUIRE(inner::number_text(0.25, 3) == "0.25");
  std::setlocale(LC_ALL, "C");
  std::string out;
  inner::append_number(out, std::numeric_limits<double>::quiet_NaN());
  REQUIRE(out == "null");
}

TEST_CASE("a file that cannot be opened is named in one sentence") {
  REQUIRE_THROWS_WITH(
      inner::write_file("/nowhere/page.html", ""),
      "delassus: cannot open '/nowhere/page.html' for writing; does its folder exist, and may you "
      "write there?");
}

TEST_CASE("a full disk is noticed") {
  // /dev/full takes nothing: the flush at the end of the write fails.
  if (std::FILE* full = std::fopen("/dev/full", "r")) {
    std::fclose(full);
    REQUIRE_THROWS_WITH(inner::write_file("/dev/full", "x"),
                        "delassus: cannot write all of '/dev/full'; is the disk full?");
  }
}
