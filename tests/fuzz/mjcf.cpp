// The reader of MJCF: whatever the text, there is a machine that could be built, or a sentence with file and
// line.
#include "bytes.hpp"

#include <delassus/adapters/mjcf.hpp>

#include <string>

using namespace delassus;
using fuzz::expect;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  // The first byte says whether what would be left out is refused.
  const bool is_strict = data[0] % 2 == 1;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const Model model = parse_mjcf(text, "input", {.strict = is_strict, .most_elements = 5000});
    expect(!is_strict || model.skipped.empty(), "something was left out in spite of `strict`");
    expect(model.bodies.size() + model.joints.size() + model.geometries.size() <= 5000,
           "more was made than may be");
    for (const model::Body& body : model.bodies)
      expect(body.mass >= 0 && is_finite(body.inertia), "a mass or an inertia that was read is none");
    for (const std::string& line : model.skipped)
      expect(line.starts_with("input:"), "what was left out has no file and line: " + line);
  } catch (const InvalidArgument& refused) {
    const std::string sentence = refused.what();
    expect(sentence.starts_with("delassus: input:") && sentence.size() > 25,
           "a refusal has no file and line: " + sentence);
  }
  return 0;
}
