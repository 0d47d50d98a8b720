#include "notebook.hpp"

namespace rilo::python {

namespace {

std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '&':
        html += "&amp;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

}  // namespace

std::string html_table(const std::string& title, const HtmlRows& rows) {
  std::string html =
      "<table><thead><tr><th colspan=\"2\" style=\"text-align:left\">" + escaped(title) + "</th></tr></thead><tbody>";
  for (const auto& [name, value] : rows) {
    html += "<tr><td style=\"text-align:left\">" + escaped(name) + "</td><td style=\"text-align:left\">" +
            escaped(value) + "</td></tr>";
  }
  return html + "</tbody></table>";
}

}  // namespace rilo::python
