// Numbers in the names of sweeps: some sweeps of a recording may be missing from a folder.
#include <charconv>
#include <numeric>

#include "io/folders/sweep_files.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostDigits = 9;     // longer ones are stamps or identifiers
constexpr std::int64_t kMostPerSweep = 4;  // numbers: where fewer sweeps are there, the numbers count something else

struct NumberedName {
  std::string before;
  std::string after;
  std::int64_t number = -1;  // none
};

/// The last number of the name.
NumberedName number_of(const fs::path& file) {
  constexpr const char* kDigits = "0123456789";
  const std::string stem = file.stem().string();
  const std::size_t last = stem.find_last_of(kDigits);
  if (last == std::string::npos) return {};
  const std::size_t other = stem.find_last_not_of(kDigits, last);
  const std::size_t first = other == std::string::npos ? 0 : other + 1;
  NumberedName name{stem.substr(0, first), stem.substr(last + 1), -1};
  if (last + 1 - first > kMostDigits) return {};
  std::from_chars(stem.data() + first, stem.data() + last + 1, name.number);
  return name;
}

/// Empty where the numbers may mean something else.
std::vector<std::int64_t> numbered_places(const std::vector<fs::path>& files) {
  std::vector<std::int64_t> places;
  std::int64_t unit = 0;
  NumberedName first;
  for (const fs::path& file : files) {
    const NumberedName name = number_of(file);
    if (places.empty()) first = name;
    const std::int64_t place = name.number - first.number;
    const bool goes_on = places.empty() || place > places.back();
    if (name.number < 0 || name.before != first.before || name.after != first.after || !goes_on) return {};
    places.push_back(place);
    unit = std::gcd(unit, place);
  }
  if (unit == 0) return {};
  for (std::int64_t& place : places) place /= unit;
  const auto most = kMostPerSweep * static_cast<std::int64_t>(files.size());
  return places.back() < most ? places : std::vector<std::int64_t>{};
}

}  // namespace

std::vector<std::int64_t> places_from_names(const std::vector<fs::path>& files) {
  std::vector<std::int64_t> places = numbered_places(files);
  if (places.empty()) {
    places.resize(files.size());
    std::iota(places.begin(), places.end(), 0);
  }
  return places;
}

}  // namespace rilo::detail
