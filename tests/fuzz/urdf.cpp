// The reader of URDF: whatever the text, there is a sound description, or a sentence with file and line.
#include "bytes.hpp"

#include <delassus/adapters/urdf.hpp>

#include <string>

using namespace delassus;
using fuzz::expect;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  // The first byte says what holds the root, and whether what would be passed over is refused.
  const UrdfOptions options{.base = Base(data[0] / 2 % 3), .strict = data[0] % 2 == 1, .meshes = "/nowhere"};
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const Model model = parse_urdf(text, "input", options);
    check(model);
    expect(!options.strict || model.skipped.empty(), "something was passed over in spite of `strict`");
    for (const std::string& line : model.skipped)
      expect(line.starts_with("input:"), "what was passed over has no file and line: " + line);
    for (const model::Joint& joint : model.joints)
      expect(options.base != Base::fixed || &joint != model.joints.data() ||
                 joint.kind != model::JointKind::free || text.find("floating") != text.npos,
             "a fixed base is free");
  } catch (const InvalidArgument& refused) {
    const std::string sentence = refused.what();
    expect(sentence.starts_with("delassus: input:") && sentence.size() > 25,
           "a refusal has no file and line: " + sentence);
  }
  return 0;
}
