// Parts that make up a sweep, joined to one.
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/sources/parts_of_sweep.hpp"
#include "io/sources/read_sweep.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/stamp_difference.hpp"

namespace rilo::detail {
namespace {

/// A column of all points or none.
template <typename Value>
void append_column(const std::vector<Value>& from, const Sweep& part, std::vector<Value>& to, const Sweep& joined) {
  if (from.size() != part.points.size() || to.size() != joined.points.size()) return to.clear();
  to.insert(to.end(), from.begin(), from.end());
}

/// Times then count from the stamp of `joined`. Points without times are all at the stamp of their part.
void append(const Sweep& part, Sweep& joined) {
  append_column(part.intensities, part, joined.intensities, joined);
  append_column(part.rings, part, joined.rings, joined);
  const double since_s = seconds_between(joined.stamp_ns, part.stamp_ns);
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    const double time_s = part.times_s.empty() ? 0.0 : static_cast<double>(part.times_s[i]);
    joined.times_s.push_back(static_cast<float>(since_s + time_s));
  }
  joined.points.insert(joined.points.end(), part.points.begin(), part.points.end());
}

class JoinedSource final : public WrappedSource {
 public:
  JoinedSource(std::unique_ptr<ScanSource> inner, std::size_t parts)
      : WrappedSource(std::move(inner)), found_out_(parts == 0) {
    const SourceInfo info = inner_->info();
    part_s_ = info.period_s;
    timed_ = info.has_point_times;
    parts_ = found_out_ ? find_parts() : parts;
  }

  std::optional<Sweep> next() override {
    ReadSweep first = read();
    index_ = first.index;
    name_ = std::move(first.name);
    std::optional<Sweep> sweep = first.take();
    if (!sweep || parts_ == 1) return sweep;
    Sweep joined;
    joined.stamp_ns = sweep->stamp_ns;
    append(*sweep, joined);
    for (std::size_t i = 1; i < parts_ && next_belongs_to(joined); ++i) append(*read().sweep, joined);
    return joined;
  }

  std::size_t skip(std::size_t count) override {
    const std::size_t parts = count * parts_;
    std::size_t skipped = 0;
    for (; skipped < parts && !waiting_.empty() && !waiting_.front().is_end(); ++skipped) waiting_.pop_front();
    if (waiting_.empty()) skipped += inner_->skip(parts - skipped);
    return in_sweeps(skipped);
  }

  std::optional<std::size_t> size() const override {
    const std::optional<std::size_t> parts = inner_->size();
    return parts ? std::optional(in_sweeps(*parts)) : std::nullopt;
  }
  std::size_t current_index() const override { return index_; }
  std::string current_name() const override { return name_; }

  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.parts = parts_;
    if (parts_ == 1) return info;
    info.period_s *= static_cast<double>(parts_);
    if (info.sweeps) info.sweeps = in_sweeps(*info.sweeps);
    if (!timed_) info.point_times = "the stamps of the parts of a sweep";
    info.has_point_times = true;
    if (found_out_) {
      info.warnings.push_back(fmt::format(
          "the data come every {:.3g} s and hold parts of sweeps: {} are joined to one (--parts 1 does not, --parts N "
          "joins another number)",
          part_s_, parts_));
    }
    return info;
  }

 private:
  ReadSweep read() {
    if (waiting_.empty()) return read_sweep(*inner_);
    ReadSweep first = std::move(waiting_.front());
    waiting_.pop_front();
    return first;
  }

  std::size_t find_parts() {
    PartsOfSweep found(part_s_);
    while (!found.parts()) {
      waiting_.push_back(read_sweep(*inner_));
      if (waiting_.back().is_end()) return 1;
      if (waiting_.back().sweep) found.add(*waiting_.back().sweep);
    }
    return *found.parts();
  }

  // Not across a gap, nor one that cannot be read.
  bool next_belongs_to(const Sweep& joined) {
    if (waiting_.empty()) waiting_.push_back(read_sweep(*inner_));
    const std::optional<Sweep>& part = waiting_.front().sweep;
    if (!part) return false;
    const double since_s = seconds_between(joined.stamp_ns, part->stamp_ns);
    return since_s >= 0 && since_s < (static_cast<double>(parts_) - 0.5) * part_s_;
  }

  std::size_t in_sweeps(std::size_t parts) const { return (parts + parts_ - 1) / parts_; }

  bool found_out_;
  std::size_t parts_ = 1;
  double part_s_ = 0;
  bool timed_ = false;
  std::deque<ReadSweep> waiting_;
  std::size_t index_ = 0;
  std::string name_;
};

}  // namespace

std::unique_ptr<ScanSource> with_joined_parts(std::unique_ptr<ScanSource> inner, std::size_t parts) {
  const SourceInfo info = inner->info();
  const bool whole = info.kind == "packets" || PartsOfSweep(info.period_s).parts();  // packets make whole turns
  if (parts == 1 || (parts == 0 && whole)) return inner;
  return std::make_unique<JoinedSource>(std::move(inner), parts);
}

}  // namespace rilo::detail
