#include "bench/text_table.hpp"

#include <algorithm>

namespace rilo {

namespace {

// Code points: continuation bytes of UTF-8 do not count.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string cell_of(const std::vector<std::string>& row, std::size_t column) {
  return column < row.size() ? row[column] : std::string();
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Neither the end of a cell nor the beginning of an HTML element.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : one_line(text)) result += c == '|' || c == '<' ? std::string{'\\', c} : std::string(1, c);
  return result;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

std::string TextTable::plain() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < header.size(); ++i) {
    widths.push_back(width(header[i]));
    for (const auto& row : rows) widths[i] = std::max(widths[i], width(cell_of(row, i)));
  }
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text;
    for (std::size_t i = 0; i < header.size(); ++i) {
      const std::string cell = one_line(cell_of(row, i));
      const std::string blanks(widths[i] - width(cell), ' ');
      if (i > 0) text += "  ";
      text += i < left ? cell + blanks : blanks + cell;
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text + "\n";
  };
  std::string text = line(header);
  for (const auto& row : rows) text += line(row);
  return text;
}

std::string TextTable::markdown() const {
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text = "|";
    for (std::size_t i = 0; i < header.size(); ++i) {
      text += ' ';
      text += escaped(cell_of(row, i));
      text += " |";
    }
    return text + "\n";
  };
  std::string text = line(header) + "|";
  for (std::size_t i = 0; i < header.size(); ++i) text += i < left ? "---|" : "---:|";
  text += "\n";
  for (const auto& row : rows) text += line(row);
  return text;
}

std::string TextTable::csv() const {
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (i > 0) text += ',';
      text += csv_cell(cell_of(row, i));
    }
    return text + "\n";
  };
  std::string text = line(header);
  for (const auto& row : rows) text += line(row);
  return text;
}

}  // namespace rilo
