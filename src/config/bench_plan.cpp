#include "config/bench_plan.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "config/yaml_document.hpp"
#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/text.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo {
namespace {

namespace fs = std::filesystem;
using detail::kind_of;
using detail::position_of;

constexpr std::int64_t kMostSweeps = 1'000'000'000;
constexpr std::int64_t kMostRepeats = 1000;
constexpr const char* kPlanHint = "docs/bench.md shows how the file looks";

class PlanReader {
 public:
  PlanReader(fs::path file, const fs::path& root)
      : file_(std::move(file)), root_(root.empty() ? file_.parent_path() : root) {}

  BenchPlan read(const YAML::Node& root) const {
    BenchPlan plan;
    if (!root.IsMap()) refuse(root, kind_of(root), "a map with sequences: and configurations:");
    read_map(root, "", "",
             {{"sequences",
               [&](const Node& node) { plan.sequences = list<BenchSequence>(node, "sequences", "{ path: DRIVE }"); }},
              {"configurations",
               [&](const Node& node) {
                 plan.configurations = list<BenchConfiguration>(node, "configurations", "{ name: NAME }");
               }},
              {"repeats", [&](const Node& node) { plan.repeats = count(node, "repeats", 1, kMostRepeats); }},
              {"skip_missing",
               [&](const Node& node) {
                 plan.skip_missing = word(node, "skip_missing", {"false", "true"}) == "true";
               }},
              {"peers", [&](const Node& node) { plan.peers = peers(node); }},
              {"peer_figures", [&](const Node& node) { plan.peer_figures = path(node, "peer_figures", root_); }},
              {"tables", [&](const Node& node) {
                 const std::string name = word(node, "tables", {"none", "kitti", "m2dgr"});
                 plan.tables = name == "kitti"   ? PaperTables::kKitti
                               : name == "m2dgr" ? PaperTables::kM2dgr
                                                 : PaperTables::kNone;
               }}});
    if (plan.configurations.empty()) plan.configurations.push_back({"default", {}, {}, {}});
    check_peer_names(root, plan);
    return plan;
  }

 private:
  using Node = YAML::Node;
  using Entries = std::vector<std::pair<std::string, std::function<void(const Node&)>>>;

  [[noreturn]] void refuse(const Node& node, const std::string& found, const std::string& expected,
                           const std::string& remedy = "") const {
    throw ConfigError({file_, position_of(node.Mark()), found, expected, remedy});
  }

  // Every entry of the map is taken by the one of its name in `entries`; `needed` has to be there.
  void read_map(const Node& map, const std::string& what, const std::string& needed, const Entries& entries) const {
    std::set<std::string> seen;
    for (const auto& pair : map) {
      const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "";
      const auto known = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.first == key; });
      if (known == entries.end()) {
        std::string names;
        for (const auto& entry : entries) names += (names.empty() ? "" : ", ") + entry.first;
        refuse(pair.first, pair.first.IsScalar() ? "unknown key " + detail::quoted(key) : kind_of(pair.first),
               "one of " + names);
      }
      if (!seen.insert(key).second) refuse(pair.first, key + " is given a second time", "each key once");
      // yaml-cpp gives a missing value no place of its own.
      if (pair.second.IsNull()) refuse(pair.first, key + " has no value", "a value");
      known->second(pair.second);
    }
    if (!needed.empty() && seen.count(needed) == 0) refuse(map, what + " without " + needed, needed + ": in it");
  }

  void check_peer_names(const Node& root, const BenchPlan& plan) const {
    const auto check = [&](const std::vector<BenchPeer>& peers, const std::string& of) {
      for (const BenchPeer& peer : peers) {
        if (has_configuration(plan, peer.name)) {
          refuse(root, detail::quoted(peer.name) + " is both a configuration and a peer" + of, "names that differ");
        }
      }
    };
    check(plan.peers, "");
    for (const BenchSequence& sequence : plan.sequences) check(sequence.peers, " of " + sequence.name);
  }

  template <typename Item>
  std::vector<Item> list(const Node& node, const std::string& what, const std::string& example) const {
    if (!node.IsSequence()) refuse(node, what + " is " + kind_of(node), "a list");
    std::vector<Item> items;
    std::set<std::string> names;
    for (const Node& entry : node) {
      if (!entry.IsMap()) refuse(entry, kind_of(entry), what + " such as " + example);
      items.push_back(item(entry, static_cast<const Item*>(nullptr)));
      if (!names.insert(items.back().name).second) {
        refuse(entry, "the name " + detail::quoted(items.back().name) + " a second time",
               "names that differ in " + what);
      }
    }
    if (items.empty()) refuse(node, what + " is an empty list", "at least one entry");
    return items;
  }

  BenchSequence item(const Node& map, const BenchSequence* /*kind*/) const {
    BenchSequence s;
    const auto file = [this](const char* key, fs::path& member) {
      return std::pair(std::string(key), [this, key, &member](const Node& n) { member = path(n, key, root_); });
    };
    const auto whole = [this](const char* key, std::size_t& member) {
      return std::pair(std::string(key),
                       [this, key, &member](const Node& n) { member = count(n, key, 0, kMostSweeps); });
    };
    read_map(map, "a sequence", "path",
             {{"name", [&](const Node& n) { s.name = text(n, "name"); }},
              file("path", s.path),
              file("ground_truth", s.ground_truth),
              file("calibration", s.calibration),
              {"pose_frame",
               [&](const Node& n) {
                 s.camera_frame = word(n, "pose_frame", {"lidar", "camera"}) == "camera";
               }},
              {"max_gap_s", [&](const Node& n) { s.max_gap_s = number(n, "max_gap_s", 0, 1e6, "s"); }},
              whole("start", s.start),
              whole("count", s.count),
              {"point_times",
               [&](const Node& n) {
                 s.point_times = parse_point_times(word(n, "point_times", {"auto", "azimuth", "order", "none"}));
               }},
              {"elevation_correction", [&](const Node& n) { s.elevation_correction_deg = elevation(n); }},
              {"group", [&](const Node& n) { s.group = text(n, "group"); }},
              {"peers", [&](const Node& n) { s.peers = peers(n); }}});
    if (s.name.empty()) s.name = detail::last_name(s.path);
    return s;
  }

  BenchConfiguration item(const Node& map, const BenchConfiguration* /*kind*/) const {
    BenchConfiguration c;
    Node set;
    read_map(map, "a configuration", "name",
             {{"name", [&](const Node& n) { c.name = text(n, "name"); }},
              {"config", [&](const Node& n) { load_file(n, c); }},
              {"elevation_correction", [&](const Node& n) { c.elevation_correction_deg = elevation(n); }},
              {"set", [&](const Node& n) { set.reset(n); }}});
    if (set.IsDefined() && !set.IsNull()) apply(set, c);
    // No key of the odometry, but what tells this configuration from others.
    if (c.elevation_correction_deg) c.settings.push_back(fmt::format("elevation {}°", *c.elevation_correction_deg));
    return c;
  }

  void load_file(const Node& node, BenchConfiguration& c) const {
    const fs::path file = path(node, "config", file_.parent_path());
    if (!detail::is_file(file)) {
      refuse(node, "there is no file " + detail::quoted(file.string()), "a configuration file (YAML)",
             "Relative paths count from the folder of this file");
    }
    c.config = load_config(file);
    c.settings.insert(c.settings.begin(), std::string(kConfigWord) + file.filename().string());
  }

  void apply(const Node& set, BenchConfiguration& c) const {
    if (!set.IsSequence()) refuse(set, "set is " + kind_of(set), "a list of key=value");
    std::vector<std::string> overrides;
    for (const Node& entry : set) {
      if (!entry.IsScalar()) refuse(entry, kind_of(entry), "key=value in the list set");
      overrides.push_back(entry.Scalar());
    }
    try {
      c.config = with_overrides(c.config, overrides);
    } catch (const ConfigError& error) {
      const IoProblem& problem = error.problem();
      // The entry that is wrong by itself stands in the place of the file; otherwise they contradict each other.
      Node place = set;
      for (const Node& entry : set) {
        if (problem.file == override_place(entry.Scalar())) place.reset(entry);
      }
      refuse(place, (place.IsScalar() ? detail::quoted(place.Scalar()) + ": " : "") + problem.found, problem.expected,
             problem.remedy);
    }
    c.settings.insert(c.settings.end(), overrides.begin(), overrides.end());
  }

  std::vector<BenchPeer> peers(const Node& node) const {
    if (!node.IsMap()) refuse(node, "peers is " + kind_of(node), "a map of names and pose files");
    std::vector<BenchPeer> result;
    std::set<std::string> names;
    for (const auto& pair : node) {
      if (!names.insert(text(pair.first, "the name of a peer")).second) {
        refuse(pair.first, "the peer " + detail::quoted(pair.first.Scalar()) + " a second time", "each peer once");
      }
      if (pair.second.IsNull()) refuse(pair.first, "the peer has no value", "a path");
      result.push_back({pair.first.Scalar(), path(pair.second, "the peer's file", root_)});
    }
    return result;
  }

  std::string text(const Node& node, const std::string& what) const {
    if (!node.IsScalar() || node.Scalar().empty()) refuse(node, what + " is " + kind_of(node), "a text");
    return node.Scalar();
  }

  fs::path path(const Node& node, const std::string& what, const fs::path& folder) const {
    if (!node.IsScalar() || node.Scalar().empty()) refuse(node, what + " is " + kind_of(node), "a path");
    return (folder / node.Scalar()).lexically_normal();
  }

  template <typename Number>
  std::optional<Number> parsed(const Node& node) const {
    if (!node.IsScalar() || node.Tag() == "!") return std::nullopt;  // "!": in quotes, that is text
    return detail::parse_number<Number>(node.Scalar());
  }

  double number(const Node& node, const std::string& what, double least, double most, const std::string& unit) const {
    const auto value = parsed<double>(node);
    if (value && *value >= least && *value <= most) return *value;
    refuse(node, what + " is " + kind_of(node), fmt::format("a number from {} to {} {}", least, most, unit));
  }

  double elevation(const Node& node) const { return number(node, "elevation_correction", -10, 10, "deg"); }

  std::size_t count(const Node& node, const std::string& what, std::int64_t least, std::int64_t most) const {
    const auto value = parsed<std::int64_t>(node);
    if (value && *value >= least && *value <= most) return static_cast<std::size_t>(*value);
    refuse(node, what + " is " + kind_of(node), fmt::format("a whole number from {} to {}", least, most));
  }

  std::string word(const Node& node, const std::string& what, const std::vector<std::string>& words) const {
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (node.IsScalar() && node.Scalar() == words[i]) return words[i];
      all += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
    }
    refuse(node, what + " is " + kind_of(node), all);
  }

  static std::string override_place(const std::string& entry) {
    return "--set " + entry.substr(0, detail::kLongestQuote);
  }

  fs::path file_;
  fs::path root_;  // of sequences
};

}  // namespace

BenchPlan parse_bench_plan(std::string_view yaml, const fs::path& file, const fs::path& root) {
  try {
    return PlanReader(file, root).read(detail::parse_yaml(yaml, file.string(), kPlanHint));
  } catch (const YAML::Exception& error) {  // of nodes that yaml-cpp cannot make sense of
    throw ConfigError({file, position_of(error.mark), "not valid YAML (" + error.msg + ")", "a plan", kPlanHint});
  }
}

bool has_configuration(const BenchPlan& plan, const std::string& name) {
  return std::any_of(plan.configurations.begin(), plan.configurations.end(),
                     [&](const BenchConfiguration& configuration) { return configuration.name == name; });
}

void give_peers(BenchPlan& plan) {
  constexpr std::string_view kPlaceholder = "{sequence}";
  for (BenchSequence& sequence : plan.sequences) {
    for (BenchPeer peer : plan.peers) {
      const bool own = std::any_of(sequence.peers.begin(), sequence.peers.end(),
                                   [&](const BenchPeer& other) { return other.name == peer.name; });
      if (own) continue;
      std::string file = peer.poses.string();
      for (auto at = file.find(kPlaceholder); at != std::string::npos; at = file.find(kPlaceholder, at)) {
        file.replace(at, kPlaceholder.size(), sequence.name);
        at += sequence.name.size();
      }
      peer.poses = file;
      sequence.peers.push_back(peer);
    }
  }
}

BenchPlan load_bench_plan(const fs::path& file, const fs::path& root) {
  return parse_bench_plan(detail::read_yaml_file(file, "a benchmark plan (YAML)", kPlanHint), file, root);
}

}  // namespace rilo
