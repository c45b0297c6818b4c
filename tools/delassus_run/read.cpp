// A model from a file of either kind.
#include "read.hpp"

#include <delassus/adapters/mjcf.hpp>
#include <delassus/adapters/urdf.hpp>

#include <string>
#include <string_view>
#include <utility>

namespace delassus_run {

namespace {

/// The name of the first element of an XML text, past what stands before it; empty where there is none.
std::string_view root_element(std::string_view text) {
  std::size_t at = 0;
  const auto pass = [&](std::string_view end) {
    const std::size_t found = text.find(end, at);
    at = found == text.npos ? text.size() : found + end.size();
  };
  while ((at = text.find('<', at)) != text.npos) {
    if (text.substr(at, 4) == "<!--")
      pass("-->");
    else if (text.substr(at, 2) == "<?")
      pass("?>");
    else if (text.substr(at, 2) == "<!")
      pass(">");
    else
      return text.substr(at + 1, text.find_first_of(" \t\r\n/>", at) - at - 1);
  }
  return {};
}

bool is_urdf(const std::string& path) {
  if (path.ends_with(".urdf")) return true;
  return !path.ends_with(".mjcf") && root_element(inner::read_text(path)) == "robot";
}

}  // namespace

std::string in_words_of_options(std::string sentence) {
  static constexpr std::pair<std::string_view, std::string_view> words[] = {
      {"UrdfOptions::meshes and packages say", "--meshes and --package say"},
      {"name its folder in MjcfOptions::files", "name its folder by --meshes"},
      {"delassus: ", ""}};
  for (const auto& [library, own] : words)
    if (const std::size_t at = sentence.find(library); at != sentence.npos)
      sentence.replace(at, library.size(), own);
  return sentence;
}

Model read(const std::string& path, const Options& options) {
  if (!is_urdf(path)) {
    MjcfOptions words{.strict = options.is_strict, .files = {}};
    if (!options.meshes.empty()) words.files.push_back(options.meshes);
    return read_mjcf(path, words);
  }
  UrdfOptions words{.strict = options.is_strict, .meshes = options.meshes};
  for (const std::string& package : options.packages)
    words.packages[package.substr(0, package.find('='))] = package.substr(package.find('=') + 1);
  Model model = read_urdf(path, words);
  for (model::Geometry& geometry : model.geometries) geometry.friction = usual_friction;  // it says none
  return model;
}

}  // namespace delassus_run
