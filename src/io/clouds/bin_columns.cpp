// How many columns the records of .bin files have.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <system_error>
#include <vector>

#include "cloud/measured_point.hpp"
#include "io/clouds/cloud_columns.hpp"
#include "io/file_bytes.hpp"
#include "io/raw_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

constexpr const char* kDefault = "x,y,z,intensity";
constexpr const char* kWithRing = "x,y,z,intensity,ring";
constexpr std::size_t kFewestColumns = 3;
constexpr std::size_t kMostColumns = 8;

bool fits(std::size_t bytes, std::size_t columns) { return bytes % (columns * sizeof(float)) == 0; }

// Numbers of beams in the fifth column: a size alone may fit by chance, where bytes are missing or too many.
bool has_rings_behind(const std::filesystem::path& file) {
  constexpr std::size_t kRecords = 1000;
  constexpr float kMostBeams = 1024;
  constexpr std::size_t kColumns = 5;
  try {
    const FileBytes bytes = read_file(file, kRecords * kColumns * sizeof(float));
    for (std::size_t at = 0; at + kColumns * sizeof(float) <= bytes.size; at += kColumns * sizeof(float)) {
      const auto ring = load_bytes<float>(bytes.view(), at + 4 * sizeof(float));
      if (!(ring >= 0 && ring < kMostBeams && ring == std::floor(ring))) return false;
    }
  } catch (const IoError&) {
    return false;  // reported when it is reached
  }
  return true;
}

using Counts = std::array<double, 256>;

double entropy_bits(const Counts& counts, double total) {
  if (total == 0) return 0;
  double bits = 0;
  double seen = 0;
  for (const double count : counts) {
    if (count == 0) continue;
    bits -= count / total * std::log2(count / total);
    ++seen;
  }
  return bits + (seen - 1) / (2 * total * std::numbers::ln2);  // few numbers understate it (Miller and Madow)
}

// Which numbers count: a record of four without a measurement says nothing. Where every other beam sees nothing,
// records of four would look like records of eight.
std::vector<bool> measured_numbers(std::string_view bytes) {
  std::vector<bool> measured(bytes.size() / sizeof(float), true);
  for (std::size_t i = 0; i + 4 <= measured.size(); i += 4) {
    const auto number = [&](std::size_t k) { return load_bytes<float>(bytes, (i + k) * sizeof(float)); };
    if (is_measured({number(0), number(1), number(2)})) continue;
    std::fill_n(measured.begin() + static_cast<std::ptrdiff_t>(i), 4, false);
  }
  return measured;
}

// How much the column says about the power of two of a number, in bits (mutual information), whatever the order of the
// records. Coordinates, heights and intensities are of different sizes; in columns of a wrong number they are mixed.
double column_information(std::string_view bytes, const std::vector<bool>& measured, std::size_t columns) {
  std::array<Counts, kMostColumns> in_column{};
  std::array<double, kMostColumns> numbers{};
  Counts in_all{};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!measured[i]) continue;
    const std::size_t exponent = load_bytes<std::uint32_t>(bytes, i * sizeof(float)) >> 23U & 0xFFU;
    ++in_column[i % columns][exponent];
    ++numbers[i % columns];
    ++in_all[exponent];
  }
  const double total = std::accumulate(numbers.begin(), numbers.end(), 0.0);
  double information = entropy_bits(in_all, total);
  for (std::size_t c = 0; c < columns; ++c) {
    information -= numbers[c] / total * entropy_bits(in_column[c], numbers[c]);
  }
  return information;
}

// Records of which lengths the numbers look like, shortest first. Empty where they are too few or too similar to tell.
std::vector<std::size_t> columns_of_numbers(const std::filesystem::path& file) {
  constexpr std::size_t kLookedAt = std::size_t{1} << 24;
  constexpr std::ptrdiff_t kFewestNumbers = 4000;
  constexpr double kFewestBits = 0.03;  // ten times what chance makes of so few; sweeps have 0.08 to 1.7
  // Of 37 drives: the right number and its multiples say as much as any (1.00), others 0.73 of it at most.
  constexpr double kAsMuch = 0.8;
  const FileBytes bytes = read_file(file, kLookedAt);
  const std::vector<bool> measured = measured_numbers(bytes.view());
  if (std::count(measured.begin(), measured.end(), true) < kFewestNumbers) return {};
  std::error_code error;
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(file, error));
  std::array<double, kMostColumns + 1> information{};
  for (std::size_t n = kFewestColumns; n <= kMostColumns; ++n) {
    if (!error && fits(size, n)) information[n] = column_information(bytes.view(), measured, n);
  }
  const double most = *std::max_element(information.begin(), information.end());
  if (most < kFewestBits) return {};
  std::vector<std::size_t> likely;
  for (std::size_t n = kFewestColumns; n <= kMostColumns; ++n) {
    if (information[n] >= kAsMuch * most) likely.push_back(n);
  }
  return likely;
}

// As columns_of_numbers(); a file that cannot be read is reported when it is reached.
std::vector<std::size_t> likely_columns(const std::filesystem::path& file) {
  try {
    return columns_of_numbers(file);
  } catch (const IoError&) {
    return {};
  }
}

// "x,y,z,intensity,_,time": columns of that many, for an example.
std::string example_of(std::size_t columns) {
  if (columns <= 4) return columns == 4 ? kDefault : "x,y,z";
  std::string fields = kDefault;
  for (std::size_t n = 5; n < columns; ++n) fields += n == 5 ? ",ring" : ",_";
  return fields + ",time";
}

// The default fits the sizes; what do the numbers say?
std::string checked_default(const std::filesystem::path& file) {
  const std::vector<std::size_t> likely = likely_columns(file);
  if (likely.empty() || likely.front() == 4) return kDefault;
  if (likely.front() == 5 && has_rings_behind(file)) return kWithRing;
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(file));
  throw IoError({file, "",
                 counted(size, "byte") + ", which fit records of " + fitting_columns(size) +
                     " columns; the numbers look like records of " + std::to_string(likely.front()),
                 std::string("records of 4 columns, ") + kDefault,
                 "Say with bin_fields (--bin-fields) which columns it has, for example " + example_of(likely.front()) +
                     ", or " + kDefault + " when it is right; convert it if its numbers are of 8 bytes"});
}

}  // namespace

std::string fitting_columns(std::size_t bytes) {
  std::string fitting;
  for (std::size_t n = kFewestColumns; n <= kMostColumns; ++n) {
    if (fits(bytes, n)) fitting += (fitting.empty() ? "" : ", ") + std::to_string(n);
  }
  return fitting;
}

std::string doubt_about_columns(const std::filesystem::path& file, std::size_t columns) {
  if (columns > kMostColumns) return "";
  const std::vector<std::size_t> likely = likely_columns(file);
  if (likely.empty() || std::find(likely.begin(), likely.end(), columns) != likely.end()) return "";
  return "the numbers look like records of " + std::to_string(likely.front()) + " columns, not " +
         std::to_string(columns) + ": does bin_fields (--bin-fields) name all of them, for example " +
         example_of(likely.front()) + "?";
}

std::string guess_bin_fields(const std::vector<std::filesystem::path>& files) {
  constexpr std::size_t kLookedAt = 50;
  const std::size_t step = std::max<std::size_t>(1, files.size() / kLookedAt);
  bool four = true;
  bool five = true;
  bool named = !files.empty();
  std::uintmax_t most_bytes = 0;
  std::filesystem::path largest;
  for (std::size_t i = 0; i < files.size(); i += step) {
    std::error_code error;
    const auto size = std::filesystem::file_size(files[i], error);
    if (error || size == 0) continue;
    five = five && fits(size, 5);
    four = four && fits(size, 4);
    named = named && lower_case(files[i].filename().string()).ends_with(".pcd.bin");
    if (five && !four && !named) five = has_rings_behind(files[i]);
    if (size > most_bytes) largest = files[i];
    most_bytes = std::max(most_bytes, size);
  }
  if (most_bytes == 0) return kDefault;
  if (five && (!four || named)) return kWithRing;
  return four ? checked_default(largest) : kDefault;
}

}  // namespace rilo::detail
