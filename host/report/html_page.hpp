#pragma once
/// \file html_page.hpp  One self-contained HTML page: tables, plots and pictures in a file that needs no network.

#include <cstdint>
#include <string>
#include <vector>

namespace quadedge::report {

/// A table of texts. The first column is left-aligned, the others are numbers and right-aligned. A cell may have
/// several lines.
struct HtmlTable {
  /// One cell of the heading; `span`: columns that it stands over.
  struct Heading {
    std::string text;
    int span = 1;
  };
  std::string caption;
  std::vector<Heading> groups;  ///< an upper line of the heading; may be empty
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
  bool last_row_counts = false;                ///< the last row is the result and printed bold
};

/// Collects a page from top to bottom. All texts are escaped here.
class HtmlPage {
 public:
  explicit HtmlPage(const std::string& title);

  /// A heading of level 2 (listed in the contents at the top) or 3.
  void heading(int level, const std::string& text);
  void paragraph(const std::string& text);
  /// A list of terms and what they mean or hold.
  void definitions(const std::vector<std::pair<std::string, std::string>>& entries);
  /// \throws UsageError for a row that is not as long as the heading.
  void table(const HtmlTable& table);
  /// Plots (svg() of Plot or BarChart) side by side, as many as fit, with a caption below that may be empty.
  void plots(const std::vector<std::string>& svgs, const std::string& caption);
  /// A picture in its encoded bytes; `type` is its media type, "image/png" or "image/jpeg".
  void picture(const std::vector<std::uint8_t>& bytes, const std::string& type, const std::string& caption);
  /// Small pictures side by side, as many as fit, each with its own caption.
  struct Picture {
    std::vector<std::uint8_t> bytes;
    std::string type, caption;
  };
  void pictures(const std::vector<Picture>& pictures);
  /// What follows until end_fold() is hidden behind a line that opens it with a click.
  void begin_fold(const std::string& summary, bool open);
  void end_fold();

  /// The finished page.
  std::string html() const;

 private:
  struct Entry {
    std::string id, text;
  };
  std::string title_, body_;
  std::vector<Entry> contents_;
};

/// RFC 4648, with padding.
std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace quadedge::report
