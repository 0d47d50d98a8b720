// A ROS 1 bag, by ROS' own library.
#include <memory>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <string>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/ros/recording.hpp"
#include "io/ros/unpack.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

class BagReader final : public Recording {
 public:
  explicit BagReader(const std::filesystem::path& path) : path_(path) {
    check_magic();
    guarded("", [&] {
      bag_.open(path.string(), rosbag::bagmode::Read);
      list_topics();
    });
  }

  std::string format() const override { return "ROS 1 bag"; }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }

  void select(const RecordedTopic& topic) override {
    guarded("", [&] {
      view_ = std::make_unique<rosbag::View>(bag_, [topic](const rosbag::ConnectionInfo* connection) {
        return topic.has_same_messages({connection->topic, connection->datatype, "ros1", {}});
      });
      place_ = view_->begin();
      taken_ = 0;
    });
  }

  std::optional<RecordedMessage> next() override {
    if (!advance()) return std::nullopt;
    RecordedMessage message{0, {}, path_};
    guarded("message " + std::to_string(taken_), [&] {
      const rosbag::MessageInstance& instance = *place_;
      message.received_ns = static_cast<std::int64_t>(instance.getTime().toNSec());
      const std::size_t size = instance.size();
      if (size > kLargestUnpacked) {
        throw IoError({path_, "message " + std::to_string(taken_), counted(size, "byte"),
                       "at most " + std::to_string(kLargestUnpacked), "The bag is damaged: run rosbag reindex on it"});
      }
      bytes_.resize(size);
      ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes_.data()),
                                         static_cast<std::uint32_t>(size));
      instance.write(stream);
    });
    message.bytes = {bytes_.data(), bytes_.size()};
    return message;
  }

  std::size_t skip(std::size_t count) override {
    std::size_t skipped = 0;
    while (skipped < count && advance()) ++skipped;  // nothing is read or unpacked
    return skipped;
  }

 private:
  void check_magic() const {
    const FileBytes start = read_file(path_, kMagic.size());
    if (start.view() == kMagic) return;
    throw IoError({path_, "byte 0", start.view().starts_with("#ROSBAG") ? "another version of bags" : "other bytes",
                   "#ROSBAG V2.0", "Check what kind of file this is; rosbag fix converts old versions"});
  }

  // The library throws what it likes.
  template <typename Action>
  void guarded(const std::string& position, Action&& action) {
    try {
      action();
    } catch (const IoError&) {
      throw;
    } catch (const rosbag::BagUnindexedException&) {
      throw IoError({path_, position, "a bag without an index: the recorder was killed", "an indexed bag",
                     "Run rosbag reindex on it"});
    } catch (const std::exception& error) {
      // Python's package rosbags packs with LZ4 in a way that ROS' library does not unpack.
      const std::string what = error.what();
      throw IoError(
          {path_, position, "librosbag-storage says: " + what, "a whole ROS 1 bag",
           what.find("LZ4") == std::string::npos
               ? "Copy it again, or run rosbag reindex on it"
               : "Copy it again; where another program than ROS' own packed it, let that write it with bz2 or "
                 "without compression"});
    }
  }

  void list_topics() {
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      const auto of_this_one = [&](const rosbag::ConnectionInfo* other) { return other->id == connection->id; };
      rosbag::View messages(bag_, of_this_one);
      add_topic({connection->topic, connection->datatype, "ros1", messages.size()}, topics_);
    }
  }

  // To the next message; false at the end.
  bool advance() {
    bool there = false;
    guarded("message " + std::to_string(taken_ + 1), [&] {
      if (taken_ > 0 && place_ != view_->end()) ++place_;
      there = place_ != view_->end();
    });
    taken_ += there ? 1 : 0;
    return there;
  }

  std::filesystem::path path_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator place_;
  std::size_t taken_ = 0;  // messages of the topic so far
  std::vector<RecordedTopic> topics_;
  std::vector<char> bytes_;
};

}  // namespace

std::unique_ptr<Recording> open_bag(const std::filesystem::path& file) { return std::make_unique<BagReader>(file); }

}  // namespace rilo::detail
