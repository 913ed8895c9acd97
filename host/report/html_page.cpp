#include "report/html_page.hpp"

#include <algorithm>

#include "quadedge/error.hpp"
#include "report/svg.hpp"

namespace quadedge::report {
namespace {

using svg::escape;

constexpr const char* kStyle = R"(
:root{color-scheme:light}
body{font:15px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:#1b1b1b;
  background:#fff;max-width:1300px;margin:0 auto;padding:0 24px 60px}
h1{font-size:26px;margin:26px 0 6px}
h2{font-size:20px;margin:38px 0 8px;padding-top:10px;border-top:2px solid #ddd}
h3{font-size:16px;margin:26px 0 6px}
p{max-width:860px;margin:8px 0}
nav{margin:10px 0 0}
nav a{display:inline-block;margin:0 18px 4px 0;color:#0a58a8;text-decoration:none}
nav a:hover{text-decoration:underline}
table{border-collapse:collapse;margin:12px 0 16px;font-size:13px;font-variant-numeric:tabular-nums}
caption{caption-side:top;text-align:left;font-weight:600;padding:0 0 5px;white-space:nowrap}
th,td{padding:3px 9px;border-bottom:1px solid #e3e3e3;text-align:right;white-space:pre}
th:first-child,td:first-child{text-align:left}
thead th{background:#f4f5f7;border-bottom:1px solid #bbb}
thead tr.groups th{text-align:center;border-left:1px solid #d5d5d5}
tr.result td{font-weight:700;border-top:1px solid #999}
.scroll{overflow-x:auto}
dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 18px;max-width:1000px;margin:10px 0;font-size:14px}
dt{font-weight:600}dd{margin:0}
figure{margin:14px 0 20px}
figure.plots>div{display:flex;flex-wrap:wrap;gap:10px 14px}
figure svg{background:#fff}
figure img{max-width:100%;height:auto;display:block;border:1px solid #ccc}
.pictures{display:flex;flex-wrap:wrap;gap:0 14px}
.pictures figure{width:calc(25% - 11px);min-width:260px;margin:8px 0 4px}
.pictures img{width:100%}
figcaption{font-size:13px;color:#444;max-width:960px;margin-top:6px}
details{margin:12px 0;border:1px solid #ddd;border-radius:4px;padding:0 14px}
summary{cursor:pointer;font-weight:600;padding:9px 0}
@media print{details>*{display:block}h2{break-before:page}}
)";

}  // namespace

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

HtmlPage::HtmlPage(const std::string& title) : title_(title) {}

void HtmlPage::heading(int level, const std::string& text) {
  const std::string tag = level <= 2 ? "h2" : "h3";
  std::string id;
  if (level <= 2) {
    id = "section" + std::to_string(contents_.size() + 1);
    contents_.push_back({id, text});
  }
  body_ += "<" + tag + (id.empty() ? "" : " id=\"" + id + "\"") + ">" + escape(text) + "</" + tag + ">\n";
}

void HtmlPage::paragraph(const std::string& text) { body_ += "<p>" + escape(text) + "</p>\n"; }

void HtmlPage::definitions(const std::vector<std::pair<std::string, std::string>>& entries) {
  body_ += "<dl>\n";
  for (const auto& entry : entries)
    body_ += "<dt>" + escape(entry.first) + "</dt><dd>" + escape(entry.second) + "</dd>\n";
  body_ += "</dl>\n";
}

void HtmlPage::table(const HtmlTable& table) {
  body_ += "<div class=\"scroll\"><table>";
  if (!table.caption.empty()) body_ += "<caption>" + escape(table.caption) + "</caption>";
  body_ += "<thead>";
  if (!table.groups.empty()) {
    body_ += "<tr class=\"groups\">";
    for (const auto& group : table.groups) {
      body_ += "<th colspan=\"" + std::to_string(group.span) + "\">" + escape(group.text) + "</th>";
    }
    body_ += "</tr>";
  }
  body_ += "<tr>";
  for (const auto& column : table.columns) body_ += "<th>" + escape(column) + "</th>";
  body_ += "</tr></thead><tbody>\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (table.rows[r].size() != table.columns.size()) {
      throw UsageError("table '" + table.caption + "': row " + std::to_string(r) + " has " +
                       std::to_string(table.rows[r].size()) + " cells, expected " +
                       std::to_string(table.columns.size()));
    }
    body_ += table.last_row_counts && r + 1 == table.rows.size() ? "<tr class=\"result\">" : "<tr>";
    for (const auto& cell : table.rows[r]) body_ += "<td>" + escape(cell) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void HtmlPage::plots(const std::vector<std::string>& svgs, const std::string& caption) {
  body_ += "<figure class=\"plots\"><div>\n";
  for (const auto& plot : svgs) body_ += plot;
  body_ += "</div>" + (caption.empty() ? "" : "<figcaption>" + escape(caption) + "</figcaption>") + "</figure>\n";
}

void HtmlPage::picture(const std::vector<std::uint8_t>& bytes, const std::string& type, const std::string& caption) {
  body_ +=
      "<figure><img alt=\"" + escape(caption) + "\" src=\"data:" + escape(type) + ";base64," + base64(bytes) + "\"/>";
  body_ += (caption.empty() ? "" : "<figcaption>" + escape(caption) + "</figcaption>") + std::string("</figure>\n");
}

void HtmlPage::pictures(const std::vector<Picture>& pictures) {
  body_ += "<div class=\"pictures\">\n";
  for (const auto& one : pictures) picture(one.bytes, one.type, one.caption);
  body_ += "</div>\n";
}

void HtmlPage::begin_fold(const std::string& summary, bool open) {
  body_ += std::string("<details") + (open ? " open=\"open\"" : "") + "><summary>" + escape(summary) + "</summary>\n";
}

void HtmlPage::end_fold() { body_ += "</details>\n"; }

std::string HtmlPage::html() const {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/><title>" +
      escape(title_) + "</title><style>" + kStyle + "</style></head><body>\n<h1>" + escape(title_) + "</h1>\n";
  if (contents_.size() > 1) {
    page += "<nav>";
    for (const auto& entry : contents_) page += "<a href=\"#" + entry.id + "\">" + escape(entry.text) + "</a>";
    page += "</nav>\n";
  }
  return page + body_ + "</body></html>\n";
}

}  // namespace quadedge::report
