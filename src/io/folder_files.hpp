// What lies in a folder, and what it is called.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace rilo::detail {

/// Last part of a path, also when it ends in a slash.
std::string last_name(const std::filesystem::path& path);

/// Numbers inside the names count as numbers: 2.bin comes before 10.bin.
bool natural_less(const std::string& a, const std::string& b);
void sort_naturally(std::vector<std::filesystem::path>& files);

/// macOS puts ._NAME beside NAME where a disk cannot hold its attributes: never data.
bool is_hidden(const std::filesystem::path& file);

/// What lies in `folder` and is `wanted`, in natural order, hidden files left out; nothing where it cannot be listed.
std::vector<std::filesystem::path> files_that(const std::filesystem::path& folder,
                                              const std::function<bool(const std::filesystem::path&)>& wanted);

/// The same with one of the extensions (lower case).
std::vector<std::filesystem::path> files_with(const std::filesystem::path& folder,
                                              std::initializer_list<std::string_view> extensions);

}  // namespace rilo::detail
