#include "bench/content_hash.hpp"

#include <array>
#include <fstream>
#include <link.h>
#include <map>
#include <openssl/evp.h>
#include <set>
#include <stdexcept>
#include <sys/stat.h>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "io/text.hpp"

namespace rilo {

namespace fs = std::filesystem;

namespace {

constexpr int kDeepestFolder = 4;
constexpr std::uintmax_t kLargestText = std::uintmax_t{16} << 20;

std::string extension_of(const fs::path& file) { return detail::lower_case(file.extension().string()); }

bool is_text(const fs::path& file) {
  static const std::set<std::string> kTexts = {".txt", ".yaml", ".yml", ".json", ".csv"};
  return kTexts.contains(extension_of(file));
}

// Whatever its name a file may be data, as captures are known by what is in them.
bool is_picture(const fs::path& file) {
  static const std::set<std::string> kPictures = {".png", ".jpg", ".jpeg"};
  return kPictures.contains(extension_of(file));
}

// A line that changes when the file does.
std::string line_of(const std::string& name, const fs::path& file) {
  std::error_code error;
  if (is_text(file) && fs::file_size(file, error) <= kLargestText) return name + ' ' + hash_of_file(file) + '\n';
  struct stat status = {};
  if (::stat(file.c_str(), &status) != 0) return name + " missing\n";
  return fmt::format("{} {} {}.{:09}\n", name, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
}

// Lines by name, so that the order of the folder does not matter.
using Lines = std::map<std::string, std::string>;

void list_folder(const fs::path& folder, const fs::path& results, Lines& lines) {
  std::error_code error;
  const auto options = fs::directory_options::follow_directory_symlink | fs::directory_options::skip_permission_denied;
  fs::recursive_directory_iterator entry(folder, options, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      const bool ours = !results.empty() && fs::equivalent(entry->path(), results, ignored);
      if (ours || entry.depth() >= kDeepestFolder) entry.disable_recursion_pending();
    } else if (!is_picture(entry->path())) {
      const std::string name = entry->path().lexically_relative(folder).string();
      lines[name] = line_of(name, entry->path());
    }
  }
}

// KITTI's poses and calibration of raw drives, stamps, an Ouster's metadata: beside the data rather than in them.
void list_neighbours(const fs::path& data, Lines& lines) {
  std::error_code error;
  const fs::path whole = fs::canonical(data, error);
  if (error) return;
  const fs::path beside = whole.parent_path();
  for (const fs::path& file :
       {beside.parent_path() / "poses" / (whole.filename().string() + ".txt"), beside / "calib_velo_to_cam.txt",
        beside / "calib_cam_to_cam.txt", beside / "calib_imu_to_velo.txt", beside / "times.txt",
        beside / "timestamps.txt", fs::path(whole).concat(".json")}) {
    if (fs::exists(file, error)) lines["../" + file.filename().string()] = line_of(file.filename().string(), file);
  }
  if (!fs::is_regular_file(whole, error)) return;
  for (fs::directory_iterator entry(beside, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    const bool twin = file.stem() == whole.stem() && is_text(file);
    if (twin || file.extension() == ".json") lines["../" + file.filename().string()] = line_of("beside", file);
  }
}

}  // namespace

ContentHash::ContentHash() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  if (EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) throw std::runtime_error("no SHA-256");
}

void ContentHash::add(std::string_view bytes) { EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()); }

bool ContentHash::add_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> buffer(std::size_t{1} << 16);
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    add({buffer.data(), static_cast<std::size_t>(stream.gcount())});
  }
  return stream.eof();
}

std::string ContentHash::hex() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
  return fmt::format("{:02x}", fmt::join(digest.begin(), digest.begin() + size, ""));
}

std::string hash_of(std::string_view bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.hex();
}

std::string hash_of_file(const fs::path& file) {
  ContentHash hash;
  return hash.add_file(file) ? hash.hex() : "missing";
}

std::string hash_of_data(const fs::path& data, const fs::path& results) {
  std::error_code error;
  Lines lines;
  if (fs::is_directory(data, error)) {
    list_folder(data, results, lines);
  } else {
    lines[""] = line_of(data.filename().string(), data);
  }
  list_neighbours(data, lines);
  ContentHash hash;
  for (const auto& [name, line] : lines) hash.add(line);
  return hash.hex();
}

const std::string& hash_of_program() {
  static const std::string kHash = [] {
    ContentHash hash;
    hash.add_file("/proc/self/exe");
    const auto add_library = [](dl_phdr_info* object, std::size_t, void* to) {
      const fs::path file = object->dlpi_name;
      if (file.filename().string().starts_with("librilo")) static_cast<ContentHash*>(to)->add_file(file);
      return 0;
    };
    dl_iterate_phdr(add_library, &hash);
    return hash.hex();
  }();
  return kHash;
}

}  // namespace rilo
