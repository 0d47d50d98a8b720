// A rosbag2 folder: metadata.yaml says which files there are and how they are compressed.
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/ros/recording.hpp"
#include "io/ros/unpack.hpp"
#include "io/temporary_folder.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLargestMetadata = std::size_t{1} << 24;

struct Metadata {
  std::vector<fs::path> files;
  bool messages_compressed = false;
};

[[noreturn]] void reject(const fs::path& file, const std::string& position, const std::string& found,
                         const std::string& expected) {
  throw IoError(
      {file, position, found, expected,
       "Write metadata.yaml again (ros2 bag reindex), or move it away to read the folder's files as they are"});
}

std::string text_of(const YAML::Node& node, const char* key) {
  const YAML::Node value = node[key];
  return value && value.IsScalar() ? value.Scalar() : "";
}

// Old versions wrote the path as it was seen by the recorder: the name in this folder is what counts.
fs::path find_file(const fs::path& folder, const fs::path& metadata, const std::string& written) {
  const fs::path name = fs::path(written).filename();
  if (!name.empty() && path_exists(folder / name)) return folder / name;
  throw IoError({metadata, "", "the file " + in_quotes(written) + ", which is not in the folder",
                 "all files of the bag", "Copy the missing file, or move metadata.yaml away to read what is there"});
}

Metadata parse_metadata(const fs::path& folder, const fs::path& file) {
  const FileBytes bytes = read_file(file, kLargestMetadata);
  try {
    const YAML::Node info = YAML::Load(std::string(bytes.view()))["rosbag2_bagfile_information"];
    if (!info || !info.IsMap()) reject(file, "", "no rosbag2_bagfile_information", "the metadata of a rosbag2");
    Metadata metadata;
    const std::string mode = lower_case(text_of(info, "compression_mode"));
    const std::string format = lower_case(text_of(info, "compression_format"));
    metadata.messages_compressed = mode == "message";
    if (!mode.empty() && mode != "none" && format != "zstd") {
      reject(file, "compression_format", in_quotes(format), "zstd");
    }
    const YAML::Node paths = info["relative_file_paths"];
    if (!paths || !paths.IsSequence() || paths.size() == 0) {
      reject(file, "relative_file_paths", "no list of files", "the files of the bag");
    }
    for (const YAML::Node& path : paths) {
      if (!path.IsScalar()) reject(file, "relative_file_paths", "an entry that is not a name", "the files of the bag");
      metadata.files.push_back(find_file(folder, file, path.Scalar()));
    }
    return metadata;
  } catch (const YAML::Exception& error) {
    reject(file, at_line(static_cast<std::size_t>(error.mark.line + 1)), "text that is not valid YAML: " + error.msg,
           "the metadata of a rosbag2");
  }
}

bool has_suffix(const fs::path& file, std::string_view suffix) {
  const std::string name = lower_case(file.filename().string());
  return name.size() > suffix.size() && name.ends_with(suffix);
}

bool is_storage(const fs::path& file) {
  return has_suffix(file, ".db3") || has_suffix(file, ".mcap") || has_suffix(file, ".db3.zstd") ||
         has_suffix(file, ".mcap.zstd");
}

std::vector<fs::path> storage_in(const fs::path& folder) {
  std::vector<fs::path> files = files_with(folder, {".db3", ".mcap", ".zstd"});
  std::erase_if(files, [](const fs::path& file) { return !is_storage(file); });
  return files;
}

std::unique_ptr<Recording> open_storage(const fs::path& file) {
  return has_suffix(file, ".mcap") ? open_mcap(file) : open_db3(file);
}

// What a recording is wrapped into by rosbag2: everything goes through, unless a child says otherwise.
class Wrapped : public Recording {
 public:
  explicit Wrapped(std::unique_ptr<Recording> inner) : inner_(std::move(inner)) {}
  const std::vector<RecordedTopic>& topics() const override { return inner_->topics(); }
  void select(const RecordedTopic& topic) override { inner_->select(topic); }
  std::optional<RecordedMessage> next() override { return inner_->next(); }
  std::size_t lost() const override { return inner_->lost(); }
  bool places_known() const override { return inner_->places_known(); }
  std::size_t skip(std::size_t count) override { return inner_->skip(count); }
  std::vector<std::string> warnings() const override { return inner_->warnings(); }

 protected:
  std::unique_ptr<Recording> inner_;
};

class PackedMessages final : public Wrapped {
 public:
  using Wrapped::Wrapped;
  std::string format() const override { return inner_->format() + ", messages in zstd"; }
  std::optional<RecordedMessage> next() override {
    auto message = inner_->next();
    if (!message) return message;
    unpack_zstd(message->bytes, kLargestUnpacked, {message->file, "a message"}, unpacked_);
    message->bytes = {unpacked_.data(), unpacked_.size()};
    return message;
  }

 private:
  std::vector<char> unpacked_;
};

// A packed file is unpacked onto the disk; messages name the packed one.
class PackedFile final : public Wrapped {
 public:
  PackedFile(std::unique_ptr<TemporaryFolder> folder, const fs::path& unpacked, fs::path packed)
      : Wrapped(open_storage(unpacked)), folder_(std::move(folder)), packed_(std::move(packed)) {}
  std::string format() const override { return inner_->format() + ", file in zstd"; }
  std::optional<RecordedMessage> next() override {
    auto message = inner_->next();
    if (message) message->file = packed_;
    return message;
  }

 private:
  std::unique_ptr<TemporaryFolder> folder_;
  fs::path packed_;
};

std::unique_ptr<Recording> open_maybe_packed(const fs::path& file) {
  if (!has_suffix(file, ".zstd")) return open_storage(file);
  auto folder = std::make_unique<TemporaryFolder>("rilo");
  const fs::path unpacked = folder->path() / file.stem();
  unpack_zstd_file(file, unpacked);
  return std::make_unique<PackedFile>(std::move(folder), unpacked, file);
}

std::unique_ptr<Recording> open_rosbag2_folder(const fs::path& folder) {
  const fs::path file = folder / "metadata.yaml";
  Metadata metadata;
  if (path_exists(file)) {
    metadata = parse_metadata(folder, file);
  } else {
    // Where the recorder was killed: the files are taken as they are.
    metadata.files = storage_in(folder);
    if (metadata.files.empty()) reject(folder, "", "no .db3 and no .mcap", "the files of a rosbag2");
  }
  auto recording = open_in_turn(std::move(metadata.files), open_maybe_packed);
  if (metadata.messages_compressed) return std::make_unique<PackedMessages>(std::move(recording));
  return recording;
}

}  // namespace

bool is_rosbag2(const fs::path& path) {
  if (!is_folder(path)) return is_storage(path);
  return path_exists(path / "metadata.yaml") || !storage_in(path).empty();
}

std::unique_ptr<Recording> open_rosbag2(const fs::path& path) {
  return is_folder(path) ? open_rosbag2_folder(path) : open_maybe_packed(path);
}

}  // namespace rilo::detail
