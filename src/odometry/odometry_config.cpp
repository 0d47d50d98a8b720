#include "rilo/odometry/odometry_config.hpp"

#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "rilo/odometry/odometry_keys.hpp"

namespace rilo {

namespace {

template <typename Value, typename Expected>
[[noreturn]] void refuse(const std::string& name, const Value& value, const Expected& expected) {
  std::ostringstream text;
  text << "configuration: " << name << " is " << value << ", expected " << expected;
  throw std::invalid_argument(text.str());
}

template <typename Number>
std::string range(const char* kind, Number least, Number most) {
  std::ostringstream text;
  text << kind << " from " << least << " to " << most;
  return text.str();
}

// Every key by itself.
class RangeCheck : public KeyVisitor {
 public:
  void section(std::string_view name, std::string_view /*meaning*/) override { section_ = std::string(name) + "."; }

  void real(const KeyInfo& key, double& member, double least, double most) override {
    // Comparisons with NaN are false.
    if (!(member >= least && member <= most)) refuse(full(key), member, range("a number", least, most));
  }

  void integer(const KeyInfo& key, int& member, int least, int most) override {
    if (member < least || member > most) refuse(full(key), member, range("a whole number", least, most));
  }

  void boolean(const KeyInfo& /*key*/, bool& /*member*/) override {}

  void choice_of(const KeyInfo& key, KeyChoice choice) override {
    if (choice.get() < choice.words.size()) return;
    std::string words;
    for (const std::string& word : choice.words) words += (words.empty() ? "" : " or ") + word;
    refuse(full(key), "none of its values", words);
  }

 private:
  std::string full(const KeyInfo& key) const { return section_ + std::string(key.name); }

  std::string section_;
};

template <typename Number>
void check_order(const char* name, Number value, const char* least_name, Number least) {
  if (value >= least) return;
  std::ostringstream expected;
  expected << "at least that of " << least_name << ", " << least;
  refuse(name, value, expected.str());
}

}  // namespace

void validate(const OdometryConfig& config) {
  OdometryConfig c = config;
  RangeCheck check;
  visit_keys(c, check);
  check_order("preprocess.max_range_m", c.preprocess.max_range_m, "preprocess.min_range_m", c.preprocess.min_range_m);
  check_order("preprocess.max_voxel_m", c.preprocess.max_voxel_m, "preprocess.min_voxel_m", c.preprocess.min_voxel_m);
  check_order("threshold.ceiling_m", c.threshold.ceiling_m, "threshold.floor_m", c.threshold.floor_m);
  check_order("map.max_points", c.map.max_points, "map.min_points", c.map.min_points);
}

OdometryConfig validated(const OdometryConfig& config) {
  validate(config);
  return config;
}

}  // namespace rilo
