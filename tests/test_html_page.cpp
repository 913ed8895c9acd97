#include <catch2/catch.hpp>

#include "markup.hpp"
#include "quadedge/error.hpp"
#include "report/html_page.hpp"
#include "report/svg_plot.hpp"

using namespace quadedge;
using namespace quadedge::report;

namespace {

std::vector<std::uint8_t> bytes(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace

TEST_CASE("Base64 is that of RFC 4648", "[report]") {
  CHECK(base64(bytes("")).empty());
  CHECK(base64(bytes("f")) == "Zg==");
  CHECK(base64(bytes("fo")) == "Zm8=");
  CHECK(base64(bytes("foo")) == "Zm9v");
  CHECK(base64(bytes("foobar")) == "Zm9vYmFy");
  CHECK(base64({0xFB, 0xFF, 0x00}) == "+/8A");
}

TEST_CASE("A page holds everything it shows and leads nowhere else", "[report]") {
  HtmlPage page("Report <of> \"everything\" & more");
  page.heading(2, "Tables");
  page.paragraph("1 < 2 & 3 > 2");
  page.definitions({{"paired", "edges & counterparts"}});
  HtmlTable table;
  table.caption = "Table 1";
  table.groups = {{"", 1}, {"paired", 2}};
  table.columns = {"filter", "recall [%]", "precision [%]"};
  table.rows = {{"baseline", "100.0", "0.1"}, {"best <b>", "98.0", "98.1"}};
  table.last_row_counts = true;
  page.table(table);
  page.heading(2, "Pictures");
  page.heading(3, "Plots");
  Plot plot;
  plot.add_line("line", {0, 1}, {0, 1});
  page.begin_fold("more", false);
  page.plots({plot.svg(), plot.svg()}, "two plots");
  page.picture(bytes("not really a picture"), "image/png", "a \"picture\"");
  page.end_fold();
  const std::string html = page.html();
  CHECK(is_well_formed(html));
  CHECK(outside_references(html).empty());
  CHECK(html.find("best &lt;b&gt;") != std::string::npos);
  CHECK(html.find("<tr class=\"result\"><td>best") != std::string::npos);
  CHECK(html.find("<th colspan=\"2\">paired") != std::string::npos);
  CHECK(html.find("src=\"data:image/png;base64,bm90IHJlYWxseSBhIHBpY3R1cmU=\"") != std::string::npos);
  // The contents lead to the headings of level 2.
  const auto targets = all_matches(html, "href=\"#([^\"]+)"), ids = all_matches(html, "<h2 id=\"([^\"]+)");
  CHECK(targets.size() == 2);
  CHECK(targets == ids);
}

TEST_CASE("The check for outside references finds them", "[report]") {
  CHECK(outside_references("<img src=\"http://example.org/a.png\"/>").size() == 1);
  CHECK(outside_references("<a href=\"other.html\">").size() == 1);
  CHECK(outside_references("<script>").size() == 1);
  CHECK_FALSE(is_well_formed("<a><b></a>"));
}

TEST_CASE("A table refuses rows of another length", "[report]") {
  HtmlPage page("page");
  HtmlTable table;
  table.columns = {"one", "two"};
  table.rows = {{"only"}};
  CHECK_THROWS_AS(page.table(table), UsageError);
}
