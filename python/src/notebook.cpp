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

pybind11::str python_text(const std::string& bytes) {
  return pybind11::reinterpret_steal<pybind11::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace"));
}

pybind11::str html_table(const std::string& title, const HtmlRows& rows) {
  std::string html =
      "<table><thead><tr><th colspan=\"2\" style=\"text-align:left\">" + escaped(title) + "</th></tr></thead><tbody>";
  for (const auto& [name, value] : rows) {
    html += "<tr><td style=\"text-align:left\">" + escaped(name) + "</td><td style=\"text-align:left\">" +
            escaped(value) + "</td></tr>";
  }
  return python_text(html + "</tbody></table>");
}

}  // namespace rilo::python
