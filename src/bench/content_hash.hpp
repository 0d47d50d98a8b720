// SHA-256 of files and folders: what results are filed under.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // of OpenSSL

namespace rilo {

/// SHA-256 of bytes that come in pieces.
class ContentHash {
 public:
  ContentHash();

  void add(std::string_view bytes);
  /// The content of a file. False when it cannot be read.
  bool add_file(const std::filesystem::path& file);
  /// 64 hexadecimal digits; nothing may be added afterwards.
  std::string hex();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

std::string hash_of(std::string_view bytes);

/// "missing" when it cannot be read.
std::string hash_of_file(const std::filesystem::path& file);

/// Data as `rilo run` takes them, and the ground truth and calibration that it finds beside them. Of sweeps and
/// recordings, whose content would take hours to read, name, size and time of the last change; of texts the content.
/// `results`: a folder of ours that may lie within and does not count.
std::string hash_of_data(const std::filesystem::path& data, const std::filesystem::path& results);

/// This program: its file and the libraries of ours that it has loaded.
const std::string& hash_of_program();

}  // namespace rilo
