// Tags with many attributes are found, and nothing else is taken for one.
#include <delassus/io/inner/xml_tags.hpp>

#include "catch.hpp"

namespace xml_tags_tests {

using namespace delassus;

TEST_CASE("a tag with more attributes than there may be is found where it begins") {
  const auto longer = [](const std::string& text) { return inner::longer_tag(text, 2); };
  const std::size_t none = std::string::npos;
  CHECK(longer("<a b='1' c=\"2\"/><a b='1' c='2'/>") == none);
  CHECK(longer("<a/> <a b='1' c='2' d='3'/>") == 5);
  CHECK(longer("<a b='1' c = '<' d= '>' e ='3'>") == 0);
  CHECK(longer("<a b='= = =' c=\"'='='='\"/>") == none);
  CHECK(longer("<!-- don't = = = = --><a b='1'/>") == none);
  CHECK(longer("<![CDATA[ <a = = = = ]]> = = = <?xml a='' b='' c='' d=''?> <!DOCTYPE = = = =>") == none);
  for (const char* open : {"<", "<a b='", "<a b=\"", "<!--", "<![CDATA[", "<?", "<!", "<a", ""}) CHECK(longer(open) == none);
}

TEST_CASE("what is said of a text is its first line that is not blank") {
  CHECK(inner::beginning("\n \tbody/>\n<geom/>") == "body/>");
  CHECK(inner::beginning(" \n").empty());
  CHECK(inner::beginning(std::string(50, 'a')) == std::string(40, 'a'));
}

}  // namespace xml_tags_tests
