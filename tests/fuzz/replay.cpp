// Runs every file of the folders it is given through the program it is linked to: what a fuzzer found once,
// any compiler looks at in every run of the tests.
#include "bytes.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

int main(int count, char** words) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i)
    for (const auto& entry : std::filesystem::directory_iterator(words[i])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    fuzz::expect(!file.bad(), "cannot read " + path.string());
    std::printf("%s\n", path.filename().c_str());
    std::fflush(stdout);  // the last name is the input that ended the program
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  fuzz::expect(!files.empty(), "there is no input to replay");
  std::printf("%zu inputs\n", files.size());
}
