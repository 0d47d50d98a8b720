#include "bench/report_runs.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

#include <fmt/format.h>

#include "bench/report_sequence.hpp"
#include "console/text.hpp"
#include "io/stamp_difference.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

/// Of a killed run the points are not known.
bool as_many_points(const SweepResult& a, const SweepResult& b) {
  return a.stats.points_in == 0 || b.stats.points_in == 0 || a.stats.points_in == b.stats.points_in;
}

/// Whether two runs are over the same data: the same sweep has the same stamp, even if at another time within the
/// sweep, and as many points, since drives without stamps all begin alike. Data may have been moved between the runs,
/// so that paths say nothing; without a sweep in common they decide.
bool same_data(const RunRecord& a, const RunRecord& b) {
  constexpr std::int64_t kNear_ns = 1'000'000'000;
  for (std::size_t i = 0, k = 0; i < a.indices.size() && k < b.indices.size();) {
    if (a.indices[i] == b.indices[k]) {
      return std::abs(detail::stamp_difference(a.results[i].stamp_ns, b.results[k].stamp_ns)) < kNear_ns &&
             as_many_points(a.results[i], b.results[k]);
    }
    a.indices[i] < b.indices[k] ? ++i : ++k;
  }
  return a.data == b.data;
}

std::string names_of(const std::vector<ReportSequence>& sequences) {
  std::vector<std::string> names;
  for (const ReportSequence& sequence : sequences) names.push_back(sequence.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

class Grouping {
 public:
  void add(ReportEntry entry) {
    const bool known = entry.run && !entry.run->killed;
    const std::string name = entry.input.sequence.empty() && known ? name_for(entry.run->record) : entry.input.sequence;
    if (name.empty()) {
      waiting_.push_back(std::move(entry));
    } else {
      into(name, std::move(entry));
    }
  }

  /// Pose files and killed runs do not say what they are of.
  std::vector<ReportSequence> finish() {
    for (ReportEntry& entry : waiting_) {
      if (sequences_.size() > 1) {
        throw RunError(RunErrorKind::kUsage,
                       fmt::format("{} does not say which sequence it is of; expected SEQUENCE/{}={} with one of: {}",
                                   entry.input.path.string(), entry.input.name.empty() ? "NAME" : entry.input.name,
                                   entry.input.path.string(), names_of(sequences_)));
      }
      const std::string name = sequences_.empty() ? "" : sequences_.front().name;
      into(name, std::move(entry));
    }
    return std::move(sequences_);
  }

 private:
  void into(const std::string& name, ReportEntry entry) {
    auto found = std::find_if(sequences_.begin(), sequences_.end(), [&](const auto& s) { return s.name == name; });
    if (found == sequences_.end()) found = sequences_.insert(sequences_.end(), {name, {}, {}});
    found->entries.push_back(std::move(entry));
  }

  /// Last part of the data's path; the whole path when other data go by that name.
  std::string name_for(const RunRecord& record) const {
    std::string name = valid_utf8(last_name(record.data));
    for (const ReportSequence& sequence : sequences_) {
      const auto& first = sequence.entries.front();
      if (sequence.name == name && first.run && !first.run->killed && !same_data(first.run->record, record)) {
        return valid_utf8(record.data.string());
      }
    }
    return name;
  }

  std::vector<ReportSequence> sequences_;
  std::vector<ReportEntry> waiting_;
};

void set_truths(const std::vector<ReportTruth>& truths, std::vector<ReportSequence>& sequences) {
  for (const ReportTruth& truth : truths) {
    bool used = false;
    for (ReportSequence& sequence : sequences) {
      if (!truth.sequence.empty() && truth.sequence != sequence.name) continue;
      sequence.truth = truth.path;
      used = true;
    }
    if (used && (!truth.sequence.empty() || sequences.size() == 1)) continue;
    throw RunError(RunErrorKind::kUsage, fmt::format("--gt {}{}: expected SEQUENCE=FILE with one of: {}",
                                                     truth.sequence.empty() ? "" : truth.sequence + "=",
                                                     truth.path.string(), names_of(sequences)));
  }
}

/// Folder of a run without its last part when that only repeats the sequence (results/full/urban00).
std::string default_name(const ReportInput& input, const std::string& sequence) {
  const std::filesystem::path path = (input.path / "").lexically_normal().parent_path();
  const std::string name = valid_utf8(last_name(path));
  const std::string above = valid_utf8(last_name(path.parent_path()));
  return name == sequence && !above.empty() && above != "." && above != ".." ? above : name;
}

/// Names within a sequence must differ: equal ones that nobody has given are distinguished by their paths, and if need
/// be by a number.
void set_names(ReportSequence& sequence) {
  std::set<std::string> given;
  for (ReportEntry& entry : sequence.entries) {
    if (entry.input.name.empty()) entry.input.name = default_name(entry.input, sequence.name);
    if (entry.input.named && !given.insert(entry.input.name).second) {
      throw RunError(RunErrorKind::kUsage,
                     fmt::format("two results are named {}; give each of a sequence its own NAME=", entry.input.name));
    }
  }
  std::multiset<std::string> names;
  for (const ReportEntry& entry : sequence.entries) names.insert(entry.input.name);
  std::set<std::string> taken;
  for (ReportEntry& entry : sequence.entries) {
    std::string& name = entry.input.name;
    if (names.count(name) > 1) name = valid_utf8(entry.input.path.lexically_normal().string());
    const std::string plain = name;
    for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{} ({})", plain, i);
  }
}

}  // namespace

ReportRuns report_runs(const std::vector<ReportInput>& inputs, const std::vector<ReportTruth>& truths,
                       const PoseFlags& flags) {
  Grouping grouping;
  for (const ReportInput& input : inputs) {
    ReportEntry entry{input, std::nullopt};
    if (input.kind == ReportInputKind::kRun) entry.run = read_saved_run(input.path);
    grouping.add(std::move(entry));
  }
  std::vector<ReportSequence> sequences = grouping.finish();
  set_truths(truths, sequences);
  ReportRuns result;
  for (ReportSequence& sequence : sequences) {
    set_names(sequence);
    for (RunReport& run : reports_of(std::move(sequence), flags, result.notices)) result.runs.push_back(std::move(run));
  }
  return result;
}

}  // namespace rilo
