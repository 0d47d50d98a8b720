#include "io/folder_files.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "io/text.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

bool is_digit(char letter) { return std::isdigit(static_cast<unsigned char>(letter)) != 0; }

// The number that starts at `place`, without leading zeros; moves `place` behind it.
std::string_view take_number(std::string_view text, std::size_t& place) {
  while (place + 1 < text.size() && text[place] == '0' && is_digit(text[place + 1])) ++place;
  const std::size_t begin = place;
  while (place < text.size() && is_digit(text[place])) ++place;
  return text.substr(begin, place - begin);
}

}  // namespace

std::string last_name(const fs::path& path) {
  const fs::path plain = path.lexically_normal();
  return (plain.has_filename() ? plain : plain.parent_path()).filename().string();
}

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t k = 0;
  while (i < a.size() && k < b.size()) {
    if (is_digit(a[i]) && is_digit(b[k])) {
      const std::string_view first = take_number(a, i);
      const std::string_view second = take_number(b, k);
      if (first.size() != second.size()) return first.size() < second.size();
      if (first != second) return first < second;
    } else {
      if (a[i] != b[k]) return a[i] < b[k];
      ++i;
      ++k;
    }
  }
  if ((i < a.size()) != (k < b.size())) return k < b.size();
  return a < b;  // 1.bin and 01.bin: some order, always the same
}

void sort_naturally(std::vector<fs::path>& files) {
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
}

bool is_hidden(const fs::path& file) { return file.filename().string().front() == '.'; }

std::vector<fs::path> files_that(const fs::path& folder, const std::function<bool(const fs::path&)>& wanted) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!is_hidden(entry->path()) && wanted(entry->path())) files.push_back(entry->path());
  }
  sort_naturally(files);
  return files;
}

std::vector<fs::path> files_with(const fs::path& folder, std::initializer_list<std::string_view> extensions) {
  return files_that(folder, [&](const fs::path& file) {
    const std::string extension = lower_case(file.extension().string());
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
  });
}

}  // namespace rilo::detail
